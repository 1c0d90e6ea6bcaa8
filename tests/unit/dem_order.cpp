// The order of particles in memory, and the names that the user gave them.
#include "tests/cases/dem_models.hpp"

#include "dem_core/spatial_order.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;

/// What a model is refused with.
template <int dim> std::string refusal(const dem::Settings<dim>& settings) {
  try {
    dem::Engine<dim> engine(settings);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing";
}

TEST(SpatialOrder, keeps_position_radius_and_id_of_a_particle_together) {
  const auto given = cases::irregular_model<3>(7, rock(3), 4);
  auto ordered = given;
  dem::put_in_spatial_order(ordered);
  ASSERT_EQ(ordered.ids.size(), given.positions.size());
  EXPECT_NE(ordered.positions, given.positions);
  std::vector<bool> seen(given.positions.size(), false);
  for (std::size_t k = 0; k < ordered.ids.size(); ++k) {
    const std::uint32_t id = ordered.ids[k];
    EXPECT_EQ(ordered.positions[k], given.positions[id]);
    EXPECT_EQ(ordered.radii[k], given.radii[id]);
    EXPECT_FALSE(seen[id]);
    seen[id] = true;
  }
}

// The sums over contacts are in another order: 200 steps of rounding.
TEST(SpatialOrder, changes_nothing_but_rounding) {
  auto given = cases::irregular_model<2>(12, rock(2, 0.5), 4);
  cases::shake(given, 1e-3, 7);
  auto ordered = given;
  dem::put_in_spatial_order(ordered);
  dem::Engine<2> a(given), b(ordered);
  EXPECT_DOUBLE_EQ(a.step_limit().omega2, b.step_limit().omega2);
  EXPECT_EQ(a.step_limit().limited_by, b.step_limit().limited_by);
  const double step = 1.0 / std::sqrt(a.step_limit().omega2);
  a.start(step);
  b.start(step);
  for (int n = 0; n < 200; ++n) {
    cases::step(a);
    cases::step(b);
  }
  for (std::size_t k = 0; k < b.size(); ++k)
    EXPECT_LT((b.particles().velocity[k] - a.particles().velocity[ordered.ids[k]]).norm(), 1e-12);
}

TEST(Errors, call_particles_by_the_ids_of_the_user) {
  auto settings = cases::lattice_model<2>(dem::LatticeType::square, {3, 3}, rock(2));
  settings.ids = {40, 41, 42, 43, 44, 45, 46, 47, 48};
  settings.radii[5] = -1.0;
  EXPECT_NE(refusal(settings).find("particle 45"), std::string::npos);
  settings.radii[5] = 0.5 * spacing;
  settings.positions[3][1] = std::nan("");
  EXPECT_NE(refusal(settings).find("particle 43"), std::string::npos);
  settings.ids.pop_back();
  EXPECT_NE(refusal(settings).find("9 positions but 8 ids"), std::string::npos);
}

TEST(Overlap, of_more_than_half_of_the_radii_is_refused_with_both_ids) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2));
  settings.ids = {7, 3};
  settings.positions[1][0] = 0.51 * spacing;
  EXPECT_EQ(refusal(settings), "nothing");
  EXPECT_EQ(dem::Engine<2>(settings).bonds(), 1u); // free of stress at this distance
  for (const double distance : {0.49 * spacing, 0.0}) {
    settings.positions[1][0] = distance;
    EXPECT_NE(refusal(settings).find("particles 7 and 3"), std::string::npos);
  }
}

TEST(Particles, without_a_contact_fly_on_and_limit_no_step) {
  auto settings = cases::pair_model<3>({1.0, 0.0, 0.0}, rock(3));
  settings.positions[1] *= 50.0;
  dem::InitialCondition<3> moving;
  moving.velocity = {1.0, 2.0, 3.0};
  settings.initial = {moving};
  dem::Engine<3> engine(settings);
  EXPECT_EQ(engine.step_limit().omega2, 0.0);
  engine.start(1e-5);
  for (int n = 0; n < 100; ++n)
    cases::step(engine);
  EXPECT_EQ(engine.unbalanced_force(), 0.0);
  for (std::size_t i = 0; i < engine.size(); ++i)
    EXPECT_LT((engine.particles().displacement[i] - Vec<3>(1e-3, 2e-3, 3e-3)).norm(), 1e-15);
}

// A sphere with 100 times the radius of those that are bonded to it. Energy is conserved by a
// stable run, to the square of half the step over the period of the fastest of them.
TEST(Particles, a_hundred_times_as_large_as_others_are_followed) {
  dem::Settings<3> settings;
  settings.material = rock(3);
  settings.material.normal_stiffness = 1e5; // N/m
  settings.positions = {Vec<3>::Zero()};
  settings.radii = {50.0 * spacing};
  for (int k = 0; k < 40; ++k) {
    const double angle = 0.1 * k; // 5 diameters between neighbours
    settings.positions.push_back(50.5 * spacing * Vec<3>(std::cos(angle), std::sin(angle), 0.0));
    settings.radii.push_back(0.5 * spacing);
  }
  dem::put_in_spatial_order(settings);
  cases::shake(settings, 1e-3, 3);
  dem::Engine<3> engine(settings);
  EXPECT_EQ(engine.bonds(), 40u);
  engine.start(0.1 / std::sqrt(engine.step_limit().omega2));
  cases::step(engine);
  const auto total = [&] { return engine.energies().kinetic + engine.energies().elastic; };
  const double start = total();
  for (int n = 0; n < 2000; ++n)
    cases::step(engine);
  EXPECT_EQ(engine.bonds(), 40u);
  EXPECT_NEAR(total(), start, 0.01 * start);
}

TEST(Domain, is_left_by_a_particle_unless_space_repeats_there) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2));
  settings.positions[1] *= 3.0;
  dem::InitialCondition<2> moving;
  moving.velocity = {1.0, 0.0};
  settings.initial = {moving};
  const Box<2> domain{{-1.0 * spacing, -1.0}, {4.0 * spacing, 1.0}};
  for (const double period : {0.0, 5.0 * spacing}) {
    settings.period.length[0] = period;
    dem::Engine<2> engine(settings);
    engine.start(1e-5);
    EXPECT_EQ(engine.first_outside(domain), std::nullopt);
    for (int n = 0; n < 150; ++n) // 1.5 spacings
      cases::step(engine);
    EXPECT_EQ(engine.first_outside(domain),
              period == 0.0 ? std::optional<std::uint32_t>(1) : std::nullopt);
  }
}

} // namespace
} // namespace kerf
