// The search for neighbours, and the history of contacts across it.
#include "tests/cases/dem_models.hpp"

#include "dem_core/neighbours.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;

/// The same by comparing all with all.
template <int dim>
std::vector<dem::Pair> all_pairs(const std::vector<Vec<dim>>& x, const std::vector<double>& r,
                                 double reach, const Period<dim>& period) {
  std::vector<dem::Pair> pairs;
  for (std::uint32_t i = 0; i < x.size(); ++i)
    for (std::uint32_t j = i + 1; j < x.size(); ++j)
      if (period.shortest(x[j] - x[i]).norm() - (r[i] + r[j]) <= reach)
        pairs.push_back({i, j});
  return pairs;
}

template <int dim> void cells_find_what_comparing_all_finds() {
  std::mt19937 random(3);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967295.0; };
  std::vector<Vec<dim>> x(400);
  std::vector<double> r(400);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (int a = 0; a < dim; ++a)
      x[i][a] = 3.0 * uniform() - 1.2; // beyond the period, too
    r[i] = 0.02 + 0.05 * uniform();
  }
  for (const double length : {0.0, 0.31, 0.5, 1.0}) {
    Period<dim> period;
    period.length[0] = length;
    EXPECT_EQ(dem::find_pairs<dim>(x, r, 0.01, period), all_pairs<dim>(x, r, 0.01, period));
  }
}
TEST(Neighbours, in_cells_are_those_of_comparing_all_with_all_in_2D) {
  cells_find_what_comparing_all_finds<2>();
}
TEST(Neighbours, in_cells_are_those_of_comparing_all_with_all_in_3D) {
  cells_find_what_comparing_all_finds<3>();
}

TEST(Neighbours, of_very_different_sizes_are_those_of_comparing_all_with_all) {
  std::mt19937 random(5);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967295.0; };
  std::vector<Vec<3>> x(500);
  std::vector<double> r(500);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = {uniform(), uniform(), uniform()};
    r[i] = i < 3 ? 0.3 : i < 50 ? 0.03 : 0.003;
  }
  EXPECT_EQ(dem::find_pairs<3>(x, r, 0.01, {}), all_pairs<3>(x, r, 0.01, {}));
}

TEST(Neighbours, are_found_although_a_particle_is_lost_in_space) {
  const std::vector<Vec<2>> x = {{0.0, 0.0}, {1e300, 0.0}, {std::nan(""), 0.0}, {1.0, 0.0}};
  const std::vector<double> r(4, 0.6);
  EXPECT_EQ(dem::find_pairs<2>(x, r, 0.0, {}), (std::vector<dem::Pair>{{0, 3}}));
}

/// Two touching discs far from a third that flies past; the list is made again on the way.
TEST(Neighbours, new_lists_keep_the_history_of_contacts) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2));
  settings.positions.push_back({10.0 * spacing, 10.0 * spacing});
  settings.radii.push_back(0.5 * spacing);
  settings.material.tensile_strength = 1.0;
  settings.material.friction = 0.5;
  settings.boundary = {
      cases::prescribe_at<2>(settings.positions[0], dem::Motion::fixed),
      cases::prescribe_at<2>(settings.positions[1], dem::Motion::velocity, {-1e-3, 1e-4}),
      cases::prescribe_at<2>(settings.positions[2], dem::Motion::velocity, {1.0, 0.0})};
  dem::Engine<2> moving(settings);
  settings.boundary[2].motion = dem::Motion::fixed;
  dem::Engine<2> resting(settings);
  moving.start(1e-6);
  resting.start(1e-6);
  for (int n = 0; n < 1000; ++n) {
    cases::step(moving);
    cases::step(resting);
    ASSERT_EQ(moving.contacts().shear_force[0], resting.contacts().shear_force[0]);
    ASSERT_EQ(moving.contacts().normal_force[0], resting.contacts().normal_force[0]);
  }
  EXPECT_GT(moving.renewals(), 10u);
  EXPECT_EQ(resting.renewals(), 0u);
}

// A bond that broke keeps its distance even when the particles have been far apart in between:
// started with an overlap of 1 %, they touch again at 0.99 of the diameter only.
TEST(Neighbours, broken_bonds_remember_their_distance_from_far_away) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2));
  settings.positions[1][0] = 0.99 * spacing;
  settings.material.tensile_strength = 1.0;
  settings.boundary = {cases::prescribe_at<2>(settings.positions[0], dem::Motion::fixed),
                       cases::prescribe_at<2>(settings.positions[1], dem::Motion::hann)};
  settings.boundary[1].amplitude = {3.0 * spacing, 0.0};
  settings.boundary[1].duration = 1e-3;
  dem::Engine<2> engine(settings);
  engine.start(1e-6);
  for (int n = 0; n <= 1000; ++n) {
    cases::step(engine);
    // The last position is that of the start but for the rounding of 1000 steps, 1e-17 m.
    ASSERT_NEAR(engine.contacts().normal_force[0], 0.0, 1e-17 * 1e10) << n;
  }
  EXPECT_EQ(engine.bonds(), 0u);
  EXPECT_GT(engine.renewals(), 10u);
}

// New contacts: two discs that were apart collide; without friction or damping they part as fast as
// they came. Tolerance: the contact opens within a step of zero force, k_n (v dt)² / 2 of energy.
TEST(Neighbours, that_come_to_touch_repel_each_other) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2));
  settings.positions[1][0] = 1.5 * spacing;
  dem::InitialCondition<2> condition;
  condition.box = Box<2>{settings.positions[1], settings.positions[1]};
  condition.velocity = {-1.0, 0.0};
  settings.initial = {condition};
  dem::Engine<2> engine(settings);
  ASSERT_EQ(engine.contacts().size(), 0u);
  const double omega = std::sqrt(2e10 / engine.particles().mass[0]);
  const double dt = 0.02 / omega;
  engine.start(dt);
  const int steps = static_cast<int>(2.0 * 0.5 * spacing / dt);
  for (int n = 0; n < steps; ++n)
    cases::step(engine);
  EXPECT_GT(engine.renewals(), 0u);
  EXPECT_NEAR(engine.particles().velocity[0][0], -1.0, 1e-3); // equal masses swap velocities
  EXPECT_NEAR(engine.particles().velocity[1][0], 0.0, 1e-3);
}

// Pairs that are apart are not looked at in every step: each must be there when it touches, the
// overlap by the positions against the force. Rows of discs meet with speeds of a factor of 50.
TEST(Neighbours, that_are_apart_are_found_in_the_step_in_which_they_touch) {
  dem::Settings<2> settings;
  settings.material = rock(2);
  settings.bonds = false;
  for (int row = 0; row < 100; ++row)
    for (const double x : {0.0, 1.0 + 0.0004 * row, 2.01 + 0.0007 * row}) {
      settings.positions.push_back({x * spacing, 1.5 * row * spacing});
      settings.radii.push_back(0.5 * spacing);
    }
  for (std::size_t i = 0; i < settings.positions.size(); ++i) {
    dem::InitialCondition<2> condition;
    condition.box = Box<2>{settings.positions[i], settings.positions[i]};
    condition.velocity = {
        i % 3 == 1 ? 0.0 : (i % 3 == 0 ? 1.0 : -1.0) / (1.0 + static_cast<double>(i % 50)), 0.0};
    settings.initial.push_back(condition);
  }
  dem::Engine<2> engine(settings);
  engine.start(0.1 * 2.0 / std::sqrt(2e10 / engine.particles().mass[0]));
  std::size_t started = 0;
  std::vector<bool> touched(300, false);
  for (int n = 0; n < 1000; ++n) {
    engine.compute_own_forces();
    const auto& contacts = engine.contacts();
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const double opening = dem::span_of(contacts, engine.particles(), k).opening;
      ASSERT_EQ(contacts.normal_force[k] != 0.0, opening < 0.0) << n << " " << k << " " << opening;
      if (opening < 0.0 && !touched[contacts.first[k]]) {
        touched[contacts.first[k]] = true;
        ++started;
      }
    }
    engine.integrate();
  }
  EXPECT_GT(started, 20u);
}

} // namespace
} // namespace kerf
