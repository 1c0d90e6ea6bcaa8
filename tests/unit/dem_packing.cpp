// Random packings: density, walls, sizes, and the same bits for any number of threads.
#include "dem_core/packing/closed_surface.hpp"
#include "dem_core/packing/packing.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace kerf {
namespace {

using dem::Radii;
using dem::RadiusLaw;

Radii uniform(double least, double most) {
  return {.law = RadiusLaw::uniform, .least = least, .most = most, .values = {}, .weights = {}};
}

// The rock of Rojek (2008): 4979 discs of 0.262 to 0.653 mm at 13 % porosity in 50 x 50 mm.
const Radii rock_radii{.law = RadiusLaw::power,
                       .least = 0.262e-3,
                       .most = 0.653e-3,
                       .exponent = 3.56,
                       .values = {},
                       .weights = {}};
const dem::BoxRegion<2> rock_box({{0.0, 0.0}, {0.05, 0.05}});

dem::ClosedSurface<2> star() {
  std::vector<Vec<2>> corners;
  std::vector<Facet<2>> sides;
  for (std::uint32_t k = 0; k < 10; ++k) {
    const double angle = k * std::numbers::pi / 5.0, r = k % 2 == 0 ? 1.0 : 0.5;
    corners.push_back(r * Vec<2>(std::cos(angle), std::sin(angle)));
    sides.push_back({k, (k + 1) % 10});
  }
  return {corners, sides};
}

/// The cube from 0 to 1 with its upper octant missing: edges and corners of both kinds.
dem::ClosedSurface<3> notched_cube() {
  const auto square = [](Vec<3> corner, Vec<3> u, Vec<3> v, auto& vertices, auto& facets) {
    const auto index = [&](const Vec<3>& x) {
      const auto found = std::find(vertices.begin(), vertices.end(), x);
      if (found == vertices.end())
        vertices.push_back(x);
      return static_cast<std::uint32_t>(found - vertices.begin());
    };
    const auto a = index(corner), b = index(corner + u), c = index(corner + u + v),
               d = index(corner + v);
    facets.push_back({a, b, c});
    facets.push_back({a, c, d});
  };
  std::vector<Vec<3>> vertices;
  std::vector<Facet<3>> facets;
  vertices.reserve(64);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec<3> n = Vec<3>::Unit(axis), u = 0.5 * Vec<3>::Unit((axis + 1) % 3),
                 v = 0.5 * Vec<3>::Unit((axis + 2) % 3);
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q) {
        square(p * u + q * v, v, u, vertices, facets);
        const double height = p + q == 2 ? 0.5 : 1.0;
        square(height * n + p * u + q * v, u, v, vertices, facets);
      }
  }
  return {vertices, facets};
}

template <int dim>
void expect_all_inside(const dem::ParticleSet<dim>& p, const dem::Region<dim>& region) {
  for (std::size_t i = 0; i < p.radii.size(); ++i)
    ASSERT_GE(region.wall(p.positions[i]).depth, (1.0 - 1e-6) * p.radii[i]);
}

/// A loose packing of about a thousand particles fills any region to its porosity.
template <int dim> void expect_filled(const dem::Region<dim>& region) {
  const double porosity = dim == 2 ? 0.22 : 0.45;
  const auto p =
      dem::pack(region, {.radii = uniform(1.0, 1.5), .porosity = porosity, .count = 1000});
  const auto m = dem::measure(p, region.volume(), region.period());
  EXPECT_EQ(p.radii.size(), 1000u);
  EXPECT_NEAR(m.porosity, porosity, 1e-12);
  EXPECT_EQ(m.largest_overlap, 0.0);
  expect_all_inside(p, region);
}

TEST(Packing, fills_every_region_to_its_porosity_without_overlap) {
  expect_filled<2>(dem::BoxRegion<2>({{-1.0, 2.0}, {1.0, 3.0}}));
  expect_filled<2>(dem::BoxRegion<2>({{-1.0, 2.0}, {1.0, 3.0}}, {true, false}));
  expect_filled<2>(dem::Ball<2>({5.0, 0.0}, 2.0));
  expect_filled<2>(star());
  expect_filled<3>(dem::BoxRegion<3>({{0.0, 0.0, 0.0}, {1.0, 2.0, 1.0}}));
  expect_filled<3>(dem::BoxRegion<3>({{0.0, 0.0, 0.0}, {1.0, 2.0, 1.0}}, {true, true, true}));
  expect_filled<3>(dem::Ball<3>({0.0, 0.0, 7.0}, 0.1));
  expect_filled<3>(dem::Cylinder({0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}, 1.0));
  expect_filled<3>(notched_cube());
}

// The count follows from the law: area of the solid over the mean area of a disc. Measured by an
// independent program: mean overlap about 1 %, 4.44 touching neighbours.
TEST(Packing, of_the_rock_has_its_4979_discs_with_one_percent_of_overlap) {
  const auto p = dem::pack(rock_box, {.radii = rock_radii, .porosity = 0.13, .count = {}});
  const auto m = dem::measure(p, rock_box.volume(), {});
  EXPECT_NEAR(static_cast<double>(p.radii.size()), 4979.0, 2.0);
  EXPECT_NEAR(m.porosity, 0.13, 5e-4);
  EXPECT_NEAR(m.mean_overlap, 0.01, 0.003);
  EXPECT_LT(m.largest_overlap, 0.08);
  EXPECT_NEAR(m.coordination_number, 4.44, 0.1);
  expect_all_inside(p, rock_box);
}

// One radius from each of n equal shares: no value of the distribution function is off by more
// than 1/n.
TEST(Packing, has_radii_that_follow_their_law) {
  const auto p = dem::pack(rock_box, {.radii = rock_radii, .porosity = 0.2, .count = {}});
  std::vector<double> r = p.radii;
  std::sort(r.begin(), r.end());
  const double power = 1.0 - rock_radii.exponent, n = static_cast<double>(r.size());
  const auto share = [&](double radius) { // of smaller particles, the integral of r^-3.56
    return (std::pow(radius, power) - std::pow(rock_radii.least, power)) /
           (std::pow(rock_radii.most, power) - std::pow(rock_radii.least, power));
  };
  for (std::size_t k = 0; k < r.size(); ++k)
    ASSERT_NEAR(share(r[k]), (static_cast<double>(k) + 0.5) / n, 1.0 / n);
  EXPECT_GE(r.front(), rock_radii.least);
  EXPECT_LE(r.back(), rock_radii.most);
}

TEST(Packing, takes_listed_radii_by_their_weights) {
  dem::Random random(1);
  const auto r = dem::draw(
      {.law = RadiusLaw::list, .values = {1.0, 2.0, 5.0}, .weights = {1, 0, 3}}, 400, random);
  EXPECT_EQ(std::count(r.begin(), r.end(), 1.0), 100);
  EXPECT_EQ(std::count(r.begin(), r.end(), 5.0), 300);
}

TEST(Packing, has_the_same_bits_for_any_number_of_threads_and_others_for_another_seed) {
  const auto make = [](int threads, std::uint64_t seed) {
    omp_set_num_threads(threads);
    return dem::pack(rock_box,
                     {.radii = uniform(1.0, 2.0), .porosity = 0.15, .count = 3000, .seed = seed});
  };
  const int before = omp_get_max_threads();
  const auto one = make(1, 7), three = make(3, 7), other = make(3, 8);
  omp_set_num_threads(before);
  EXPECT_EQ(one.radii, three.radii);
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_NE(one.positions, other.positions);
}

TEST(Packing, of_equal_spheres_can_be_loose_and_free_of_overlap) {
  const dem::BoxRegion<3> box({{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}, {true, true, true});
  const auto p = dem::pack(box, {.radii = uniform(1.0, 1.0), .porosity = 0.40, .count = 2000});
  EXPECT_EQ(dem::measure(p, 1.0, box.period()).largest_overlap, 0.0);
}

TEST(Packing, is_cut_by_the_centres_of_its_particles) {
  const auto p = dem::pack(rock_box, {.radii = uniform(1.0, 1.0), .porosity = 0.2, .count = 500});
  const dem::Ball<2> disc({0.02, 0.03}, 0.015);
  const auto inside = dem::cut(p, disc);
  EXPECT_EQ(static_cast<std::size_t>(std::count_if(
                p.positions.begin(), p.positions.end(),
                [](const Vec<2>& x) { return (x - Vec<2>(0.02, 0.03)).norm() <= 0.015; })),
            inside.radii.size());
}

TEST(Packing, refuses_what_cannot_be_made) {
  const auto make = [](double porosity, std::optional<std::size_t> count, Radii radii) {
    dem::pack(rock_box, {.radii = radii, .porosity = porosity, .count = count});
  };
  EXPECT_THROW(make(0.0, 10, uniform(1.0, 2.0)), std::invalid_argument);
  EXPECT_THROW(make(0.2, 0, uniform(1.0, 2.0)), std::invalid_argument);
  EXPECT_THROW(make(0.2, {}, uniform(1.0, 2.0)), std::invalid_argument); // none fits
  EXPECT_THROW(make(0.2, 10, uniform(2.0, 1.0)), std::invalid_argument);
  const dem::BoxRegion<2> slit({{0.0, 0.0}, {1.0, 0.01}});
  EXPECT_THROW(dem::pack(slit, {.radii = uniform(1.0, 1.0), .porosity = 0.2, .count = 10}),
               std::invalid_argument);
}

// Volume by hand: 1 - 1/8.
// Seed 2 once left two spheres in the same corner, pressed into the same place.
TEST(Packing, leaves_nobody_in_the_place_of_another) {
  const dem::BoxRegion<3> box({Vec<3>::Zero(), Vec<3>::Constant(7.6)});
  dem::PackingSettings settings;
  settings.radii.law = dem::RadiusLaw::list;
  settings.radii.values = {0.5};
  settings.porosity = 0.4;
  for (settings.seed = 1; settings.seed <= 5; ++settings.seed) {
    const auto measures = dem::measure<3>(dem::pack<3>(box, settings), box.volume(), {});
    EXPECT_LT(measures.largest_overlap, 0.3) << "seed " << settings.seed;
  }
}

TEST(ClosedSurface, tells_inside_from_outside_at_edges_and_corners_of_both_kinds) {
  const auto cube = notched_cube();
  EXPECT_NEAR(cube.volume(), 0.875, 1e-14);
  for (int k = 0; k < 20 * 20 * 20; ++k) {
    const Vec<3> x(-0.075 + 0.06 * (k % 20), -0.075 + 0.06 * (k / 20 % 20),
                   -0.075 + 0.06 * (k / 400));
    const bool in_cube = (x.array() > 0.0).all() && (x.array() < 1.0).all();
    ASSERT_EQ(cube.contains(x), in_cube && !(x.array() > 0.5).all()) << x.transpose();
  }
  EXPECT_NEAR(cube.wall({0.6, 0.6, 0.6}).depth, -0.1, 1e-14);
  EXPECT_NEAR(cube.wall({0.4, 0.4, 0.4}).depth, std::sqrt(0.03), 1e-14);
}

TEST(ClosedSurface, that_is_open_or_turned_over_is_refused_with_the_facet) {
  const std::vector<Vec<2>> corners = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
  const auto refusal = [&](std::vector<Facet<2>> sides) -> std::string {
    try {
      dem::ClosedSurface<2> surface(corners, std::move(sides));
      return "";
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refusal({{0, 1}, {1, 2}, {2, 3}, {3, 0}}), "");
  EXPECT_NE(refusal({{0, 1}, {1, 2}, {2, 3}}).find("not closed"), std::string::npos);
  EXPECT_NE(refusal({{0, 1}, {1, 2}, {3, 2}, {3, 0}}).find("turned over"), std::string::npos);
  EXPECT_NE(refusal({{0, 1}, {1, 1}, {1, 2}, {2, 0}}).find("no extent"), std::string::npos);
}

} // namespace
} // namespace kerf
