#include "fem_core/laws/hardening.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/laws/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kerf::fem {

Hardening Hardening::linear(double yield_stress, double modulus) {
  check_positive("material.yield_stress", yield_stress, "Pa");
  check_not_negative("material.hardening_modulus", modulus, "Pa");
  return {.initial = yield_stress, .modulus = modulus};
}

Hardening Hardening::voce(double yield_stress, double saturation, double exponent, double modulus) {
  check_not_negative("material.saturation_stress", saturation, "Pa");
  check_positive("material.saturation_exponent", exponent, "");
  Hardening hardening = linear(yield_stress, modulus);
  hardening.saturation = saturation;
  hardening.exponent = exponent;
  return hardening;
}

Hardening Hardening::table(std::span<const double> strain, std::span<const double> stress) {
  constexpr const char* key = "material.hardening_table";
  if (strain.size() != stress.size() || strain.empty() || strain.size() > most_points)
    throw InputError(key, fmt::format("{} plastic strains and {} yield stresses must be as many of "
                                      "each, from 1 to {}",
                                      strain.size(), stress.size(), most_points));
  if (strain[0] != 0.0)
    throw InputError(key, fmt::format("plastic strain {} of the first point must be 0", strain[0]));
  check_positive(key, stress[0], "Pa");
  Hardening hardening{.initial = stress[0], .points = static_cast<int>(strain.size())};
  std::copy(strain.begin(), strain.end(), hardening.strain);
  std::copy(stress.begin(), stress.end(), hardening.stress);
  for (std::size_t k = 1; k < strain.size(); ++k) {
    if (!(strain[k] > strain[k - 1] && std::isfinite(strain[k])))
      throw InputError(key, fmt::format("plastic strain {} of point {} must be above {}", strain[k],
                                        k + 1, strain[k - 1]));
    if (!(stress[k] >= stress[k - 1] && std::isfinite(stress[k])))
      throw InputError(key, fmt::format("yield stress {} Pa of point {} must not be below {} Pa",
                                        stress[k], k + 1, stress[k - 1]));
    hardening.slope[k - 1] = (stress[k] - stress[k - 1]) / (strain[k] - strain[k - 1]);
  }
  return hardening;
}

RateDependence RateDependence::cowper_symonds(double reference_rate, double exponent) {
  check_positive("material.reference_rate", reference_rate, "1/s");
  if (!(exponent >= 1.0 && std::isfinite(exponent)))
    throw InputError("material.rate_exponent", fmt::format("{} must be at least 1", exponent));
  return {.reference = reference_rate, .exponent = exponent};
}

} // namespace kerf::fem
