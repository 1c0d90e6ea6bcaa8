// The compressible neo-Hookean solid.
#pragma once

#include "fem_core/laws/gradient.hpp"
#include "fem_core/laws/isotropic_elastic.hpp"

namespace kerf::fem {

/// psi = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)². Everything is formed from H = F - 1 without
/// cancellation: a tiny strain keeps its digits.
/// @see Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed. (2008),
///      section 6.4.3
struct NeoHookean {
  static constexpr int history = 0;
  static constexpr std::array<const char*, history> history_names{}, history_units{};

  double density = 0.0; // of the reference configuration, kg/m³
  Moduli moduli;        // of small strains

  /// @throws InputError when Poisson's ratio is negative: lambda < 0 gives no resistance to
  /// collapse
  static NeoHookean from(const IsotropicElastic& elastic);

  /// Moduli of the tangent of the Kirchhoff stress, {lambda, mu - lambda ln J}, at their stiffest
  /// where no volume is below `least_J` of its own: 1 for small strains.
  Moduli bound(double least_J = 1.0) const;

  std::array<double, history> initial_history(double /*length*/) const { return {}; }

  /// Kirchhoff stress tau = mu (b - 1) + lambda ln J 1, Pa of the reference volume. NaN for J <= 0.
  template <class Math, int dim>
  [[gnu::always_inline]] Symmetric<typename Math::Number, dim>
  kirchhoff(const Gradient<typename Math::Number, dim>& H) const {
    const auto ln_J = Math::logarithm_of_one_plus(volume_change(H));
    return plus_isotropic<typename Math::Number, dim>(moduli.mu * finger_strain(H),
                                                      moduli.lambda * ln_J);
  }

  /// psi, J/m³ of the reference volume: mu/2 H:H + mu (tr H - ln J) + lambda/2 (ln J)², with the
  /// small difference in brackets as a sum of squares.
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  energy_density(const Gradient<typename Math::Number, dim>& H) const {
    using Number = typename Math::Number;
    const Number j = volume_change(H), ln_J = Math::logarithm_of_one_plus(j);
    const Number difference = excess_of_logarithm<Math>(j, ln_J) - nonlinear_volume(H);
    return moduli.mu * (0.5 * squared_norm(H) + difference) + 0.5 * moduli.lambda * ln_J * ln_J;
  }

private:
  /// b - 1 = H + H^T + H H^T
  template <class Number>
  [[gnu::always_inline]] static Symmetric<Number, 2> finger_strain(const Gradient<Number, 2>& H) {
    return {2.0 * H.xx + (H.xx * H.xx + H.xy * H.xy), 2.0 * H.yy + (H.yx * H.yx + H.yy * H.yy),
            2.0 * H.zz + H.zz * H.zz, H.xy + H.yx + (H.xx * H.yx + H.xy * H.yy)};
  }
  template <class Number>
  [[gnu::always_inline]] static Symmetric<Number, 3> finger_strain(const Gradient<Number, 3>& H) {
    return {2.0 * H.xx + (H.xx * H.xx + H.xy * H.xy + H.xz * H.xz),
            2.0 * H.yy + (H.yx * H.yx + H.yy * H.yy + H.yz * H.yz),
            2.0 * H.zz + (H.zx * H.zx + H.zy * H.zy + H.zz * H.zz),
            H.yz + H.zy + (H.yx * H.zx + H.yy * H.zy + H.yz * H.zz),
            H.xz + H.zx + (H.xx * H.zx + H.xy * H.zy + H.xz * H.zz),
            H.xy + H.yx + (H.xx * H.yx + H.xy * H.yy + H.xz * H.yz)};
  }
  /// H : H
  template <class Number>
  [[gnu::always_inline]] static Number squared_norm(const Gradient<Number, 2>& H) {
    return H.xx * H.xx + H.xy * H.xy + H.yx * H.yx + H.yy * H.yy + H.zz * H.zz;
  }
  template <class Number>
  [[gnu::always_inline]] static Number squared_norm(const Gradient<Number, 3>& H) {
    return H.xx * H.xx + H.xy * H.xy + H.xz * H.xz + H.yx * H.yx + H.yy * H.yy + H.yz * H.yz +
           H.zx * H.zx + H.zy * H.zy + H.zz * H.zz;
  }
  /// j - log(1 + j). Near zero from log(1 + j) = 2 artanh(s), s = j / (2 + j), j - 2 s = s j.
  template <class Math>
  [[gnu::always_inline]] static typename Math::Number
  excess_of_logarithm(const typename Math::Number& j, const typename Math::Number& logarithm) {
    using Number = typename Math::Number;
    const Number s = j / (2.0 + j), s2 = s * s;
    Number series = Math::constant(1.0 / 21.0); // s^18 / 21 is below the last digit for |j| < 1/4
    for (int odd = 19; odd >= 3; odd -= 2)
      series = 1.0 / odd + s2 * series;
    return Math::select(Math::absolute(j) < 0.25, s * (j - 2.0 * s2 * series), j - logarithm);
  }
};

} // namespace kerf::fem
