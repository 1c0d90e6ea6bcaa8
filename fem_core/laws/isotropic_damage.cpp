#include "fem_core/laws/isotropic_damage.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/laws/checks.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kerf::fem {

IsotropicDamage IsotropicDamage::from(const IsotropicElastic& elastic, const Parameters& p) {
  check_positive("material.tensile_strength", p.tensile_strength, "Pa");
  check_positive("material.fracture_energy", p.fracture_energy, "J/m²");
  if (!(p.strength_ratio >= 1.0 && std::isfinite(p.strength_ratio)))
    throw InputError("material.strength_ratio",
                     fmt::format("{} must be at least 1", p.strength_ratio));
  return {.density = elastic.density,
          .moduli = elastic.moduli,
          .tensile_strength = p.tensile_strength,
          .strength_ratio = p.strength_ratio,
          .fracture_energy = p.fracture_energy};
}

std::array<double, IsotropicDamage::history> IsotropicDamage::initial_history(double length) const {
  if (!(length > 0.0 && length < most_length()))
    throw InputError("material.fracture_energy",
                     fmt::format("{} J/m² is too little for an element of length {} m: its length "
                                 "must be below 2 E G_f / f_t² = {} m",
                                 fracture_energy, length, most_length()));
  return {0.0, 0.0, length};
}

} // namespace kerf::fem
