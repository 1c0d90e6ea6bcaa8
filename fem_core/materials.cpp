#include "fem_core/materials.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kerf::fem {
namespace {

void check_positive(const char* key, double value, const char* unit) {
  if (!(value > 0.0 && std::isfinite(value)))
    throw InputError(key, fmt::format("{} {} must be positive", value, unit));
}

} // namespace

LinearElastic from_young(double density, double young_modulus, double poisson_ratio) {
  check_positive("material.density", density, "kg/m³");
  check_positive("material.young_modulus", young_modulus, "Pa");
  if (!(poisson_ratio > -1.0 && poisson_ratio < 0.5))
    throw InputError("material.poisson_ratio",
                     fmt::format("{} must lie between -1 and 0.5, both excluded", poisson_ratio));
  return {.density = density,
          .lambda =
              young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio)),
          .mu = young_modulus / (2.0 * (1.0 + poisson_ratio))};
}

LinearElastic from_moduli(double density, double C11, double C12, int dimension) {
  check_positive("material.density", density, "kg/m³");
  check_positive("material.C11", C11, "Pa");
  if (!(C12 < C11 && C11 + (dimension - 1) * C12 > 0.0))
    throw InputError("material.C12",
                     fmt::format("{} Pa must lie between {} Pa and C11 = {} Pa, both excluded", C12,
                                 -C11 / (dimension - 1), C11));
  return {.density = density, .lambda = C12, .mu = (C11 - C12) / 2.0};
}

} // namespace kerf::fem
