// Non-viscous damping and the componentwise form.
#include "dem_core/damping.hpp"
#include "dem_core/engine.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using dem::damping_force;
using dem::DampingKind;

// Rojek (2008) eq. 18 by hand: |F| = 1.1180, v / |v| = (0.98058, 0.19612), 0.3 |F| = 0.33541:
// (1 - 0.32890, -0.5 - 0.06578). Tolerance: the digits given.
TEST(Damping, opposes_the_velocity_by_a_share_of_the_force) {
  const Vec<2> F(1.0, -0.5), v(1.0, 0.2);
  const Vec<2> damped = F + damping_force(DampingKind::nonviscous, 0.3, F, v);
  EXPECT_NEAR(damped[0], 0.671, 5e-4);
  EXPECT_NEAR(damped[1], -0.566, 5e-4);
}

// Components whose power is positive shrink by alpha, the others grow: (0.7, -0.65).
TEST(Damping, componentwise_scales_each_component_by_the_sign_of_its_power) {
  const Vec<2> F(1.0, -0.5), v(1.0, 0.2);
  const Vec<2> damped = F + damping_force(DampingKind::componentwise, 0.3, F, v);
  EXPECT_DOUBLE_EQ(damped[0], 0.7);
  EXPECT_DOUBLE_EQ(damped[1], -0.65);
}

// Eq. 18 is 0 / 0 at rest.
TEST(Damping, is_zero_at_rest) {
  const Vec<3> F(1.0, -0.5, 2.0);
  for (const auto kind : {DampingKind::nonviscous, DampingKind::componentwise})
    EXPECT_EQ(damping_force<Vec<3>>(kind, 0.3, F, Vec<3>::Zero()), (Vec<3>::Zero()));
}

// A particle on a vertical guide: what the guide carries, 10 m, does not damp the motion along it,
// of which the weight of 1 m is left by 1 - alpha. Rounding.
TEST(Damping, of_a_particle_that_is_held_in_part_counts_what_is_free) {
  for (const auto kind : {DampingKind::nonviscous, DampingKind::componentwise}) {
    dem::Settings<2> settings;
    settings.positions = {{0.0, 0.0}};
    settings.radii = {1.0};
    settings.material.density = 1.0;
    settings.material.normal_stiffness = 1.0;
    settings.damping = {kind, 0.3, 0.3};
    settings.gravity = {-10.0, -1.0};
    dem::Prescription<2> guide;
    guide.box = {Vec<2>::Constant(-1.0), Vec<2>::Constant(1.0)};
    guide.components = 1;
    settings.boundary = {guide};
    dem::Engine<2> engine(settings);
    engine.start(1e-3);
    engine.integrate();
    engine.compute_own_forces();
    const std::uint32_t point[] = {0};
    double force[2];
    engine.own_forces(point, force);
    const double mass = engine.particles().mass[0];
    EXPECT_NEAR(force[0], -10.0 * mass, 1e-14 * mass);
    EXPECT_NEAR(force[1], -0.7 * mass, 1e-14 * mass);
  }
}

} // namespace
} // namespace kerf
