// Drucker-Prager on triaxial paths, at the apex and at the cut-off, and its flow rule.
#include "tests/cases/law_point.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::degrees;
using cases::LawPoint;
using cases::Random;
using cases::Tensor;
using fem::DruckerPrager;
using Fit = DruckerPrager::Fit;

constexpr double c = 10e6;                 // Pa, of sandstone()
const double N = 3.0;                      // (1 + sin 30°) / (1 - sin 30°)
const double f_c = 2.0 * c * std::sqrt(N); // uniaxial strength of Mohr-Coulomb, Pa

DruckerPrager law(Fit fit, double dilation, double cutoff = -1.0) {
  auto parameters = cases::sandstone();
  parameters.fit = fit;
  parameters.dilation_angle = degrees(dilation);
  parameters.tension_cutoff = cutoff;
  return DruckerPrager::from(cases::rock(), parameters);
}

/// Under the pressure P, then strained along x in 200 steps with sigma = -P on `free`.
template <int dim>
LawPoint<DruckerPrager, dim> triaxial(const DruckerPrager& of, double P, double strain,
                                      std::initializer_list<int> free) {
  LawPoint<DruckerPrager, dim> point(of);
  point.stress[0] = point.stress[1] = point.stress[2] = -P;
  for (int n = 0; n < 200; ++n)
    point.load(strain / 200.0, free, -P);
  return point;
}

const char* const mohr_coulomb = "Mohr-Coulomb, sigma_1 = 2 c sqrt(N) + N sigma_3";
const char* const rounding = "rounding of the return and of the strain across";

// Reference: the outer cone meets Mohr-Coulomb in triaxial compression. At constant stress all
// strain is plastic: de = dl (s / (2 sqrt J2) + eta' 1/3), s_xx = -2/sqrt3 sqrt J2.
TEST(DruckerPrager, the_outer_cone_has_the_strength_of_Mohr_Coulomb_in_triaxial_compression) {
  double strength_error = 0.0, flow_error = 0.0;
  for (const double P : {0.0, 20e6, 200e6})
    for (const double dilation : {0.0, 10.0, 30.0}) {
      const auto of = law(Fit::outer, dilation);
      auto point = triaxial<3>(of, P, -0.02, {1, 2});
      strength_error = std::max(strength_error, std::abs(-point.stress[0] / (f_c + N * P) - 1.0));
      const auto before = point.strain;
      point.load(-0.001, {1, 2}, -P);
      const auto de = point.strain - before;
      const double ratio = of.flow_eta / (-1.0 / std::numbers::sqrt3 + of.flow_eta / 3.0);
      flow_error = std::max(flow_error, std::abs(trace(de) / de[0] - ratio));
    }
  verify({"Drucker-Prager, outer cone, triaxial compression at 0, 20, 200 MPa", mohr_coulomb, 1e-13,
          rounding},
         strength_error);
  verify({"Drucker-Prager, dilation in triaxial compression at 0, 10, 30 degrees",
          "flow rule, d eps = d lambda (s / (2 sqrt J2) + eta' 1 / 3)", 1e-12,
          "rounding of the stress over the stiffness and the strain"},
         flow_error);
}

// Reference: the inner cone meets Mohr-Coulomb in triaxial extension, where the axial stress is the
// smaller pressure.
TEST(DruckerPrager, the_inner_cone_has_the_strength_of_Mohr_Coulomb_in_triaxial_extension) {
  double error = 0.0;
  for (const double P : {100e6, 300e6}) {
    const auto point = triaxial<3>(law(Fit::inner, 10.0), P, 0.02, {1, 2});
    error = std::max(error, std::abs(-point.stress[0] / ((P - f_c) / N) - 1.0));
  }
  verify({"Drucker-Prager, inner cone, triaxial extension at 100, 300 MPa", mohr_coulomb, 1e-13,
          rounding},
         error);
}

// Reference: the plane strain fit has the limit load of Mohr-Coulomb where flow is associated. The
// stress out of plane approaches its final value as exp(-strain / yield strain).
TEST(DruckerPrager, the_plane_strain_cone_has_the_limit_of_Mohr_Coulomb_in_plane_strain) {
  double error = 0.0;
  for (const double P : {0.0, 20e6}) {
    const auto point = triaxial<2>(law(Fit::plane_strain, 30.0), P, -0.4, {1});
    error = std::max(error, std::abs(-point.stress[0] / (f_c + N * P) - 1.0));
  }
  verify({"Drucker-Prager, plane strain cone, biaxial compression at 0, 20 MPa", mohr_coulomb,
          1e-13, rounding},
         error);
}

// Reference: p = c cot(phi) at the apex; p_t at the cut-off. Tolerance: rounding.
TEST(DruckerPrager, mean_tension_ends_at_the_apex_or_at_the_cutoff) {
  double error = 0.0;
  for (const double cutoff : {-1.0, 4e6, 0.0})
    for (const Fit fit : {Fit::outer, Fit::inner, Fit::plane_strain})
      for (const double dilation : {0.0, 30.0}) {
        LawPoint<DruckerPrager> point(law(fit, dilation, cutoff));
        const double limit = cutoff < 0.0 ? c * std::numbers::sqrt3 : cutoff;
        for (int n = 0; n < 3; ++n) { // with a deviator that survives below the apex
          point.move({1e-3, 1.05e-3, 0.95e-3, 1e-5, 0.0, 2e-5});
          error = std::max(error, std::abs(trace(point.stress) / 3.0 - limit) / c);
        }
        const auto s = deviator(point.stress);
        EXPECT_EQ(contract(s, s) > 1e-12 * c * c, cutoff >= 0.0);
      }
  verify({"Drucker-Prager, mean tension at apex and cut-off", "p = c cot(phi), p = p_t", 1e-14,
          "rounding"},
         error);
}

// Reference: uniaxial tension on the outer cone, sigma / sqrt3 + eta sigma / 3 = xi c; and with
// p = sigma / 3 cut off before.
TEST(DruckerPrager, uniaxial_tension_ends_on_the_cone_or_at_three_times_the_cutoff) {
  const auto cone = law(Fit::outer, 10.0);
  LawPoint<DruckerPrager> bar(cone), cut(law(Fit::outer, 10.0, 1e6));
  for (int n = 0; n < 20; ++n) {
    bar.load(1e-4, {1, 2});
    cut.load(1e-4, {1, 2});
  }
  verify(
      {"Drucker-Prager, uniaxial tension", "sigma (1 / sqrt3 + eta / 3) = xi c", 1e-13, rounding},
      bar.stress[0] * (1.0 / std::numbers::sqrt3 + cone.eta / 3.0) / cone.strength - 1.0);
  EXPECT_NEAR(cut.stress[0], 3e6, 3e6 * 1e-12);
}

// Reference: Koiter's rule and the conditions of Kuhn and Tucker. The plastic strain of an
// increment is l_s (s / (2 sqrt J2) + eta' 1/3) + l_t 1/3, l_s >= 0, l_t >= 0, and each is zero
// where its surface is not reached.
TEST(DruckerPrager, cone_cutoff_and_corner_flow_as_Koiter_says) {
  Random random;
  int on_cone = 0, on_cutoff = 0, in_corner = 0;
  for (int n = 0; n < 3000; ++n) {
    const auto of = law(Fit::outer, n % 2 == 0 ? 10.0 : 0.0, n % 3 == 0 ? -1.0 : 5e6);
    LawPoint<DruckerPrager> point(of);
    const double size = 2e-4 * std::pow(10.0, random()), mean = 5e-4 * random();
    const auto increment = plus_isotropic(random.tensor<3>(size), mean);
    const auto trial = of.moduli.stress(increment);
    point.move(increment);
    const auto s = deviator(point.stress), s_trial = deviator(trial);
    const double p = trace(point.stress) / 3.0, t = std::sqrt(0.5 * contract(s, s));
    const double tolerance = 1e-14 * std::sqrt(contract(trial, trial)) + 1e-14 * c;
    const double f_s = t + of.eta * p - of.strength, f_t = p - of.cutoff;
    ASSERT_LE(f_s, tolerance);
    ASSERT_LE(f_t, tolerance);
    const double t_trial = std::sqrt(0.5 * contract(s_trial, s_trial));
    const double l_s = (t_trial - t) / of.moduli.mu;
    const double l_t = (trace(trial) / 3.0 - p) / of.moduli.bulk() - of.flow_eta * l_s;
    const double small = 10.0 * tolerance / of.moduli.mu;
    ASSERT_GE(l_s, -small);
    ASSERT_GE(l_t, -small);
    ASSERT_TRUE(l_s <= small || std::abs(f_s) <= tolerance);
    ASSERT_TRUE(l_t <= small || std::abs(f_t) <= tolerance);
    for (int k = 0; k < 6; ++k) // along the deviator of the trial stress
      ASSERT_NEAR(s[k], t / t_trial * s_trial[k], tolerance);
    on_cone += l_s > small && l_t <= small;
    on_cutoff += l_s <= small && l_t > small;
    in_corner += l_s > small && l_t > small;
  }
  EXPECT_GT(on_cone, 300);
  EXPECT_GT(on_cutoff, 100);
  EXPECT_GT(in_corner, 300);
}

// Reference: the principle of maximum plastic dissipation, (sigma - sigma*) : de_p >= 0 for every
// stress sigma* inside, which holds for associated flow alone: normality and convexity.
TEST(DruckerPrager, associated_flow_is_normal_to_the_surface) {
  Random random;
  const auto violations = [&](double dilation) {
    const auto of = law(Fit::outer, dilation, 5e6);
    int count = 0, flows = 0;
    for (int n = 0; n < 2000; ++n) {
      LawPoint<DruckerPrager> point(of), inside(of);
      const auto increment = random.tensor<3>(2e-3);
      if (point.move(increment) == 0.0)
        continue;
      inside.move(random.tensor<3>(2e-3)); // ends inside or on the surface
      const auto lost = of.moduli.stress(increment) - point.stress;
      const auto de_p = 1.0 / (2.0 * of.moduli.mu) * deviator(lost);
      const double volume = trace(lost) / (3.0 * of.moduli.bulk());
      const auto difference = point.stress - inside.stress;
      count += contract(difference, de_p) + trace(difference) / 3.0 * volume < -1e-9 * c * 1e-3;
      ++flows;
    }
    EXPECT_GT(flows, 1000);
    return count;
  };
  EXPECT_EQ(violations(30.0), 0);
  EXPECT_GT(violations(0.0), 10); // the test can see
}

} // namespace
} // namespace kerf
