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

// The stiffest modes of a rectangle h_x by h_y stretch it uniformly: omega² = 4 / (rho h_x h_y)
// times the largest eigenvalue of [[C11 h_y/h_x, C12], [C12, C11 h_x/h_y]]. At constant mass a
// square that is squeezed to half its length has rho h_x h_y as before. The tolerance is rounding.
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
  const double C11 = 12e9, C12 = 4e9;
  EXPECT_NEAR(after / before, (1.25 * C11 + std::hypot(0.75 * C11, C12)) / (C11 + C12), 1e-9);
  EXPECT_FALSE(engine.first_inverted());
  for (double& x : u)
    x *= 3.0; // through its own end
  engine.set_motion(u, std::vector<double>(u.size()));
  EXPECT_EQ(engine.first_inverted(), 0u);
  EXPECT_THROW(engine.step_limit(), std::runtime_error);
}

/// A bar with bulk viscosity, a part of which starts to move.
Settings<2> struck(double linear, double quadratic) {
  Settings<2> settings{.materials = cases::of<2>(rock, Formulation::full, true)};
  settings.materials[0].material.linear_viscosity = linear;
  settings.materials[0].material.quadratic_viscosity = quadratic;
  settings.initial = {{.box = Box<2>{.lower = {0.0, 0.0}, .upper = {5e-3, 3e-3}},
                       .velocity = InitialVelocity<2>{{1.0, 0.0}},
                       .pulse = {}}};
  return settings;
}

/// What the books miss after a time, over the energy at the start.
double missing(double share_of_step) {
  Engine<2> engine = bar(struck(0.06, 1.2));
  const double dt = share_of_step * 2.0 / std::sqrt(engine.step_limit().omega2);
  engine.start(dt);
  engine.integrate();
  const double start = engine.energies().balance();
  while (static_cast<double>(engine.step()) * dt < 3e-4)
    engine.integrate();
  const Energies e = engine.energies();
  EXPECT_LT(e.kinetic + e.elastic, 0.9 * start);
  EXPECT_GT(e.damped, 0.1 * start);
  return (e.balance() - start) / start;
}

// The critical step of a damped oscillator is 2 / omega (sqrt(1 + xi²) - xi). The viscous work is
// booked to first order in the step at least: half of the step, half of what is missing.
TEST(FemBulkViscosity, takes_its_share_of_the_step_and_damps_what_rings) {
  EXPECT_NEAR(std::sqrt(bar(struck(0.0, 0.0)).step_limit().omega2 /
                        bar(struck(0.06, 1.2)).step_limit().omega2),
              std::sqrt(1.0 + 0.06 * 0.06) - 0.06, 1e-12);
  const double coarse = missing(0.4), fine = missing(0.2);
  std::printf("  missing of the energy at 0.4 and 0.2 of the critical step: %.2e, %.2e\n", coarse,
              fine);
  EXPECT_LE(std::abs(missing(0.9)), 0.1);
  EXPECT_GT(coarse / fine, 1.6);
}

} // namespace
} // namespace kerf::fem
