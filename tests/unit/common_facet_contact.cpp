// Contacts of spheres with surfaces, and the search for facets.
#include "common/facet_contact.hpp"
#include "common/facet_grid.hpp"
#include "tests/cases/surfaces.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace kerf {
namespace {

using cases::box_surface;
using cases::Random;
using cases::sheet;
using std::numbers::pi;

template <int dim> using Contacts = std::vector<FacetContact<dim>>;

/// A surface with all that a sphere needs to touch it.
template <int dim> struct Body {
  Surface<dim> surface;
  SurfaceTopology<dim> topology{surface};

  Contacts<dim> touch(const Vec<dim>& centre, double radius) const {
    std::vector<std::uint32_t> all(surface.facets.size());
    std::iota(all.begin(), all.end(), 0U);
    Contacts<dim> contacts;
    find_contacts<dim>(centre, radius, surface.vertices, topology, all, contacts);
    return contacts;
  }
};

/// Force per stiffness on the sphere, the sum of overlap times direction, m.
template <int dim> Vec<dim> push(const Contacts<dim>& contacts) {
  Vec<dim> sum = Vec<dim>::Zero();
  for (const auto& contact : contacts)
    sum += contact.gap * contact.normal;
  return sum;
}

/// Where a convex function on [0, 1] is least, by golden section.
template <class Function> double least(Function function) {
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  double lower = 0.0, upper = 1.0;
  while (upper - lower > 1e-10) {
    const double left = upper - ratio * (upper - lower), right = lower + ratio * (upper - lower);
    if (function(left) < function(right))
      upper = right;
    else
      lower = left;
  }
  return 0.5 * (lower + upper);
}

/// Nearest point of a facet by minimisation alone, m.
template <int dim>
Vec<dim> nearest_on_line(const Vec<dim>& c, const Vec<dim>& a, const Vec<dim>& b) {
  return a + least([&](double s) { return (a + s * (b - a) - c).norm(); }) * (b - a);
}
Vec<2> nearest_point(const Vec<2>& c, const FacetShape<2>& x) {
  return nearest_on_line<2>(c, x[0], x[1]);
}
Vec<3> nearest_point(const Vec<3>& c, const FacetShape<3>& x) {
  const auto on_parallel = [&](double s) {
    return nearest_on_line<3>(c, x[0] + s * (x[1] - x[0]), x[0] + s * (x[2] - x[0]));
  };
  return on_parallel(least([&](double s) { return (on_parallel(s) - c).norm(); }));
}

Surface<2> wavy_line() {
  std::vector<Vec<2>> points;
  Random random(5);
  for (int i = 0; i < 12; ++i)
    points.emplace_back(0.1 * i, random.uniform(0.0, 0.15));
  auto line = cases::polygon(points);
  line.facets.pop_back(); // open
  return line;
}

Surface<3> wavy_sheet() {
  Random random(6);
  return sheet(6, [&](double u, double v) { return Vec<3>(u, v, random.uniform(0.0, 0.15)); });
}

/// Where the distance from c to the surface has a local minimum below a reach: at the nearest point
/// of a facet, unless another facet that has this point leads nearer.
template <int dim>
std::vector<Vec<dim>> minima(const Surface<dim>& surface, const Vec<dim>& c, double reach) {
  std::vector<Vec<dim>> nearest, found;
  for (std::size_t f = 0; f < surface.facets.size(); ++f)
    nearest.push_back(nearest_point(c, surface.shape(f)));
  for (const Vec<dim>& x : nearest) {
    bool is_minimum = (x - c).norm() < reach;
    for (std::size_t f = 0; is_minimum && f < surface.facets.size(); ++f)
      if ((nearest[f] - c).norm() < (x - c).norm() - 1e-7)
        is_minimum = (nearest_point(x, surface.shape(f)) - x).norm() > 1e-7;
    if (is_minimum)
      found.push_back(x);
  }
  return found;
}

// Reference: the distance to a facet is a convex function on it, which golden section minimises; it
// finds the place to 1e-8, where the function is flat to rounding.
template <int dim> void contacts_are_minima_of_the_distance(const Surface<dim>& surface) {
  const Body<dim> body{surface};
  Random random(1);
  std::size_t most = 0;
  for (int n = 0; n < 40; ++n) {
    const Vec<dim> centre = random.point<dim>(-0.1, 1.1);
    const double radius = random.uniform(0.1, 0.4);
    const auto contacts = body.touch(centre, radius);
    most = std::max(most, contacts.size());
    const auto expected = minima<dim>(surface, centre, radius);
    for (const auto& contact : contacts) {
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-14);
      Vec<dim> point = Vec<dim>::Zero();
      for (int k = 0; k < dim; ++k)
        point += contact.weight[k] * surface.shape(contact.facet)[k];
      EXPECT_LT((point - contact.point).norm(), 1e-14);
      EXPECT_TRUE(std::ranges::any_of(
          expected, [&](const Vec<dim>& x) { return (x - contact.point).norm() < 1e-6; }));
    }
    double shortest = radius;
    for (const Vec<dim>& x : expected) { // is a contact, or behind the tangent plane of one
      shortest = std::min(shortest, (x - centre).norm());
      EXPECT_TRUE(std::ranges::any_of(contacts, [&](const FacetContact<dim>& contact) {
        return (x - contact.point).norm() < 1e-6 || (x - contact.point).dot(contact.normal) > -1e-6;
      }));
    }
    EXPECT_NEAR(contacts.empty() ? 0.0 : contacts[0].gap, shortest - radius, 1e-9);
  }
  EXPECT_GT(most, 1U);
}
TEST(FacetContact, is_at_the_minima_of_the_distance_in_2D) {
  contacts_are_minima_of_the_distance<2>(wavy_line());
}
TEST(FacetContact, is_at_the_minima_of_the_distance_in_3D) {
  contacts_are_minima_of_the_distance<3>(wavy_sheet());
}

// Reference: distance to a box, |max(lower - x, x - upper, 0)|.
TEST(FacetContact, with_a_box_is_one_and_has_the_feature_that_is_nearest) {
  const Vec<3> size(1.0, 2.0, 0.5);
  const Body<3> box{box_surface(size)};
  Random random(3);
  int count[3] = {0, 0, 0};
  for (int n = 0; n < 20000; ++n) {
    const Vec<3> centre = random.point<3>(-0.4, 2.4);
    const Vec<3> outside = (-centre).cwiseMax(centre - size).cwiseMax(0.0);
    const int axes = static_cast<int>((outside.array() > 0.0).count());
    if (axes == 0)
      continue;
    const auto contacts = box.touch(centre, 0.4);
    ASSERT_EQ(contacts.size(), outside.norm() < 0.4 ? 1U : 0U);
    if (contacts.empty())
      continue;
    EXPECT_NEAR(contacts[0].gap, outside.norm() - 0.4, 1e-14);
    EXPECT_EQ(static_cast<int>(contacts[0].feature.kind), axes - 1); // facet, edge, corner
    ++count[axes - 1];
  }
  EXPECT_GT(count[0], 100);
  EXPECT_GT(count[1], 100);
  EXPECT_GT(count[2], 100);
}

template <int dim> bool is_inside(const Surface<dim>& convex, const Vec<dim>& x) {
  for (std::size_t f = 0; f < convex.facets.size(); ++f)
    if ((x - convex.shape(f)[0]).dot(scaled_normal<dim>(convex.shape(f))) > 0.0)
      return false;
  return true;
}

// One contact of a convex body moves with a Lipschitz constant of one in its gap and 1 / distance
// in its normal: (1 + overlap / distance) in the force per stiffness.
template <int dim> void force_is_continuous_around(const Surface<dim>& surface, double radius) {
  const Body<dim> body{surface};
  Random random(4);
  for (int n = 0; n < 20; ++n) {
    const Vec<dim> begin = random.point<dim>(-0.3, 1.3), end = random.point<dim>(-0.3, 1.3);
    std::optional<Vec<dim>> before;
    const int steps = 2000;
    for (int k = 0; k <= steps; ++k) {
      const Vec<dim> centre = begin + (end - begin) * (k / static_cast<double>(steps));
      const auto contacts = body.touch(centre, radius);
      const bool is_deep = !contacts.empty() && contacts[0].gap < -0.5 * radius;
      if (is_deep || is_inside(surface, centre)) {
        before.reset();
        continue;
      }
      ASSERT_LE(contacts.size(), 1U);
      const Vec<dim> now = push<dim>(contacts);
      if (before) {
        EXPECT_LE((now - *before).norm(), 2.0 * (end - begin).norm() / steps + 1e-15);
      }
      before = now;
    }
  }
}
TEST(FacetContact, pushes_continuously_on_any_way_around_a_polygon) {
  std::vector<Vec<2>> points;
  for (int i = 0; i < 7; ++i)
    points.emplace_back(0.5 + 0.4 * std::cos(2.0 * pi * i / 7.0),
                        0.5 + 0.4 * std::sin(2.0 * pi * i / 7.0));
  force_is_continuous_around<2>(cases::polygon(points), 0.1);
}
TEST(FacetContact, pushes_continuously_on_any_way_around_a_box) {
  force_is_continuous_around<3>(box_surface({1.0, 1.0, 1.0}), 0.1);
}

/// Some rotation of space, and of the plane.
template <int dim> Eigen::Matrix<double, dim, dim> some_rotation() {
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(0.7).toRotationMatrix();
  else
    return Eigen::AngleAxisd(0.7, Vec<3>(1.0, 2.0, -1.5).normalized()).toRotationMatrix();
}

// A flat sheet is as good as a plane, also for spheres right above its vertices and edges, whose
// places are rounded by a rotation, and for spheres larger than its facets. Tolerance: rounding.
TEST(FacetContact, with_a_flat_sheet_of_many_facets_is_that_with_a_plane) {
  const auto turn = some_rotation<3>();
  const std::uint32_t cells = 8;
  const Body<3> body{
      sheet(cells, [&](double u, double v) -> Vec<3> { return turn * Vec<3>(u, v, 0.0); })};
  for (const double radius : {0.01, 0.1, 0.4})
    for (int i = 8; i <= 24; ++i)
      for (int j = 8; j <= 24; ++j) {
        const Vec<3> centre = turn * Vec<3>(i / 32.0, j / 32.0, 0.9 * radius);
        const auto contacts = body.touch(centre, radius);
        ASSERT_EQ(contacts.size(), 1U) << i << " " << j;
        EXPECT_NEAR(contacts[0].gap, -0.1 * radius, 1e-15);
        EXPECT_LT((contacts[0].normal - turn * Vec<3>(0.0, 0.0, -1.0)).norm(), 1e-13);
      }
}

TEST(FacetContact, with_a_straight_line_of_segments_is_that_with_a_plane) {
  const auto turn = some_rotation<2>();
  Surface<2> line;
  for (std::uint32_t i = 0; i <= 10; ++i)
    line.vertices.push_back(turn * Vec<2>(-0.1 * i, 0.0));
  for (std::uint32_t i = 0; i < 10; ++i)
    line.facets.push_back({i, i + 1});
  const Body<2> body{line};
  for (const double radius : {0.01, 0.05, 0.3})
    for (int i = 20; i <= 60; ++i) {
      const auto contacts = body.touch(turn * Vec<2>(-i / 80.0, 0.9 * radius), radius);
      ASSERT_EQ(contacts.size(), 1U) << i;
      EXPECT_NEAR(contacts[0].gap, -0.1 * radius, 1e-15);
      EXPECT_LT((contacts[0].normal - turn * Vec<2>(0.0, -1.0)).norm(), 1e-13);
    }
}

TEST(FacetContact, with_a_flat_sheet_is_one_although_its_facets_share_no_vertices) {
  const auto joined = sheet(4, [](double u, double v) { return Vec<3>(u, v, 0.0); });
  Surface<3> loose;
  for (std::size_t f = 0; f < joined.facets.size(); ++f) {
    const auto first = static_cast<std::uint32_t>(loose.vertices.size());
    for (const Vec<3>& x : joined.shape(f))
      loose.vertices.push_back(x);
    loose.facets.push_back({first, first + 1, first + 2});
  }
  const Body<3> body{loose};
  for (int i = 8; i <= 24; ++i)
    for (int j = 8; j <= 24; ++j) {
      const auto contacts = body.touch({i / 32.0, j / 32.0, 0.09}, 0.1);
      ASSERT_EQ(contacts.size(), 1U) << i << " " << j;
      EXPECT_NEAR(contacts[0].gap, -0.01, 1e-15);
    }
}

TEST(FacetContact, with_a_thin_plate_is_that_with_its_front) {
  const Body<3> plate{box_surface({1.0, 1.0, 1e-3})};
  const auto contacts = plate.touch({0.4, 0.5, 0.091}, 0.1);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_NEAR(contacts[0].gap, -0.01, 1e-15);
  EXPECT_EQ(contacts[0].normal[2], -1.0);
}

// Inside a box whose walls are seen from their backs: one contact for each wall in reach.
TEST(FacetContact, in_concave_edges_and_corners_counts_once_for_each_wall) {
  const Body<3> room{box_surface({1.0, 1.0, 1.0})};
  const auto at = [&](double x, double y, double z) { return room.touch({x, y, z}, 0.1); };
  EXPECT_EQ(at(0.5, 0.5, 0.5).size(), 0U);
  EXPECT_EQ(at(0.5, 0.4, 0.09).size(), 1U);
  const auto edge = at(0.5, 0.08, 0.09);
  ASSERT_EQ(edge.size(), 2U);
  EXPECT_NEAR(edge[0].gap, -0.02, 1e-15);
  EXPECT_NEAR(edge[1].gap, -0.01, 1e-15);
  const auto corner = at(0.93, 0.08, 0.09);
  ASSERT_EQ(corner.size(), 3U);
  for (const auto& contact : corner)
    EXPECT_EQ(contact.feature.kind, FeatureKind::facet);

  const Body<2> square{cases::polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}})};
  EXPECT_EQ(square.touch({0.92, 0.09}, 0.1).size(), 2U);
  EXPECT_EQ(square.touch({1.05, -0.05}, 0.1).size(), 1U);
  EXPECT_EQ(square.touch({1.05, -0.05}, 0.1)[0].feature.kind, FeatureKind::corner);
}

/// Two long facets that rise from the corner at the origin, each by half the angle.
Body<2> valley(double angle) {
  const double x = std::cos(0.5 * angle), y = std::sin(0.5 * angle);
  return {{{{x, y}, {0.0, 0.0}, {-x, y}}, {{0, 1}, {1, 2}}}};
}

// On the axis of a valley both faces are as near. The second gets what the tangent plane of the
// first leaves of the disc: overlap r - d, but at most d / cos(angle) - d.
TEST(FacetContact, of_a_second_face_grows_from_nothing_with_the_angle_of_a_valley) {
  const double radius = 1e-2, overlap = 1e-4, d = radius - overlap;
  for (const double angle : {1e-6, 1e-3, 0.05, 0.1, 0.2, 1.0, 1.5}) {
    const auto contacts = valley(angle).touch({0.0, d / std::cos(0.5 * angle)}, radius);
    const double second = std::min(overlap, d / std::cos(angle) - d);
    ASSERT_EQ(contacts.size(), second > 1e-12 * radius ? 2U : 1U) << angle;
    EXPECT_NEAR(contacts[0].gap, -overlap, 1e-16);
    if (contacts.size() == 2) {
      EXPECT_NEAR(contacts[1].gap, -second, 1e-15);
    }
  }
}

// Along one face of a shallow valley: the vertical force grows from that of one face, continuously.
// What may jump on the axis, where the faces change their order, is k overlap angle sideways.
TEST(FacetContact, in_a_shallow_valley_jumps_by_less_than_overlap_times_angle) {
  const double radius = 1e-2, overlap = 1e-4;
  for (const double angle : {0.02, 0.1, 0.3}) {
    const Body<2> body = valley(angle);
    const double height = (radius - overlap) / std::cos(0.5 * angle);
    std::optional<Vec<2>> before;
    double largest = 0.0;
    const int steps = 40001; // the axis is between two of them
    for (int k = 0; k <= steps; ++k) {
      const double x = 4e-3 * (2.0 * k / steps - 1.0);
      const Vec<2> now =
          push<2>(body.touch({x, height + std::abs(x) * std::tan(0.5 * angle)}, radius));
      if (before)
        largest = std::max(largest, (now - *before).norm());
      before = now;
    }
    EXPECT_LT(largest, overlap * angle + 4.0 * 8e-3 / steps);
  }
}

// A tube of many facets round a sphere: edges between facets that lie further up are no contacts.
TEST(FacetContact, in_a_tube_of_fine_facets_is_with_the_lowest_ones_only) {
  std::vector<Vec<2>> points;
  const int count = 720;
  for (int i = 0; i < count; ++i)
    points.emplace_back(std::cos(2.0 * pi * i / count), std::sin(2.0 * pi * i / count));
  const Body<2> tube{cases::polygon(points)};
  for (int i = 0; i < 50; ++i) {
    const double angle = 0.01 + 0.0013 * i;
    const Vec<2> direction(std::cos(angle), std::sin(angle));
    const auto contacts = tube.touch(0.701 * direction, 0.3);
    EXPECT_LE(contacts.size(), 2U);
    // The sagitta of a facet, (pi / count)² / 2 = 1e-5, is a hundredth of the overlap.
    EXPECT_LT((push<2>(contacts) + 1e-3 * direction).norm(), 3e-5);
  }
}

TEST(FacetContact, of_a_centre_on_the_surface_pushes_outwards) {
  const Body<3> box{box_surface({1.0, 1.0, 1.0})};
  for (const Vec<3>& centre : {Vec<3>(0.3, 0.4, 1.0), Vec<3>(0.5, 0.5, 1.0)}) {
    const auto contacts = box.touch(centre, 0.1);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_EQ(contacts[0].gap, -0.1);
    EXPECT_EQ(contacts[0].normal, Vec<3>(0.0, 0.0, -1.0));
  }
}

std::vector<std::uint32_t> past(const Body<3>& body, const Contacts<3>& before,
                                const Contacts<3>& now) {
  std::vector<std::uint32_t> from(now.size());
  continue_contacts<3>(before, now, body.topology, from);
  return from;
}

// A ball rolls over a box: flat, over a flat edge, and round a convex edge. Its contact has a past
// in every step. When it comes to a wall, the contact with the wall has none.
TEST(FacetContact, continues_its_history_while_the_sphere_rolls_from_feature_to_feature) {
  const Body<3> box{box_surface({1.0, 1.0, 1.0})};
  const double radius = 0.1;
  Contacts<3> before;
  std::vector<Feature> features;
  for (int k = 0; k <= 1000; ++k) {
    const double s = 0.5 + 0.8 * k / 1000.0; // way of the contact from x = 0.5 on top of the box
    const double angle = std::clamp((s - 1.0) / 0.1, 0.0, 0.5 * pi);
    const double down = std::max(0.0, s - 1.0 - 0.05 * pi);
    const Vec<3> centre(std::min(s, 1.0) + 0.095 * std::sin(angle), 0.3,
                        1.0 + 0.095 * std::cos(angle) - down);
    const auto now = box.touch(centre, radius);
    ASSERT_EQ(now.size(), 1U);
    if (!before.empty()) {
      EXPECT_EQ(past(box, before, now), std::vector{0U});
    }
    if (features.empty() || features.back() != now[0].feature)
      features.push_back(now[0].feature);
    before = now;
  }
  EXPECT_GE(features.size(), 3U);

  const Body<3> room{box_surface({1.0, 1.0, 1.0})};
  const auto floor = room.touch({0.5, 0.101, 0.09}, radius);
  const auto corner = room.touch({0.5, 0.099, 0.09}, radius);
  ASSERT_EQ(corner.size(), 2U);
  EXPECT_EQ(past(room, floor, corner), (std::vector{0U, no_contact}));
}

// Two contacts of now lie beside one of before: the nearer goes on with its history.
TEST(FacetContact, hands_its_history_to_one_contact_only) {
  const Body<3> body{sheet(2, [](double u, double v) { return Vec<3>(u, v, 0.0); })};
  const auto on = [](std::uint32_t facet) {
    FacetContact<3> contact;
    contact.feature = {FeatureKind::facet, facet};
    contact.normal = {0.0, 0.0, -1.0};
    return contact;
  };
  EXPECT_EQ(past(body, {on(0)}, {on(1), on(2)}), (std::vector{0U, no_contact}));
  EXPECT_EQ(past(body, {on(0)}, {on(1), on(0)}), (std::vector{no_contact, 0U}));
  EXPECT_EQ(past(body, {on(0), on(3)}, {on(1), on(2)}), (std::vector{0U, 1U}));
}

template <int dim> void grid_finds_what_comparing_all_finds(const Surface<dim>& surface) {
  const FacetGrid<dim> grid(surface);
  Random random(9);
  std::vector<std::uint32_t> found;
  std::size_t total = 0;
  for (int n = 0; n < 5000; ++n) {
    const Vec<dim> centre = random.point<dim>(-0.5, 1.5);
    const double reach = random.uniform(0.0, 0.3);
    grid.near(centre, reach, found);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t f = 0; f < surface.facets.size(); ++f) {
      const FacetShape<dim> x = surface.shape(f);
      const auto box = bounding_box<dim>({{x.begin(), x.end()}, {}});
      if ((centre - centre.cwiseMax(box.lower).cwiseMin(box.upper)).norm() <= reach)
        expected.push_back(f);
    }
    EXPECT_EQ(found, expected);
    total += found.size();
  }
  EXPECT_GT(total, 500U);
}
TEST(FacetGrid, finds_what_comparing_all_boxes_finds_in_2D) {
  grid_finds_what_comparing_all_finds<2>(wavy_line());
}
TEST(FacetGrid, finds_what_comparing_all_boxes_finds_in_3D) {
  grid_finds_what_comparing_all_finds<3>(wavy_sheet());
}
TEST(FacetGrid, holds_a_single_facet_and_ignores_what_is_not_finite) {
  const FacetGrid<3> grid(Surface<3>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  std::vector<std::uint32_t> found;
  grid.near({0.2, 0.2, 0.05}, 0.1, found);
  EXPECT_EQ(found, std::vector<std::uint32_t>{0});
  grid.near({std::nan(""), 0.2, 0.05}, 0.1, found);
  EXPECT_TRUE(found.empty());
}

} // namespace
} // namespace kerf
