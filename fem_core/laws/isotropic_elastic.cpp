#include "fem_core/laws/isotropic_elastic.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/laws/checks.hpp"

#include <fmt/format.h>

namespace kerf::fem {

IsotropicElastic IsotropicElastic::from_young(double density, double young_modulus,
                                              double poisson_ratio) {
  check_positive("material.density", density, "kg/m³");
  check_positive("material.young_modulus", young_modulus, "Pa");
  if (!(poisson_ratio > -1.0 && poisson_ratio < 0.5))
    throw InputError("material.poisson_ratio",
                     fmt::format("{} must lie between -1 and 0.5, both excluded", poisson_ratio));
  return {.density = density,
          .moduli = {.lambda = young_modulus * poisson_ratio /
                               ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio)),
                     .mu = young_modulus / (2.0 * (1.0 + poisson_ratio))}};
}

IsotropicElastic IsotropicElastic::from_moduli(double density, double C11, double C12,
                                               int dimension) {
  check_positive("material.density", density, "kg/m³");
  check_positive("material.C11", C11, "Pa");
  if (!(C12 < C11 && C11 + (dimension - 1) * C12 > 0.0))
    throw InputError("material.C12",
                     fmt::format("{} Pa must lie between {} Pa and C11 = {} Pa, both excluded", C12,
                                 -C11 / (dimension - 1), C11));
  return {.density = density, .moduli = {.lambda = C12, .mu = (C11 - C12) / 2.0}};
}

} // namespace kerf::fem
