// alpha: distance to a boundary over the width of the zone, Rojek (2008) eqs 28-32.
#include "coupler/methods/overlap.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kerf::coupler {
namespace {

TEST(Overlap, the_distance_to_segments_is_that_to_the_nearest_point) {
  // Two segments that make a corner at (1, 0); expected values by Pythagoras.
  const std::vector<double> nodes = {0, 0, 1, 0, 1, 1};
  const std::vector<std::uint32_t> faces = {0, 1, 1, 2};
  const std::vector<double> points = {0.5, 0.25, 2.0, 0.5, -3.0, -4.0, 2.0, -1.0};
  const auto d = distance_to_boundary<2>(faces, nodes, points, 100.0, {});
  EXPECT_DOUBLE_EQ(d[0], 0.25);
  EXPECT_DOUBLE_EQ(d[1], 1.0);
  EXPECT_DOUBLE_EQ(d[2], 5.0);
  EXPECT_DOUBLE_EQ(d[3], std::sqrt(2.0));
}

TEST(Overlap, the_distance_to_a_quadrilateral_in_space_is_that_to_its_nearest_point) {
  const std::vector<double> nodes = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0};
  const std::vector<std::uint32_t> faces = {0, 1, 2, 3};
  const std::vector<double> points = {0.5, 1.5, 3.0, 1.5, 0.5, -2.0, 5.0, 6.0, 0.0, -1.0, 1.0, 1.0};
  const auto d = distance_to_boundary<3>(faces, nodes, points, 100.0, {});
  EXPECT_DOUBLE_EQ(d[0], 3.0);            // over the second triangle
  EXPECT_DOUBLE_EQ(d[1], 2.0);            // over the first one
  EXPECT_DOUBLE_EQ(d[2], 5.0);            // from the corner (2, 2, 0)
  EXPECT_DOUBLE_EQ(d[3], std::sqrt(2.0)); // from an edge
}

TEST(Overlap, a_periodic_boundary_is_as_near_as_its_nearest_image) {
  const std::vector<double> nodes = {0, 0, 0, 1};
  const std::vector<std::uint32_t> faces = {0, 1};
  const Period<2> period{Vec<2>(0.0, 3.0)};
  const std::vector<double> points = {0.0, 2.5, 0.3, 3.5};
  const auto d = distance_to_boundary<2>(faces, nodes, points, 100.0, period);
  EXPECT_NEAR(d[0], 0.5, 1e-15); // from the image of (0, 0) at (0, 3)
  EXPECT_NEAR(d[1], 0.3, 1e-15);
}

TEST(Overlap, alpha_is_linear_over_the_width_and_one_beyond) {
  const std::vector<double> distance = {0.0, 0.25, 1.0, 2.0, 7.0, INFINITY};
  std::vector<double> alpha(distance.size());
  overlap_alpha(distance, 2.0, alpha);
  const std::vector<double> expected = {0.0, 0.125, 0.5, 1.0, 1.0, 1.0};
  EXPECT_EQ(alpha, expected);
  EXPECT_THROW(overlap_alpha(distance, 0.0, alpha), std::invalid_argument);
  alpha.pop_back();
  EXPECT_THROW(overlap_alpha(distance, 2.0, alpha), std::invalid_argument);
}

} // namespace
} // namespace kerf::coupler
