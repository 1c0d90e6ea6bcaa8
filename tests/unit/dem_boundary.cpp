// Prescribed motion and the initial state.
#include "tests/cases/dem_models.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::LatticeType;

// Reference: u(t_n) = A (1 - cos(2 pi t_n / T)) / 2, zero from T on. Tolerance: the rounding of 300
// sums of steps.
TEST(Boundary, hann_motion_has_exact_positions) {
  auto settings = cases::lattice_model<2>(LatticeType::chain, {5, 1}, rock(2));
  auto driven = cases::prescribe_at<2>({0.0, 0.0}, dem::Motion::hann);
  driven.amplitude = {1e-6, -2e-6};
  driven.duration = 2.003e-5;
  settings.boundary = {driven};
  dem::Engine<2> engine(settings);
  const double dt = 1e-7;
  engine.start(dt);
  for (int n = 0; n <= 300; ++n) {
    const double t = n * dt;
    const double share = t < driven.duration
                             ? 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * t / driven.duration))
                             : 0.0;
    EXPECT_NEAR(engine.particles().displacement[0][0], 1e-6 * share, 1e-19) << n;
    EXPECT_NEAR(engine.particles().displacement[0][1], -2e-6 * share, 2e-19) << n;
    cases::step(engine);
  }
}

TEST(Boundary, prescribes_single_components_and_leaves_rotations_free_unless_named) {
  auto settings = cases::lattice_model<2>(LatticeType::triangular, {3, 3}, rock(2));
  auto fixed = cases::prescribe_at<2>({0.0, 0.0}, dem::Motion::fixed);
  fixed.components = 1; // x
  auto clamped = cases::prescribe_at<2>({spacing, 0.0}, dem::Motion::velocity, {0.0, 0.25});
  clamped.components = 2 | 4; // y and rotation
  settings.boundary = {fixed, clamped};
  cases::shake(settings, 1e-3, 1);
  dem::Engine<2> engine(settings);
  engine.start(1e-8);
  for (int n = 0; n < 50; ++n)
    cases::step(engine);
  const auto& p = engine.particles();
  EXPECT_EQ(p.displacement[0][0], 0.0);
  EXPECT_NE(p.displacement[0][1], 0.0);
  EXPECT_NE(p.angular_velocity[0][0], 0.0);
  EXPECT_NE(p.displacement[1][0], 0.0);
  EXPECT_NEAR(p.displacement[1][1], 50 * 1e-8 * 0.25, 1e-20);
  EXPECT_EQ(p.angular_velocity[1][0], 0.0);

  const std::uint32_t points[] = {0, 1};
  double inverse_mass[4], position[4], velocity[4];
  engine.inverse_mass(points, inverse_mass);
  EXPECT_EQ(inverse_mass[0], 0.0);
  EXPECT_DOUBLE_EQ(inverse_mass[1], 1.0 / p.mass[0]);
  EXPECT_EQ(inverse_mass[3], 0.0);
  engine.motion(points, position, velocity);
  EXPECT_EQ(velocity[0], 0.0);
  EXPECT_EQ(velocity[1], p.velocity[0][1]);
  EXPECT_EQ(velocity[3], 0.25);
}

// motion() of a prescribed component tells where the point goes next, so that a constraint on it
// can be met: x^(n+1) = x^n + velocity dt.
TEST(Boundary, velocity_of_a_prescribed_component_is_the_one_it_is_about_to_have) {
  auto settings = cases::lattice_model<2>(LatticeType::chain, {3, 1}, rock(2));
  auto driven = cases::prescribe_at<2>({0.0, 0.0}, dem::Motion::hann);
  driven.amplitude = {1e-6, 0.0};
  driven.duration = 1e-6;
  settings.boundary = {driven};
  dem::Engine<2> engine(settings);
  engine.start(1e-7);
  const std::uint32_t points[] = {0};
  double before[2], after[2], velocity[2], unused[2];
  for (int n = 0; n < 12; ++n) {
    engine.motion(points, before, velocity);
    cases::step(engine);
    engine.motion(points, after, unused);
    EXPECT_NEAR(after[0], before[0] + 1e-7 * velocity[0], 1e-21); // rounding of 1e-6 m
  }
}

// Reference: in a chain waves have omega = 2 sqrt(k/m) sin(k d / 2), which the velocities follow,
// so that a pulse goes one way. Measured 60 spacings behind its start after it has gone 100, where
// only what travels backwards can be. Tolerance: the pulse has a kink of third order at its ends,
// and a tail of short waves with it; 1e-6 of the energy.
TEST(InitialPulse, in_a_chain_travels_one_way) {
  auto settings = cases::lattice_model<2>(LatticeType::chain, {300, 1}, rock(2));
  const double mass = dem::Engine<2>(settings).particles().mass[0];
  dem::InitialCondition<2> condition;
  condition.pulse = dem::Pulse{.amplitude = 1e-3 * spacing,
                               .center = 150.0 * spacing,
                               .length = 40.0 * spacing,
                               .wave_speed = spacing * std::sqrt(1e10 / mass),
                               .spacing = spacing};
  settings.initial = {condition};
  dem::Engine<2> engine(settings);
  const double dt = 0.8 * std::sqrt(mass / 1e10);
  engine.start(dt);
  for (int n = 0; n < 125; ++n) // 100 spacings
    cases::step(engine);
  double backward = 0.0, forward = 0.0;
  for (std::size_t i = 0; i < engine.size(); ++i)
    (i < 90 ? backward : forward) += engine.particles().velocity[i].squaredNorm();
  EXPECT_LT(backward, 1e-6 * forward);
}

// A transverse pulse in a lattice needs the shear forces and rotations of its displacement, or it
// would split. Long waves: c = sqrt(C66 / rho), rho = m / cell; lambda = 24 d: dispersion and the
// rotation of the continuum leave some 1e-4.
TEST(InitialPulse, transverse_in_a_lattice_travels_one_way) {
  auto settings = cases::lattice_model<2>(LatticeType::triangular, {160, 6}, rock(2));
  settings.period.length[1] = 6.0 * 0.5 * std::numbers::sqrt3 * spacing;
  const double mass = dem::Engine<2>(settings).particles().mass[0];
  const double C66 = std::numbers::sqrt3 / 4.0 * (1e10 + 2e9);
  const double density = mass / (0.5 * std::numbers::sqrt3 * spacing * spacing);
  dem::InitialCondition<2> condition;
  condition.pulse = dem::Pulse{.amplitude = 1e-5 * spacing,
                               .center = 80.0 * spacing,
                               .length = 24.0 * spacing,
                               .wave_speed = std::sqrt(C66 / density),
                               .spacing = 0.0,
                               .component = 1,
                               .axis = 0};
  settings.initial = {condition};
  dem::Engine<2> engine(settings);
  const double dt = 0.8 * 2.0 / std::sqrt(engine.step_limit().omega2);
  engine.start(dt);
  const int steps = static_cast<int>(40.0 * spacing / (std::sqrt(C66 / density) * dt));
  for (int n = 0; n < steps; ++n)
    cases::step(engine);
  double backward = 0.0, forward = 0.0;
  for (std::size_t i = 0; i < engine.size(); ++i)
    (settings.positions[i][0] < 80.0 * spacing ? backward : forward) +=
        engine.particles().velocity[i].squaredNorm();
  std::printf("transverse pulse: %.1e of its energy goes back\n", backward / forward);
  EXPECT_LT(backward, 1e-3 * forward);
}

} // namespace
} // namespace kerf
