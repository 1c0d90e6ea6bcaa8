// One point of a material, moved by strain or by stress, and the materials of the tests of laws.
#pragma once

#include "fem_core/laws/drucker_prager.hpp"
#include "fem_core/laws/isotropic_damage.hpp"
#include "fem_core/laws/j2_plastic.hpp"
#include "fem_core/laws/math.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <random>

namespace kerf::cases {

using fem::ScalarMath;
template <int dim> using Tensor = fem::Symmetric<double, dim>;

inline fem::IsotropicElastic steel() {
  return fem::IsotropicElastic::from_young(7850.0, 210e9, 0.3);
}
inline fem::IsotropicElastic rock() {
  return fem::IsotropicElastic::from_young(2600.0, 30e9, 0.2);
}
inline double degrees(double angle) {
  return angle * std::numbers::pi / 180.0;
}
inline fem::DruckerPrager::Parameters sandstone() {
  return {.cohesion = 10e6, .friction_angle = degrees(30.0), .dilation_angle = degrees(10.0)};
}
inline fem::IsotropicDamage brittle_rock() {
  return fem::IsotropicDamage::from(
      rock(), {.tensile_strength = 5e6, .strength_ratio = 10.0, .fracture_energy = 50.0});
}

/// Numbers from -1 to 1 that are the same on every machine.
class Random {
public:
  double operator()() { return static_cast<double>(generator_() >> 11) * 0x1p-52 - 1.0; }
  template <int dim> Tensor<dim> tensor(double size) {
    Tensor<dim> a;
    for (double& component : a.c)
      component = size * (*this)();
    return a;
  }

private:
  std::mt19937_64 generator_{7};
};

template <class Law, int dim = 3> struct LawPoint {
  Law law;
  std::array<double, Law::history> history;
  Tensor<dim> stress{}, strain{}; // Pa, 1
  double work = 0.0;              // of the stress, by the trapezoidal rule, J/m³
  double dissipated = 0.0;        // J/m³

  explicit LawPoint(const Law& of, double length = 1.0)
      : law(of), history(of.initial_history(length)) {}

  /// @returns what the law says is dissipated, J/m³
  double move(const Tensor<dim>& increment, double time_step = 1.0) {
    const Tensor<dim> before = stress;
    const double lost =
        law.template update<ScalarMath, dim>(stress, history.data(), increment, time_step);
    work += 0.5 * contract(before + stress, increment);
    strain = strain + increment;
    dissipated += lost;
    return lost;
  }

  /// Strains xx by `axial`, and the components `free` by the same amount each, which makes the
  /// stress of the first of them `lateral`. The amount is found by bisection.
  void load(double axial, std::initializer_list<int> free, double lateral = 0.0,
            double time_step = 1.0) {
    const auto increment = [&](double x) {
      Tensor<dim> e{};
      e[0] = axial;
      for (const int k : free)
        e[k] = x;
      return e;
    };
    const auto excess = [&](double x) {
      LawPoint trial = *this;
      trial.move(increment(x), time_step);
      return trial.stress[*free.begin()] - lateral;
    };
    double low = -std::abs(axial), high = std::abs(axial);
    while (excess(low) > 0.0)
      low *= 2.0;
    while (excess(high) < 0.0)
      high *= 2.0;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      (excess(middle) < 0.0 ? low : high) = middle;
    }
    move(increment(0.5 * (low + high)), time_step);
  }
};

} // namespace kerf::cases
