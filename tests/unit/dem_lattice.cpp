// Lattices and their bonds.
#include "tests/cases/dem_models.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::LatticeType;

template <int dim>
std::vector<Vec<dim>> points(LatticeType type, std::array<int, dim> count, Vec<dim> origin) {
  return dem::lattice_points(
      dem::Lattice<dim>{.type = type, .spacing = 2.0, .origin = origin, .count = count});
}

TEST(Lattice, chain_runs_along_x_from_its_origin) {
  const auto x = points<3>(LatticeType::chain, {4, 1, 1}, {1.0, 2.0, 3.0});
  ASSERT_EQ(x.size(), 4u);
  EXPECT_EQ(x.front(), (Vec<3>(1.0, 2.0, 3.0)));
  EXPECT_EQ(x.back(), (Vec<3>(7.0, 2.0, 3.0)));
}

TEST(Lattice, triangular_has_odd_rows_shifted_by_half_a_spacing) {
  const auto x = points<2>(LatticeType::triangular, {3, 4}, {0.0, 1.0});
  ASSERT_EQ(x.size(), 12u);
  EXPECT_EQ(x[1], (Vec<2>(2.0, 1.0)));
  EXPECT_NEAR((x[3] - Vec<2>(1.0, 1.0 + std::sqrt(3.0))).norm(), 0.0, 1e-15);
  EXPECT_NEAR((x[6] - Vec<2>(0.0, 1.0 + 2.0 * std::sqrt(3.0))).norm(), 0.0, 1e-14);
}

TEST(Lattice, fcc_has_four_particles_a_cube_and_twelve_neighbours_inside) {
  const auto x = points<3>(LatticeType::fcc, {3, 4, 5}, Vec<3>::Zero());
  EXPECT_EQ(x.size(), 240u);
  int neighbours = 0;
  const Vec<3> middle = 2.0 * std::sqrt(2.0) * Vec<3>(1.0, 1.0, 1.0);
  for (const Vec<3>& y : x)
    neighbours += std::abs((y - middle).norm() - 2.0) < 1e-12 ? 1 : 0;
  EXPECT_EQ(neighbours, 12);
}

TEST(Lattice, square_and_cubic_count_x_fastest) {
  EXPECT_EQ(points<2>(LatticeType::square, {3, 2}, Vec<2>::Zero())[4], (Vec<2>(2.0, 2.0)));
  EXPECT_EQ(points<3>(LatticeType::cubic, {2, 3, 4}, Vec<3>::Zero())[9], (Vec<3>(2.0, 2.0, 2.0)));
}

TEST(Lattice, refuses_what_does_not_exist) {
  EXPECT_THROW(points<2>(LatticeType::fcc, {1, 1}, Vec<2>::Zero()), std::invalid_argument);
  EXPECT_THROW(points<3>(LatticeType::triangular, {1, 1, 1}, Vec<3>::Zero()),
               std::invalid_argument);
  EXPECT_THROW(points<2>(LatticeType::chain, {4, 2}, Vec<2>::Zero()), std::invalid_argument);
  EXPECT_THROW(points<2>(LatticeType::square, {0, 2}, Vec<2>::Zero()), std::invalid_argument);
}

// Bonds of m x n particles: m - 1 in each row, and 2 m - 1 between two rows.
TEST(Bonds, of_a_triangular_lattice_join_nearest_neighbours) {
  const dem::Engine<2> engine(cases::lattice_model<2>(LatticeType::triangular, {7, 5}, rock(2)));
  EXPECT_EQ(engine.bonds(), 5u * 6u + 4u * 13u);
  EXPECT_EQ(engine.contacts().size(), engine.bonds());
}

// Periodic in y with an even number of rows: every particle inside has six.
TEST(Bonds, cross_a_period) {
  auto settings = cases::lattice_model<2>(LatticeType::triangular, {7, 4}, rock(2));
  settings.period.length[1] = 4.0 * 0.5 * std::numbers::sqrt3 * spacing;
  EXPECT_EQ(dem::Engine<2>(settings).bonds(), 4u * 6u + 4u * 13u);
  settings.period.length[1] = 1.5 * spacing;
  EXPECT_THROW(dem::Engine<2>{settings}, std::invalid_argument);
}

TEST(Bonds, are_made_where_the_gap_is_within_the_tolerance) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2));
  settings.positions[1][0] = 1.05 * spacing;
  settings.gap_tolerance = 0.0499;
  EXPECT_EQ(dem::Engine<2>(settings).bonds(), 0u);
  settings.gap_tolerance = 0.0501;
  const dem::Engine<2> engine(settings);
  EXPECT_EQ(engine.bonds(), 1u);
  EXPECT_EQ(engine.contacts().rest_length[0], 1.05 * spacing);
}

TEST(Particles, that_share_a_centre_are_refused) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2));
  settings.positions[1] = settings.positions[0];
  EXPECT_THROW(dem::Engine<2>{settings}, std::invalid_argument);
}

} // namespace
} // namespace kerf
