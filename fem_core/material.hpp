// What a region of the body is made of, and how its elements take the strain.
#pragma once

#include "fem_core/internal_force.hpp"
#include "fem_core/laws/drucker_prager.hpp"
#include "fem_core/laws/isotropic_damage.hpp"
#include "fem_core/laws/isotropic_elastic.hpp"
#include "fem_core/laws/j2_plastic.hpp"
#include "fem_core/laws/neo_hookean.hpp"
#include "fem_core/laws/transversely_isotropic.hpp"

#include <string>
#include <variant>
#include <vector>

namespace kerf::fem {

/// In the order of LawKey.
using Law = std::variant<IsotropicElastic, TransverselyIsotropic, NeoHookean, J2Plastic,
                         DruckerPrager, IsotropicDamage>;

/// What 2D means.
enum class Plane : std::uint8_t { strain, stress, axisymmetric };

struct Material {
  Law law;
  /// Strain on the current configuration with an objective stress rate, or, of a hyperelastic law,
  /// from the deformation gradient. Otherwise strain is small.
  bool finite_strain = false;
  Formulation formulation = Formulation::full;
  double hourglass_stiffness = 0.1; // of one_point, as a share of about that of full integration
  /// Of one_point: zeta of a hourglass mode q'' + zeta W q' + k W² q = 0, with k the stiffness
  /// above and W its frequency for k = 1; up to 1.
  double hourglass_viscosity = 0.0;
  double linear_viscosity = 0.0;    // of the bulk: b_1, about 0.06
  double quadratic_viscosity = 0.0; // b_2, about 1.2

  double density() const;
  /// Of an isotropic solid that is at least as stiff, Pa.
  Moduli bound() const;
  /// What linear bulk viscosity takes from the critical step: sqrt(1 + b_1²) - b_1.
  double step_factor() const;
};

/// @throws InputError for what cannot be used together, with a key inside the material
void check(const Material& material, Shape shape, Plane plane);

/// The kernel of the elements of a material and its arrays, all at their start.
/// @param lengths  [batches][batch_size] characteristic length of each element, m
/// @param stored   keep the stress even if the law could do without, for a body under stress
GroupKernel make_group(const Material& material, Shape shape, Plane plane,
                       std::span<const double> lengths, bool stored);

/// Names and units of the history that the law keeps at a point.
struct HistoryValue {
  std::string name, unit;
};
std::vector<HistoryValue> history_of(const Material& material, Plane plane);

} // namespace kerf::fem
