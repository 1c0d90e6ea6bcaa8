// The critical step of a body that deforms, and bulk viscosity.
#include "tests/cases/fem_bodies.hpp"

#include <gtest/gtest.h>

namespace kerf::fem {
namespace {

using cases::rock;

/// A bar of 20 x 3 elements of 1 mm.
Engine<2> bar(const Settings<2>& settings) {
  return Engine<2>(make_box(BoxMesh<2>{.size = {20e-3, 3e-3}, .count = {20, 3}}), settings);
}

// Squeezed to half its length at constant mass a quad has twice the stiffness along the bar per
// mass four times: omega² goes with 1 / h². The mean of the stretched quad is within the bound of
// h_x = 1/2, h_y = 1: between 1 and 4 times that of the square, and above half of 4.
TEST(FemStepLimit, falls_as_elements_are_squeezed) {
  Settings<2> settings{.materials = cases::of<2>(rock, Formulation::full, true)};
  Engine<2> engine = bar(settings);
  const double before = engine.step_limit().omega2;
  engine.start(1e-8);
  std::vector<double> u(engine.mesh().positions.size());
  for (std::size_t a = 0; a < engine.mesh().num_nodes(); ++a)
    u[2 * a] = -0.5 * engine.mesh().position(a)[0];
  engine.set_motion(u, std::vector<double>(u.size()));
  const double after = engine.step_limit().omega2;
  EXPECT_GT(after / before, 2.0);
  EXPECT_LT(after / before, 4.0);
  EXPECT_FALSE(engine.first_inverted());
  for (double& x : u)
    x *= 3.0; // through its own end
  engine.set_motion(u, std::vector<double>(u.size()));
  EXPECT_EQ(engine.first_inverted(), 0u);
  EXPECT_THROW(engine.step_limit(), std::runtime_error);
}

// The critical step of a damped oscillator is 2 / omega (sqrt(1 + xi²) - xi). With the bound of the
// elements the highest mode of a square has xi = b_1 sqrt of (C11 / modulus of the mode), at most
// b_1 for the P modes: a run at 0.98 of the limit stays bounded, and loses energy.
TEST(FemBulkViscosity, takes_its_share_of_the_step_and_damps_what_rings) {
  Settings<2> settings{.materials = cases::of<2>(rock, Formulation::full, true)};
  settings.materials[0].material.linear_viscosity = 0.06;
  settings.materials[0].material.quadratic_viscosity = 1.2;
  settings.initial = {{.box = Box<2>{.lower = {0.0, 0.0}, .upper = {5e-3, 3e-3}},
                       .velocity = InitialVelocity<2>{{1.0, 0.0}},
                       .pulse = {}}};
  Engine<2> engine = bar(settings);
  Settings<2> without = settings;
  without.materials = cases::of<2>(rock, Formulation::full, true);
  EXPECT_NEAR(std::sqrt(bar(without).step_limit().omega2 / engine.step_limit().omega2),
              std::sqrt(1.0 + 0.06 * 0.06) - 0.06, 1e-12);
  engine.start(0.98 * 2.0 / std::sqrt(engine.step_limit().omega2));
  engine.integrate();
  const double start = engine.energies().kinetic;
  for (int n = 0; n < 2000; ++n)
    engine.integrate();
  const Energies e = engine.energies();
  EXPECT_LT(e.kinetic + e.elastic, start);
  EXPECT_GT(e.damped, 0.05 * start);
  EXPECT_NEAR(e.balance(), start, 0.05 * start); // booked to first order in the step
}

} // namespace
} // namespace kerf::fem
