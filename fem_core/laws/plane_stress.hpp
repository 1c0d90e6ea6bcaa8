// Material laws in plane stress: the strain through the thickness is what makes its stress vanish.
#pragma once

#include "fem_core/laws/math.hpp"
#include "fem_core/laws/neo_hookean.hpp"

#include <array>

namespace kerf::fem {

/// A law that gives the stress of a total strain, in proportion to it.
template <class Law>
concept LinearLaw = requires(const Law& law, const Symmetric<double, 2>& strain) {
  law.template stress<ScalarMath, 2>(strain);
};

/// The history of a law followed by the total strain through the thickness.
template <class Law> struct ThicknessHistory {
  static constexpr int size = Law::history + 1;
  template <class Value>
  static constexpr std::array<Value, size> with(const std::array<Value, Law::history>& values,
                                                Value last) {
    std::array<Value, size> result{};
    for (int k = 0; k < Law::history; ++k)
      result[k] = values[k];
    result[Law::history] = last;
    return result;
  }
  static constexpr std::array<const char*, size> names = with(Law::history_names, "strain_zz");
  static constexpr std::array<const char*, size> units = with(Law::history_units, "1");
};

/// An incremental law with `moduli` in plane stress. The strain zz of an increment is ignored and
/// found, so that the stress zz at its end is zero, to rounding: by secants, held inside a bracket
/// by bisection, from the elastic answer. Then it is set to zero.
template <class Law> struct PlaneStress : Law {
  static constexpr int history = ThicknessHistory<Law>::size;
  static constexpr auto history_names = ThicknessHistory<Law>::names;
  static constexpr auto history_units = ThicknessHistory<Law>::units;

  explicit PlaneStress(const Law& law) : Law(law) {}

  std::array<double, history> initial_history(double length) const {
    return ThicknessHistory<Law>::with(Law::initial_history(length), 0.0);
  }

  /// As of the law.
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  update(Symmetric<typename Math::Number, dim>& stress, typename Math::Number* kept,
         const Symmetric<typename Math::Number, dim>& strain_increment, double time_step) const {
    static_assert(dim == 2);
    using Number = typename Math::Number;
    const double M = this->moduli.uniaxial();
    auto strain = strain_increment;
    Number scale{};
    for (const int k : in_plane)
      scale = scale + (Math::absolute(stress[k]) + M * Math::absolute(strain[k]));
    Number x = -(stress[2] + this->moduli.lambda * (strain[0] + strain[1])) / M;
    Number low = Math::constant(-__builtin_inf()), high = Math::constant(__builtin_inf());
    Number last_x = x, last_f{};
    Symmetric<Number, dim> end;
    Number end_history[history], dissipated;
    auto moving = scale > 0.0;
    for (int i = 0;; ++i) {
      end = stress;
      for (int k = 0; k < Law::history; ++k)
        end_history[k] = kept[k];
      strain[2] = x;
      dissipated = Law::template update<Math, dim>(end, end_history, strain, time_step);
      const Number f = end[2];
      moving = moving & (Math::absolute(f) > 2e-15 * scale);
      if (i == most_iterations || !Math::any(moving))
        break;
      low = Math::select(f < 0.0, x, low);
      high = Math::select(f < 0.0, high, x);
      // The elastic stiffness is the largest; where the stress has stopped to change, go further.
      Number next = x - f / M;
      if (i > 0) {
        const Number secant = x - f * (x - last_x) / (f - last_f);
        const Number middle = 0.5 * (low + high);
        const Number other =
            Math::select(Math::absolute(middle) < __builtin_inf(), middle, x + 2.0 * (x - last_x));
        next = Math::select((secant > low) & (secant < high), secant, other);
      }
      moving = moving & (Math::absolute(next - x) > 1e-16 * Math::absolute(x));
      last_x = x;
      last_f = f;
      x = Math::select(moving, next, x);
    }
    end[2] = Number{};
    stress = end;
    for (int k = 0; k < Law::history; ++k)
      kept[k] = end_history[k];
    kept[Law::history] = kept[Law::history] + x;
    return dissipated;
  }

private:
  static constexpr int in_plane[] = {0, 1, 3}, most_iterations = 50;
};

/// A linear law in plane stress, in closed form. The strain zz that is given is ignored.
template <LinearLaw Law> struct PlaneStress<Law> : Law {
  static constexpr int history = ThicknessHistory<Law>::size;
  static constexpr auto history_names = ThicknessHistory<Law>::names;
  static constexpr auto history_units = ThicknessHistory<Law>::units;

  explicit PlaneStress(const Law& law)
      : Law(law), thickness_(law.template stress<ScalarMath, 2>({0.0, 0.0, 1.0, 0.0})) {}

  std::array<double, history> initial_history(double length) const {
    return ThicknessHistory<Law>::with(Law::initial_history(length), 0.0);
  }

  /// Strain zz that makes the stress zz vanish.
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  strain_zz(const Symmetric<typename Math::Number, dim>& strain) const {
    return -plane_strain<Math, dim>(strain)[2] / thickness_[2];
  }
  template <class Math, int dim>
  [[gnu::always_inline]] Symmetric<typename Math::Number, dim>
  stress(const Symmetric<typename Math::Number, dim>& strain) const {
    auto sigma = plane_strain<Math, dim>(strain);
    release<Math, dim>(sigma);
    return sigma;
  }
  /// 1/2 sigma : eps, J/m³
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  energy_density(const Symmetric<typename Math::Number, dim>& strain) const {
    return 0.5 * contract(strain, stress<Math, dim>(strain));
  }
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  update(Symmetric<typename Math::Number, dim>& stress, typename Math::Number* kept,
         const Symmetric<typename Math::Number, dim>& strain_increment,
         double /*time_step*/) const {
    stress = stress + plane_strain<Math, dim>(strain_increment);
    kept[0] = kept[0] + release<Math, dim>(stress);
    return typename Math::Number{};
  }

private:
  Symmetric<double, 2> thickness_; // stress of a unit strain zz, Pa

  template <class Math, int dim>
  [[gnu::always_inline]] Symmetric<typename Math::Number, dim>
  plane_strain(Symmetric<typename Math::Number, dim> strain) const {
    static_assert(dim == 2);
    strain[2] = typename Math::Number{};
    return Law::template stress<Math, dim>(strain);
  }
  /// Takes the stress zz off, and returns the strain zz that does so.
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  release(Symmetric<typename Math::Number, dim>& sigma) const {
    const typename Math::Number strain = -sigma[2] / thickness_[2];
    for (int k = 0; k < sigma.size; ++k)
      sigma[k] = sigma[k] + thickness_[k] * strain;
    sigma[2] = typename Math::Number{};
    return strain;
  }
};

/// The neo-Hookean solid in plane stress. The stretch zz that is given is ignored and found by
/// Newton's method: mu (b_zz - 1) + lambda ln J = 0.
template <> struct PlaneStress<NeoHookean> : NeoHookean {
  explicit PlaneStress(const NeoHookean& law) : NeoHookean(law) {}

  /// H with the stretch minus one through the thickness.
  template <class Math, int dim>
  [[gnu::always_inline]] Gradient<typename Math::Number, dim>
  with_thickness(Gradient<typename Math::Number, dim> H) const {
    static_assert(dim == 2);
    using Number = typename Math::Number;
    const auto [lambda, mu] = moduli;
    H.zz = Number{};
    const Number ln_area = Math::logarithm_of_one_plus(volume_change(H));
    const Number guess = (lambda / (lambda + 2.0 * mu)) * ln_area;
    Number h = -guess / (1.0 + Math::absolute(guess));
    auto moving = Math::absolute(h) > 0.0;
    for (int i = 0; i < 40 && Math::any(moving); ++i) {
      const Number f = mu * (2.0 * h + h * h) + lambda * (ln_area + Math::logarithm_of_one_plus(h));
      const Number newton = h - f / (2.0 * mu * (1.0 + h) + lambda / (1.0 + h));
      const Number next = Math::larger(newton, 0.5 * (h - 1.0)); // at least half of the stretch
      const auto far = Math::absolute(next - h) > 1e-9 * Math::absolute(next);
      h = Math::select(moving, next, h);
      moving = moving & far; // quadratic: the rest is rounding
    }
    H.zz = h;
    return H;
  }
  template <class Math, int dim>
  [[gnu::always_inline]] Symmetric<typename Math::Number, dim>
  kirchhoff(const Gradient<typename Math::Number, dim>& H) const {
    auto tau = NeoHookean::kirchhoff<Math, dim>(with_thickness<Math, dim>(H));
    tau[2] = typename Math::Number{};
    return tau;
  }
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  energy_density(const Gradient<typename Math::Number, dim>& H) const {
    return NeoHookean::energy_density<Math, dim>(with_thickness<Math, dim>(H));
  }
};

} // namespace kerf::fem
