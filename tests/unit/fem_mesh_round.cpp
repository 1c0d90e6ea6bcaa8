// Discs, rings, cylinders and tunnels: what they fill, how they are tagged, what is refused.
#include "fem_core/mesh/disc.hpp"
#include "fem_core/mesh/quality.hpp"
#include "fem_core/mesh/simplices.hpp"
#include "fem_core/mesh/tunnel.hpp"
#include "tests/unit/fem_mesh_checks.hpp"

#include <numbers>

namespace kerf::fem {
namespace {

constexpr double pi = std::numbers::pi;
constexpr Shape plane_shapes[] = {Shape::quad4, Shape::tri3};
constexpr Shape solid_shapes[] = {Shape::hex8, Shape::tet4};

/// Area of the regular polygon of n corners on a circle.
double polygon(double radius, double n) {
  return 0.5 * n * radius * radius * std::sin(2.0 * pi / n);
}

template <int dim> void expect_sound(const Mesh<dim>& mesh, double volume) {
  expect_conforming(mesh);
  EXPECT_GT(check_mesh(mesh, "mesh").jacobian.value, 0.0);
  EXPECT_NEAR(volume_of(mesh), volume, 1e-12 * volume); // round-off of some hundred terms
  EXPECT_NEAR(enclosed_volume(mesh), volume, 1e-12 * volume);
}

TEST(DiscMesh, fills_the_polygon_on_its_circle_whatever_its_counts) {
  for (const std::uint32_t around : {4u, 8u, 12u, 20u, 48u})
    for (const std::uint32_t radial : {1u, 2u, 7u})
      for (const Shape shape : plane_shapes) {
        const Mesh<2> mesh = in_shape(
            make_disc({.center = {3.0, -1.0}, .radius = 2.0, .radial = radial, .around = around}),
            shape);
        expect_sound(mesh, polygon(2.0, around));
        for (const std::uint32_t node : nodes_with_tag(mesh, "side", ""))
          EXPECT_NEAR((mesh.position(node) - Vec<2>(3.0, -1.0)).norm(), 2.0, 1e-15 * 4.0);
      }
}

TEST(DiscMesh, has_elements_of_a_good_shape) {
  // At the corners of the inner square three quads meet: with 120 degrees for each their scaled
  // Jacobian would be sin 120 = 0.87. The layers are thinner there and their rays less upright.
  const Quality<2> quality = quality_of(make_disc({.radius = 1.0, .radial = 6, .around = 48}));
  EXPECT_GT(quality.scaled_jacobian.value, 0.7);
  EXPECT_LT(quality.aspect_ratio.value, 2.5);
}

TEST(DiscMesh, becomes_a_ring_with_an_inner_radius) {
  for (const std::uint32_t around : {3u, 10u, 31u})
    for (const double grading : {0.1, 1.0, 20.0})
      for (const Shape shape : plane_shapes) {
        const Mesh<2> mesh = in_shape(make_disc({.radius = 2.0,
                                                 .inner_radius = 0.5,
                                                 .radial = 5,
                                                 .around = around,
                                                 .grading = grading}),
                                      shape);
        expect_sound(mesh, polygon(2.0, around) - polygon(0.5, around));
        EXPECT_EQ(mesh.boundary.at("inner").size(), around);
        for (const std::uint32_t node : nodes_with_tag(mesh, "inner", ""))
          EXPECT_NEAR(mesh.position(node).norm(), 0.5, 1e-15);
      }
}

TEST(DiscMesh, has_an_area_that_converges_with_the_square_of_the_element_size) {
  // pi r² - n/2 r² sin(2 pi/n) = 2 pi³ r² / (3 n²) + O(n^-4): halving n changes it by 4 up to the
  // next term, (2 pi / n)² / 20 = 6e-4 of it at n = 64.
  const auto error = [](std::uint32_t around) {
    return pi - volume_of(make_disc({.radius = 1.0, .radial = around / 8, .around = around}));
  };
  EXPECT_NEAR(std::log2(error(32) / error(64)), 2.0, 5e-3);
  EXPECT_NEAR(error(64), 2.0 * pi * pi * pi / (3.0 * 64 * 64), 1e-3 * error(64));
}

TEST(CylinderMesh, fills_its_prism_and_tags_its_ends_and_its_sides) {
  for (const double inner_radius : {0.0, 0.7})
    for (const Shape shape : solid_shapes) {
      const DiscMesh disc{.radius = 2.0, .inner_radius = inner_radius, .radial = 2, .around = 12};
      const Mesh<3> mesh = in_shape(
          make_cylinder(disc, {.origin = -1.0, .length = 3.0, .count = 4, .grading = 2.0}), shape);
      const double area = polygon(2.0, 12) - polygon(inner_radius, 12);
      expect_sound(mesh, 3.0 * area);
      for (const auto& [tag, z] : {std::pair{"bottom", -1.0}, std::pair{"top", 2.0}}) {
        double end = 0.0;
        for (const Face& face : mesh.boundary.at(tag)) {
          const Vec<3> normal = area_vector<3>(face_corners(mesh, face, mesh.positions));
          end += normal[2];
          EXPECT_EQ(face_corners(mesh, face, mesh.positions).row(2).minCoeff(), z);
        }
        EXPECT_NEAR(end, z < 0.0 ? -area : area, 1e-13 * area);
      }
      EXPECT_EQ(mesh.boundary.count("inner"), inner_radius > 0.0 ? 1u : 0u);
    }
}

TEST(TunnelMesh, fills_its_rectangle_but_for_the_opening) {
  const std::optional<Vec<2>> centers[] = {std::nullopt, Vec<2>(-3.8, 1.5)};
  for (const auto& center : centers)
    for (const Vec<2>& size : {Vec<2>(10.0, 10.0), Vec<2>(40.0, 4.0), Vec<2>(3.0, 12.0)})
      for (const std::optional<double> grading : {std::optional<double>(), {1.0}, {30.0}})
        for (const std::uint32_t around : {4u, 16u, 36u})
          for (const Shape shape : plane_shapes) {
            const Mesh<2> mesh = in_shape(make_tunnel({.origin = {-5.0, 0.0},
                                                       .size = size,
                                                       .center = center,
                                                       .radius = 1.0,
                                                       .radial = 4,
                                                       .around = around,
                                                       .grading = grading}),
                                          shape);
            expect_sound(mesh, size.prod() - polygon(1.0, around));
          }
}

TEST(TunnelMesh, lets_elements_grow_like_their_distance_when_no_grading_is_given) {
  // On the ray at 0 degrees radii are then 1, q, q², q³ with q³ = 10: those of a ring.
  const Mesh<2> mesh = make_tunnel(
      {.origin = {-10.0, -10.0}, .size = {20.0, 20.0}, .radius = 1.0, .radial = 3, .around = 8});
  const auto radius = [&](std::size_t layer) { return mesh.position(8 * layer + 1).norm(); };
  for (const std::size_t layer : {1, 2, 3})
    EXPECT_NEAR(radius(layer), std::pow(10.0, static_cast<double>(layer) / 3.0), 1e-13);
}

TEST(TunnelMesh, has_an_opening_that_converges_with_the_square_of_the_element_size) {
  // As of a disc: the opening is a polygon.
  const auto error = [](std::uint32_t around) {
    const Mesh<2> mesh =
        make_tunnel({.size = {4.0, 4.0}, .radius = 1.0, .radial = 3, .around = around});
    return volume_of(mesh) - (16.0 - pi);
  };
  EXPECT_GT(error(64), 0.0);
  EXPECT_NEAR(std::log2(error(32) / error(64)), 2.0, 5e-3);
}

TEST(TunnelMesh, has_its_sides_where_they_belong_and_a_wall_that_looks_into_the_opening) {
  const TunnelMesh tunnel{.size = {6.0, 4.0}, .radius = 1.0, .radial = 3, .around = 16};
  const Mesh<2> mesh = make_tunnel(tunnel);
  for (const auto& [tag, axis, at] : {std::tuple{"left", 0, 0.0}, std::tuple{"right", 0, 6.0},
                                      std::tuple{"bottom", 1, 0.0}, std::tuple{"top", 1, 4.0}}) {
    EXPECT_EQ(mesh.boundary.at(tag).size(), 4u);
    for (const std::uint32_t node : nodes_with_tag(mesh, tag, ""))
      EXPECT_EQ(mesh.position(node)[axis], at) << tag;
  }
  EXPECT_NEAR(enclosed_volume(mesh, {"wall"}), -polygon(1.0, 16), 1e-13);
}

TEST(TunnelMesh, can_have_the_excavation_as_a_region_whose_removal_leaves_the_opening) {
  const TunnelMesh tunnel{
      .size = {6.0, 4.0}, .radius = 1.0, .radial = 3, .around = 16, .excavation = true};
  for (const Shape shape : plane_shapes) {
    const Mesh<2> mesh = in_shape(make_tunnel(tunnel), shape);
    expect_conforming(mesh, {"wall"});
    double rock = 0.0, excavation = 0.0;
    for (const std::uint32_t element : mesh.regions.at("rock"))
      rock += volume_of(mesh, element);
    for (const std::uint32_t element : mesh.regions.at("excavation"))
      excavation += volume_of(mesh, element);
    EXPECT_NEAR(excavation, polygon(1.0, 16), 1e-13);
    EXPECT_NEAR(rock, 24.0 - polygon(1.0, 16), 1e-13);
    EXPECT_NEAR(enclosed_volume(mesh, {"wall"}), -polygon(1.0, 16), 1e-13);
    for (const Face& face : mesh.boundary.at("wall"))
      EXPECT_TRUE(std::ranges::binary_search(mesh.regions.at("rock"), face.element));
  }
  for (const Shape shape : solid_shapes) {
    const Mesh<3> mesh = in_shape(make_tunnel(tunnel, {.length = 2.0, .count = 3}), shape);
    expect_conforming(mesh, {"wall"});
    EXPECT_GT(check_mesh(mesh, "mesh").jacobian.value, 0.0);
    EXPECT_NEAR(volume_of(mesh), 48.0, 1e-12);
    EXPECT_EQ(mesh.regions.at("rock").size() + mesh.regions.at("excavation").size(),
              mesh.num_elements());
  }
}

TEST(RoundMeshes, refuse_what_they_cannot_mesh_and_name_the_key) {
  const auto disc = [](const DiscMesh& mesh) { return refusal([&] { make_disc(mesh); }); };
  EXPECT_EQ(disc({.radius = 0.0, .radial = 1, .around = 4}),
            "mesh.radius: the radius is 0 m; it must be positive");
  EXPECT_EQ(disc({.radius = 1.0, .inner_radius = 1.5, .radial = 1, .around = 4}),
            "mesh.inner_radius: the inner radius is 1.5 m; it must be less than the radius, 1 m");
  EXPECT_EQ(disc({.radius = 1.0, .radial = 0, .around = 4}),
            "mesh.count: there must be at least one element along the radius");
  EXPECT_EQ(disc({.radius = 1.0, .radial = 1, .around = 6}),
            "mesh.count: there are 6 elements around; of a disc they must be a multiple of 4");
  EXPECT_EQ(disc({.radius = 1.0, .inner_radius = 0.5, .radial = 1, .around = 2}),
            "mesh.count: there are 2 elements around; of a ring there must be at least three");
  EXPECT_EQ(disc({.radius = 1.0, .inner_radius = 0.5, .radial = 1, .around = 1u << 31}),
            "mesh.count: the mesh has more corners than 32 bits can number");
  EXPECT_EQ(
      disc({.radius = 1.0, .inner_radius = 0.5, .radial = 2, .around = 8, .grading = 0.0}),
      "mesh.radial_grading: the grading along the radius is 0; it must be positive: the size of "
      "the last element over that of the first");
  EXPECT_EQ(
      refusal([] { make_cylinder({.radius = 1.0, .radial = 1, .around = 4}, {.length = -1.0}); }),
      "mesh.length: the size along z is -1 m; it must be positive");

  const auto tunnel = [](const TunnelMesh& mesh) { return refusal([&] { make_tunnel(mesh); }); };
  EXPECT_EQ(tunnel({.size = {2.0, 0.0}, .radius = 1.0, .radial = 1, .around = 4}),
            "mesh.size: the size along y is 0 m; it must be positive");
  EXPECT_EQ(tunnel({.size = {4.0, 2.0}, .radius = 1.0, .radial = 1, .around = 4}),
            "mesh.radius: the middle of the opening is 1 m from the nearest side; that must be "
            "more than its radius, 1 m");
  EXPECT_EQ(tunnel({.size = {4.0, 4.0},
                    .center = Vec<2>(0.5, 2.0),
                    .radius = 1.0,
                    .radial = 1,
                    .around = 4}),
            "mesh.center: the middle of the opening is 0.5 m from the nearest side; that must be "
            "more than its radius, 1 m");
  EXPECT_EQ(tunnel({.size = {5.6, 6.0},
                    .center = Vec<2>(4.5, 4.94),
                    .radius = 1.0,
                    .radial = 3,
                    .around = 8}),
            "mesh.center: elements fold, because the opening is close to one side and far from "
            "another; give it a place nearer to the middle, or a block that is wider there");
  EXPECT_EQ(tunnel({.size = {4.0, 4.0}, .radius = 1.0, .radial = 1, .around = 10}),
            "mesh.count: there are 10 elements around; they must be a multiple of 4");
}

} // namespace
} // namespace kerf::fem
