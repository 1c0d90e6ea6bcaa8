// The elastic-plastic solid of von Mises, with isotropic hardening and rate dependence.
#pragma once

#include "fem_core/laws/hardening.hpp"
#include "fem_core/laws/isotropic_elastic.hpp"

namespace kerf::fem {

/// q = sqrt(3/2 s : s) <= sigma_y(p) (1 + (dp/dt / D)^(1/q)), associated flow, radial return with
/// the values at the end of the increment.
/// @see Simo & Hughes, Computational Inelasticity (1998), box 3.1; de Souza Neto, Perić & Owen,
///      Computational Methods for Plasticity (2008), chapters 7 and 11
struct J2Plastic {
  static constexpr int history = 1;
  static constexpr std::array<const char*, history> history_names{"equivalent_plastic_strain"};
  static constexpr std::array<const char*, history> history_units{"1"};

  double density = 0.0; // kg/m³
  Moduli moduli;
  Hardening hardening;
  RateDependence rate;

  static J2Plastic from(const IsotropicElastic& elastic, const Hardening& hardening,
                        const RateDependence& rate = {}) {
    return {elastic.density, elastic.moduli, hardening, rate};
  }

  /// The elastic moduli: flow only makes it softer.
  Moduli bound() const { return moduli; }

  std::array<double, history> initial_history(double /*length*/) const { return {0.0}; }

  /// @param stress   Pa; at the start, turned with the material, and at the end
  /// @param kept  the history: equivalent plastic strain
  /// @param time_step  s; used with rate dependence only, must be positive then
  /// @returns plastic work with the stress at the end, J/m³; never negative
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  update(Symmetric<typename Math::Number, dim>& stress, typename Math::Number* kept,
         const Symmetric<typename Math::Number, dim>& strain_increment, double time_step) const {
    using Number = typename Math::Number;
    stress = stress + moduli.stress(strain_increment);
    const auto s = deviator(stress);
    const Number q = Math::square_root(1.5 * contract(s, s));
    Number yield, tangent;
    hardening.evaluate<Math>(kept[0], yield, tangent);
    const auto flows = q > yield;
    if (!Math::any(flows))
      return Number{};
    const Number dp = Math::select(flows, flow<Math>(q, kept[0], time_step), Number{});
    const Number drop = 3.0 * moduli.mu * dp; // of q
    stress = stress - Math::select(flows, drop / q, Number{}) * s;
    kept[0] = kept[0] + dp;
    return (q - drop) * dp;
  }

private:
  /// Solves q = 3 mu dp + sigma_y(p + dp) (1 + a x) with dp = S x^n for x; S = D dt, n = q, a = 1
  /// with rates, which leaves no infinite slope at zero, and S = n = 1, a = 0 without. Newton's
  /// method, held inside a bracket by bisection. Lanes that have arrived stay.
  template <class Math>
  [[gnu::always_inline]] typename Math::Number
  flow(const typename Math::Number& q, const typename Math::Number& p, double time_step) const {
    using Number = typename Math::Number;
    const bool rated = rate.reference > 0.0;
    const double S = rated ? rate.reference * time_step : 1.0, n = rated ? rate.exponent : 1.0;
    const double a = rated ? 1.0 : 0.0, stiffness = 3.0 * moduli.mu;
    Number yield, tangent;
    hardening.evaluate<Math>(p, yield, tangent);
    const Number excess = q - yield;
    Number low{}, high = excess / (stiffness * S), x = excess / (stiffness + tangent);
    if (!rated && hardening.straight())
      return x;
    if (rated) { // both parts of the bracket hold; each alone makes up the excess
      high = Math::smaller(n == 1.0 ? high : Math::power(high, 1.0 / n), excess / yield);
      x = high;
    }
    auto moving = excess > 0.0;
    for (int i = 0; i < 60 && Math::any(moving); ++i) {
      const Number dp = S * (n == 1.0 ? x : Math::power(x, n));
      hardening.evaluate<Math>(p + dp, yield, tangent);
      const Number factor = 1.0 + a * x;
      const Number left = q - stiffness * dp - yield * factor;
      const Number slope = (stiffness + tangent * factor) * (n * dp / x) + a * yield;
      low = Math::select(left > 0.0, x, low);
      high = Math::select(left > 0.0, high, x);
      const Number newton = x + left / slope;
      const auto inside = (newton >= low) & (newton <= high);
      const Number next = Math::select(inside, newton, 0.5 * (low + high));
      const auto far = Math::absolute(next - x) > 1e-9 * next; // quadratic: the rest is rounding
      x = Math::select(moving, next, x);
      moving = moving & far & (high - low > 4e-16 * high);
    }
    return S * (n == 1.0 ? x : Math::power(x, n));
  }
};

} // namespace kerf::fem
