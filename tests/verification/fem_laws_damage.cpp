// Isotropic damage in uniaxial tension and compression.
#include "tests/cases/law_point.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <string>

namespace kerf {
namespace {

using cases::LawPoint;
using fem::IsotropicDamage;

constexpr double E = 30e9, f_t = 5e6, G_f = 50.0, ratio = 10.0; // Pa, Pa, J/m², 1: brittle_rock()
constexpr double first = f_t / E;                               // strain

/// A bar of one element of length h, torn in steps of 1/400 of its softening strain.
LawPoint<IsotropicDamage> torn(double h, int steps) {
  LawPoint<IsotropicDamage> bar(cases::brittle_rock(), h);
  const double softening = G_f / (f_t * h) - 0.5 * first;
  bar.load(first, {1, 2});
  for (int n = 0; n < steps; ++n)
    bar.load(softening / 400.0, {1, 2});
  return bar;
}

// Reference: sigma = f_t exp(-(eps - k_0) / k_s), k_s = G_f / (f_t h) - k_0 / 2. Tolerance:
// rounding, which the exponential makes larger by its argument.
TEST(IsotropicDamage, a_bar_in_tension_softens_as_the_exponential) {
  double worst = 0.0;
  for (const double h : {1e-3, 1e-2, 5e-2}) {
    const double softening = G_f / (f_t * h) - 0.5 * first;
    for (const int steps : {0, 40, 400, 1600}) {
      const auto bar = torn(h, steps);
      const double exact = f_t * std::exp(-(bar.strain[0] - first) / softening);
      worst = std::max(worst, std::abs(bar.stress[0] / exact - 1.0));
    }
  }
  verify({"damage, bar in tension, elements of 1 to 50 mm", "sigma = f_t exp(-(eps - k_0) / k_s)",
          1e-10, "rounding over the strain k_0, in the exponential"},
         worst);
}

// Reference: the area below the curve is G_f / h. Tolerance: the trapezoidal rule, whose steps are
// up to 0.15 k_0 for the smallest element: (0.15)² / 12 of the first of 60 k_0.
TEST(IsotropicDamage, a_torn_bar_has_dissipated_its_fracture_energy_whatever_the_mesh) {
  for (const double h : {1e-3, 1e-2, 5e-2}) {
    const auto bar = torn(h, 400 * 20);
    const double elastic = bar.work - bar.dissipated;
    verify({"damage, energy of a torn bar, element of " +
                std::to_string(static_cast<int>(h * 1e3)) + " mm",
            "G_f / h", 2e-4, "trapezoidal rule, steps of up to 0.15 k_0"},
           bar.dissipated * h / G_f - 1.0);
    EXPECT_NEAR(elastic, 0.5 * bar.stress[0] * bar.strain[0], 1e-4 * G_f / h);
  }
}

// Reference: the modified von Mises strain is 1/r of the compressive one. Damage starts at f_c.
TEST(IsotropicDamage, compression_bears_the_strength_ratio_times_as_much) {
  LawPoint<IsotropicDamage> bar(cases::brittle_rock(), 1e-3);
  bar.load(-ratio * first * (1.0 - 1e-12), {1, 2});
  EXPECT_EQ(bar.history[0], 0.0);
  EXPECT_NEAR(bar.stress[0], -ratio * f_t, 1e-10 * ratio * f_t);
  bar.load(-ratio * first * 1e-6, {1, 2});
  EXPECT_GT(bar.history[0], 0.0);
}

TEST(IsotropicDamage, unloading_is_elastic_with_the_stiffness_that_is_left) {
  auto bar = torn(1e-3, 100);
  const double damage = bar.history[0], dissipated = bar.dissipated, strain = bar.strain[0];
  EXPECT_GT(damage, 0.5);
  bar.load(-0.5 * strain, {1, 2});
  EXPECT_EQ(bar.history[0], damage);
  EXPECT_EQ(bar.dissipated, dissipated);
  EXPECT_NEAR(bar.stress[0], (1.0 - damage) * E * bar.strain[0], 1e-10 * f_t);
}

// Reference: hydrostatic tension has J2 = 0 and E k = (r - 1) / r I1: damage starts at
// p = r f_t / (3 (r - 1)). Pressure never damages.
TEST(IsotropicDamage, mean_tension_damages_and_pressure_does_not) {
  const double K = cases::rock().moduli.bulk(), p = ratio * f_t / (3.0 * (ratio - 1.0));
  const auto strained = [&](double mean) {
    LawPoint<IsotropicDamage> point(cases::brittle_rock(), 1e-3);
    const double e = mean / (3.0 * K);
    point.move({e, e, e, 0.0, 0.0, 0.0});
    return point.history[0];
  };
  EXPECT_EQ(strained(p * (1.0 - 1e-9)), 0.0);
  EXPECT_GT(strained(p * (1.0 + 1e-9)), 0.0);
  EXPECT_EQ(strained(-1000.0 * p), 0.0);
}

} // namespace
} // namespace kerf
