// The elastic-plastic solid of Drucker and Prager with a tension cut-off: rock, concrete, soil.
#pragma once

#include "fem_core/laws/isotropic_elastic.hpp"

namespace kerf::fem {

/// sqrt(J2) + eta p <= xi c (the cone) and p <= p_t (the cut-off), p the mean stress, tension
/// positive. The cone flows along sqrt(J2) + eta' p, with eta' of the dilation angle; the cut-off
/// flows in volume; their corner flows along both (Koiter). Perfectly plastic. The cut-off lies at
/// the apex unless it is given, so that the return to the apex is the corner with sqrt(J2) = 0.
/// @see de Souza Neto, Perić & Owen, Computational Methods for Plasticity (2008),
/// sections 6.4.4, 8.3
struct DruckerPrager {
  /// What the cone has in common with the hexagon of Mohr and Coulomb.
  enum class Fit {
    outer,       // edges of triaxial compression
    inner,       // edges of triaxial extension
    plane_strain // limit load in plane strain
  };
  struct Parameters {
    double cohesion = 0.0;       // c, Pa
    double friction_angle = 0.0; // phi, rad
    double dilation_angle = 0.0; // psi, rad; associated flow where it is phi
    Fit fit = Fit::outer;
    double tension_cutoff = -1.0; // p_t, largest mean stress, Pa; negative: the apex c cot phi
  };

  static constexpr int history = 1;
  static constexpr std::array<const char*, history> history_names{"equivalent_plastic_strain"};
  static constexpr std::array<const char*, history> history_units{"1"};

  double density = 0.0; // kg/m³
  Moduli moduli;
  double eta = 0.0, flow_eta = 0.0; // slopes of cone and flow potential
  double strength = 0.0;            // xi c, Pa: sqrt(J2) where p = 0
  double cutoff = 0.0;              // p_t, Pa
  double corner = 0.0;              // sqrt(J2) where the cone meets the cut-off, Pa

  /// @throws InputError unless c >= 0, 0 <= phi < pi/2, 0 <= psi <= phi, one of c and phi is
  ///         positive, and p_t is not beyond the apex
  static DruckerPrager from(const IsotropicElastic& elastic, const Parameters& parameters);

  /// The elastic moduli: flow only makes it softer.
  Moduli bound() const { return moduli; }

  std::array<double, history> initial_history(double /*length*/) const { return {0.0}; }

  /// @param stress   Pa; at the start, turned with the material, and at the end
  /// @param kept  the history: equivalent plastic strain, the sum of sqrt(2/3 de : de)
  /// @returns plastic work with the stress at the end, J/m³; never negative
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  update(Symmetric<typename Math::Number, dim>& stress, typename Math::Number* kept,
         const Symmetric<typename Math::Number, dim>& strain_increment,
         double /*time_step*/) const {
    using Number = typename Math::Number;
    stress = stress + moduli.stress(strain_increment);
    const auto s = deviator(stress);
    const Number p = (1.0 / 3.0) * trace(stress), t = Math::square_root(0.5 * contract(s, s));
    const Number beyond = t + eta * p - strength;
    if (!Math::any((beyond > 0.0) | (p > cutoff)))
      return Number{};

    const double K = moduli.bulk(), mu = moduli.mu;
    const Number flow = Math::larger(beyond, Number{}) / (mu + K * eta * flow_eta);
    const Number p_cone = p - K * flow_eta * flow;
    // Where the cone would leave p above the cut-off, both are active if t is above the corner.
    const Number p_end = Math::smaller(p_cone, Math::constant(cutoff));
    const Number t_end = Math::select(p_cone > cutoff, Math::smaller(t, Math::constant(corner)),
                                      Math::larger(t - mu * flow, Number{}));

    const Number dp = p - p_end, dt = t - t_end; // Pa, taken off by the flow
    stress =
        plus_isotropic<Number, dim>(stress - Math::select(dt > 0.0, dt / t, Number{}) * s, -dp);
    const Number shear = dt / mu, volume = dp / K; // plastic: twice sqrt(J2), and trace
    kept[0] =
        kept[0] + Math::square_root((1.0 / 3.0) * shear * shear + (2.0 / 9.0) * volume * volume);
    return t_end * shear + p_end * volume;
  }
};

} // namespace kerf::fem
