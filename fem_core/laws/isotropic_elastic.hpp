// The isotropic linear elastic solid.
#pragma once

#include "fem_core/laws/moduli.hpp"

#include <array>

namespace kerf::fem {

/// sigma = lambda tr(eps) 1 + 2 mu eps. With the Green strain it gives the second Piola-Kirchhoff
/// stress; with an objective rate it is hypoelastic.
struct IsotropicElastic {
  static constexpr int history = 0;
  static constexpr std::array<const char*, history> history_names{}, history_units{};

  double density = 0.0; // of the bulk, kg/m³
  Moduli moduli;

  /// From Young's modulus E, Pa, and Poisson's ratio nu.
  /// @throws InputError unless density > 0, E > 0 and -1 < nu < 1/2
  static IsotropicElastic from_young(double density, double young_modulus, double poisson_ratio);

  /// From the stiffness of uniaxial strain C11 = lambda + 2 mu and the coupling C12 = lambda, Pa.
  /// @throws InputError unless density > 0 and every strain of the space stores energy:
  ///         C11 > C12 and C11 + (dimension - 1) C12 > 0
  static IsotropicElastic from_moduli(double density, double C11, double C12, int dimension);

  /// The law itself.
  Moduli bound() const { return moduli; }

  std::array<double, history> initial_history(double /*length*/) const { return {}; }

  /// @param strain  small strain
  /// @returns Pa
  template <class Math, int dim>
  [[gnu::always_inline]] Symmetric<typename Math::Number, dim>
  stress(const Symmetric<typename Math::Number, dim>& strain) const {
    return moduli.stress(strain);
  }
  /// 1/2 eps : C : eps, J/m³
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  energy_density(const Symmetric<typename Math::Number, dim>& strain) const {
    return moduli.energy_density(strain);
  }
  /// Adds C : increment to the stress; nothing is dissipated.
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  update(Symmetric<typename Math::Number, dim>& stress, typename Math::Number* /*kept*/,
         const Symmetric<typename Math::Number, dim>& strain_increment,
         double /*time_step*/) const {
    stress = stress + moduli.stress(strain_increment);
    return typename Math::Number{};
  }
};

} // namespace kerf::fem
