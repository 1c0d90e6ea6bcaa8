// The search for neighbours, and the history of contacts across it.
#include "tests/cases/dem_models.hpp"

#include "dem_core/neighbours.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <limits>
#include <random>

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

template <int dim> struct Cloud {
  std::vector<Vec<dim>> x;
  std::vector<double> r;
};

/// Particles anywhere in a box, with radii that are as often in each octave of their range.
template <int dim>
Cloud<dim> cloud(std::size_t count, const Vec<dim>& lower, const Vec<dim>& upper, double least,
                 double most) {
  std::mt19937 random(3);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967295.0; };
  Cloud<dim> particles;
  for (std::size_t i = 0; i < count; ++i) {
    Vec<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = lower[a] + (upper[a] - lower[a]) * uniform();
    particles.x.push_back(x);
    particles.r.push_back(least * std::pow(most / least, uniform()));
  }
  return particles;
}

/// @return the number of pairs
template <int dim>
std::size_t expect_all_pairs(const Cloud<dim>& particles, double reach, const Period<dim>& period) {
  const auto expected = all_pairs<dim>(particles.x, particles.r, reach, period);
  EXPECT_EQ(dem::find_pairs<dim>(particles.x, particles.r, reach, period), expected);
  return expected.size();
}

/// Periodic along none, each and all of the axes; with particles several periods away, too.
template <int dim> void rows_find_what_comparing_all_finds(double least, double most) {
  const auto particles =
      cloud<dim>(400, Vec<dim>::Constant(-1.2), Vec<dim>::Constant(1.8), least, most);
  for (const double edge : {4.0 * most + 0.02, 0.73, 1.0, 4.0})
    for (int axes = 0; axes < 1 << dim; ++axes) {
      Period<dim> period;
      for (int a = 0; a < dim; ++a)
        period.length[a] = axes >> a & 1 ? edge : 0.0;
      EXPECT_GT(expect_all_pairs<dim>(particles, 0.01, period), 10u);
    }
}
TEST(Neighbours, in_rows_are_those_of_comparing_all_with_all_in_2D) {
  rows_find_what_comparing_all_finds<2>(0.02, 0.07);
}
TEST(Neighbours, in_rows_are_those_of_comparing_all_with_all_in_3D) {
  rows_find_what_comparing_all_finds<3>(0.05, 0.12);
}
TEST(Neighbours, of_very_different_sizes_are_those_of_comparing_all_with_all) {
  rows_find_what_comparing_all_finds<2>(0.0015, 0.15);
  rows_find_what_comparing_all_finds<3>(0.0015, 0.15);
}

TEST(Neighbours, in_thin_slabs_and_bars_are_those_of_comparing_all_with_all) {
  for (int thin = 1; thin < 7; ++thin) {
    Vec<3> upper;
    for (int a = 0; a < 3; ++a)
      upper[a] = thin >> a & 1 ? 1e-3 : thin == 1 || thin == 2 || thin == 4 ? 1.0 : 5.0;
    EXPECT_GT(expect_all_pairs<3>(cloud<3>(400, Vec<3>::Zero(), upper, 0.01, 0.02), 0.01, {}), 50u);
  }
}

TEST(Neighbours, where_all_are_at_one_place_are_all) {
  const auto particles = cloud<3>(200, Vec<3>::Zero(), Vec<3>::Constant(0.1), 0.5, 0.9);
  EXPECT_EQ(expect_all_pairs<3>(particles, 0.01, {}), 200u * 199u / 2u);
}

// At distances of exactly half a period two images of a neighbour are equally near: it counts once.
TEST(Neighbours, at_half_a_period_count_once) {
  Cloud<3> lattice;
  for (int i = 0; i < 64; ++i)
    lattice.x.push_back(0.5 * Vec<3>(i % 4, i / 4 % 4, i / 16));
  lattice.r.assign(64, 0.25);
  EXPECT_GT(expect_all_pairs<3>(lattice, 0.5, {Vec<3>::Constant(2.0)}), 0u);
  EXPECT_GT(expect_all_pairs<3>(lattice, 0.0, {Vec<3>(2.0, 2.0, 0.0)}), 0u);
  lattice.x.resize(8);
  for (int i = 0; i < 8; ++i)
    lattice.x[i] = 0.5 * Vec<3>(i & 1, i >> 1 & 1, i >> 2);
  lattice.r.resize(8);
  EXPECT_EQ(expect_all_pairs<3>(lattice, 0.0, {Vec<3>::Ones()}), 12u);
}

// A reach below zero asks for overlaps; one that is larger than both radii together finds nobody.
TEST(Neighbours, that_overlap_by_more_than_an_amount_can_be_asked_for) {
  const auto particles = cloud<2>(300, Vec<2>::Zero(), Vec<2>::Ones(), 0.01, 0.08);
  EXPECT_GT(expect_all_pairs<2>(particles, -0.03, {}), 50u);
  EXPECT_EQ(expect_all_pairs<2>(particles, -0.3, {}), 0u);
}

TEST(Neighbours, are_found_although_particles_are_lost_in_space) {
  auto particles = cloud<3>(400, Vec<3>::Zero(), Vec<3>::Ones(), 0.01, 0.1);
  particles.x[7] = {1e300, 0.5, 0.5};
  particles.x[20] = {0.5, -1e300, 0.5};
  particles.x[21] = {0.5, -1e200, 1e16};
  particles.x[100] = {0.5, 0.5, std::numeric_limits<double>::infinity()};
  particles.x[101] = {std::nan(""), 0.5, 0.5};
  particles.x[102] = particles.x[103] = {1e6, 1e7, 1e8};
  EXPECT_GT(expect_all_pairs<3>(particles, 0.01, {}), 50u);
  particles.x[21] = {0.5, -1e6, 1e9};
  EXPECT_GT(expect_all_pairs<3>(particles, 0.01, {Vec<3>(0.0, 0.0, 1.0)}), 50u);
}

TEST(Neighbours, are_the_same_for_any_number_of_threads) {
  const auto particles = cloud<3>(5000, Vec<3>::Zero(), Vec<3>::Ones(), 0.01, 0.05);
  omp_set_num_threads(1);
  const auto alone = dem::find_pairs<3>(particles.x, particles.r, 0.01, {});
  omp_set_num_threads(3);
  EXPECT_EQ(dem::find_pairs<3>(particles.x, particles.r, 0.01, {}), alone);
  omp_set_num_threads(omp_get_num_procs());
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
