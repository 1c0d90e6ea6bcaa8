// J2 plasticity on proportional paths, where backward Euler is exact.
#include "tests/cases/law_point.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace kerf {
namespace {

using cases::LawPoint;
using cases::Tensor;
using fem::Hardening;
using fem::J2Plastic;
using fem::RateDependence;

constexpr double E = 210e9, nu = 0.3, sigma_0 = 300e6; // Pa, of steel()

struct Curve {
  std::string name;
  Hardening hardening;
  std::function<double(double)> yield_stress; // Pa of the equivalent plastic strain, written anew
};

std::vector<Curve> curves() {
  const std::vector<double> strain{0.0, 1e-3, 4e-3, 0.02}, stress{300e6, 340e6, 350e6, 500e6};
  return {{"perfect", Hardening::linear(sigma_0, 0.0), [](double) { return sigma_0; }},
          {"linear", Hardening::linear(sigma_0, 5e9), [](double p) { return sigma_0 + 5e9 * p; }},
          {"Voce", Hardening::voce(sigma_0, 150e6, 200.0, 1e9),
           [](double p) { return sigma_0 + 150e6 * (1.0 - std::exp(-200.0 * p)) + 1e9 * p; }},
          {"table", Hardening::table(strain, stress), [=](double p) {
             for (std::size_t k = 1; k < strain.size(); ++k)
               if (p <= strain[k])
                 return stress[k - 1] + (stress[k] - stress[k - 1]) * (p - strain[k - 1]) /
                                            (strain[k] - strain[k - 1]);
             return stress.back();
           }}};
}

/// The p that makes a falling function zero.
double root(const std::function<double(double)>& f, double high) {
  double low = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Reference: sigma = sigma_y(p) and sigma = E (eps - p) in a bar; its plastic strain across is
// -p / 2. Tolerance: rounding of the return and of the search for the strain across, which the
// elastic stiffness makes a stress.
TEST(J2Plasticity, a_bar_follows_the_hardening_curve) {
  for (const Curve& curve : curves()) {
    LawPoint<J2Plastic> bar(J2Plastic::from(cases::steel(), curve.hardening));
    double worst = 0.0;
    for (int n = 0; n < 120; ++n) { // to 3 %, the steps growing from 1.7e-6 to 5e-4
      bar.load(4.13e-6 * (n + 0.5), {1, 2});
      const double strain = bar.strain[0];
      const double p =
          root([&](double x) { return E * (strain - x) - curve.yield_stress(x); }, strain);
      const double sigma = E * (strain - p);
      worst = std::max({worst, std::abs(bar.stress[0] - sigma) / sigma_0,
                        std::abs(bar.strain[1] + nu * sigma / E + 0.5 * p) / strain,
                        std::abs(bar.history[0] - p) / strain});
    }
    EXPECT_GT(bar.history[0], 0.02);
    verify({"J2 plasticity, bar in tension, hardening: " + curve.name,
            "sigma_y(p) = E (eps - p), solved by bisection", 1e-13,
            "rounding of the return and of the strain across"},
           worst);
  }
}

// Reference: q = sqrt3 tau, dp = 2 de_xy / sqrt3: q = 2 sqrt3 mu e_xy - 3 mu p = sigma_0 + H p.
// Tolerance: rounding of 50 increments.
TEST(J2Plasticity, pure_shear_flows_at_the_yield_stress_over_the_root_of_three) {
  const double H = 5e9, mu = cases::steel().moduli.mu;
  LawPoint<J2Plastic, 2> point(J2Plastic::from(cases::steel(), Hardening::linear(sigma_0, H)));
  for (int n = 0; n < 50; ++n)
    point.move({0.0, 0.0, 0.0, 2e-4});
  const double root3 = std::numbers::sqrt3;
  const double p = (2.0 * root3 * mu * 0.01 - sigma_0) / (3.0 * mu + H);
  verify({"J2 plasticity, pure shear, linear hardening", "sqrt3 tau = sigma_0 + H p", 1e-13,
          "rounding of 50 increments"},
         std::max(std::abs(point.stress[3] * root3 / (sigma_0 + H * p) - 1.0),
                  std::abs(point.history[0] / p - 1.0)));
  EXPECT_NEAR(point.dissipated, sigma_0 * p + 0.5 * H * p * p, 2e-2 * point.dissipated);
}

TEST(J2Plasticity, pressure_alone_never_makes_it_flow) {
  const auto steel = cases::steel();
  LawPoint<J2Plastic> point(J2Plastic::from(steel, Hardening::linear(sigma_0, 0.0)));
  EXPECT_EQ(point.move({-0.1, -0.1, -0.1, 0.0, 0.0, 0.0}), 0.0);
  EXPECT_DOUBLE_EQ(point.stress[0], -0.3 * steel.moduli.bulk());
  EXPECT_EQ(point.history[0], 0.0);
}

// Reference: a bar of constant strain rate ends with the plastic rate equal to it, at
// sigma_0 (1 + (rate / D)^(1/q)). It comes there as exp(-strain / e), e = d sigma / d ln rate / E,
// at most 3.4e-3 here: after a strain of 0.2 to rounding.
TEST(J2Plasticity, the_flow_stress_grows_with_the_rate_as_Cowper_and_Symonds_say) {
  const double D = 40.4, q = 5.0; // 1/s, 1: mild steel
  const auto law = J2Plastic::from(cases::steel(), Hardening::linear(sigma_0, 0.0),
                                   RateDependence::cowper_symonds(D, q));
  double worst = 0.0;
  for (const double rate : {1e-6, 1e-2, 40.4, 1e4, 1e7}) {
    LawPoint<J2Plastic> bar(law);
    for (int n = 0; n < 1000; ++n)
      bar.load(2e-4, {1, 2}, 0.0, 2e-4 / rate);
    worst = std::max(
        worst, std::abs(bar.stress[0] / (sigma_0 * (1.0 + std::pow(rate / D, 1.0 / q))) - 1.0));
  }
  verify({"J2 plasticity, flow stress from 1e-6 to 1e7 per second",
          "sigma_0 (1 + (rate / D)^(1/q)), Cowper & Symonds (1957)", 1e-13,
          "rounding of the return and of the strain across"},
         worst);
}

// The equation of the implicit return itself, for every hardening and for increments that are up to
// a hundred times the yield strain. Tolerance: rounding.
TEST(J2Plasticity, with_rates_every_increment_ends_on_its_yield_surface) {
  const double D = 1e3, q = 3.0;
  cases::Random random;
  double worst = 0.0;
  for (const Curve& curve : curves()) {
    LawPoint<J2Plastic> point(
        J2Plastic::from(cases::steel(), curve.hardening, RateDependence::cowper_symonds(D, q)));
    for (int n = 0; n < 200; ++n) {
      const double dt = std::pow(10.0, -6.0 + 5.0 * random()); // s
      const double lost = point.move(random.tensor<3>(std::pow(10.0, -2.5 + 1.5 * random())), dt);
      const auto s = deviator(point.stress);
      const double flow = std::sqrt(1.5 * contract(s, s)), dp = lost / flow;
      const double yield =
          curve.yield_stress(point.history[0]) * (1.0 + std::pow(dp / (D * dt), 1.0 / q));
      if (dp > 0.0)
        worst = std::max(worst, std::abs(flow / yield - 1.0));
    }
  }
  EXPECT_LT(worst, 1e-12); // of the trial stress, up to 100 times the yield stress
}

} // namespace
} // namespace kerf
