// No law gives back more than it took.
#include "fem_core/laws/plane_stress.hpp"
#include "tests/cases/law_point.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace kerf {
namespace {

using cases::LawPoint;
using cases::Random;
using fem::DruckerPrager;
using fem::Hardening;
using fem::IsotropicDamage;
using fem::J2Plastic;
using fem::PlaneStress;

/// The least that is dissipated by an increment of a random walk, over the elastic energy of its
/// size.
template <int dim, class Law> double least_dissipation(const Law& law, double step) {
  Random random;
  LawPoint<Law, dim> point(law, 1e-3);
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 3000; ++n) {
    const double size = step * std::pow(10.0, 2.0 * random());
    const double lost = point.move(random.tensor<dim>(size), 1e-4 * std::pow(10.0, 3.0 * random()));
    least = std::min(least, lost / (law.moduli.uniaxial() * size * size));
  }
  EXPECT_GT(point.dissipated, 0.0);
  return least;
}

// Second law. Tolerance: rounding of the two parts, of shear and of volume, of Drucker-Prager.
TEST(Laws, a_random_walk_never_has_negative_dissipation) {
  constexpr double rounding = -1e-14;
  const auto voce = Hardening::voce(300e6, 150e6, 200.0);
  const auto steel = J2Plastic::from(cases::steel(), voce);
  const auto rated =
      J2Plastic::from(cases::steel(), voce, fem::RateDependence::cowper_symonds(40.0, 5.0));
  EXPECT_GE(least_dissipation<3>(steel, 1e-3), 0.0);
  EXPECT_GE(least_dissipation<2>(rated, 1e-3), 0.0);
  EXPECT_GE(least_dissipation<2>(PlaneStress(steel), 1e-3), 0.0);
  for (const double cutoff : {-1.0, 0.0, 2e6})
    for (const double dilation : {0.0, 10.0, 30.0}) {
      auto parameters = cases::sandstone();
      parameters.tension_cutoff = cutoff;
      parameters.dilation_angle = cases::degrees(dilation);
      const auto rock = DruckerPrager::from(cases::rock(), parameters);
      EXPECT_GE(least_dissipation<3>(rock, 1e-3), rounding);
      EXPECT_GE(least_dissipation<2>(PlaneStress(rock), 1e-3), rounding);
    }
  EXPECT_GE(least_dissipation<3>(cases::brittle_rock(), 1e-5), 0.0);
  EXPECT_GE(least_dissipation<2>(PlaneStress(cases::brittle_rock()), 1e-5), 0.0);
}

// First law: the work that is not dissipated is the elastic energy. Both are integrated, the
// dissipation with the stress at the end: the difference falls with the steps.
template <class Law> double energy_gap(const Law& law, int steps) {
  LawPoint<Law> point(law, 1e-3);
  const cases::Tensor<3> strain{4e-3, -1e-3, 5e-4, 1e-3, -2e-3, 3e-3};
  for (int n = 0; n < steps; ++n)
    point.move(1.0 / steps * strain);
  double stiffness_left = 1.0;
  if constexpr (std::is_same_v<Law, IsotropicDamage>)
    stiffness_left = 1.0 - point.history[0];
  const double p = trace(point.stress) / 3.0;
  const auto s = deviator(point.stress);
  const double elastic =
      (contract(s, s) / (4.0 * law.moduli.mu) + p * p / (2.0 * law.moduli.bulk())) / stiffness_left;
  return std::abs(point.work - point.dissipated - elastic) / point.work;
}
TEST(Laws, the_work_that_is_not_dissipated_is_stored) {
  const auto steel = J2Plastic::from(cases::steel(), Hardening::linear(300e6, 20e9));
  const auto sandstone = DruckerPrager::from(cases::rock(), cases::sandstone());
  for (const int steps : {100, 1000}) {
    EXPECT_LT(energy_gap(steel, steps), 1.0 / steps);
    EXPECT_LT(energy_gap(sandstone, steps), 1.0 / steps);
    EXPECT_LT(energy_gap(cases::brittle_rock(), steps), 1.0 / steps);
  }
}

} // namespace
} // namespace kerf
