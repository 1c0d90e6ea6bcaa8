// Non-viscous damping and the componentwise form.
#include "dem_core/damping.hpp"

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

} // namespace
} // namespace kerf
