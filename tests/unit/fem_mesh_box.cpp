// The structured box: numbering, tags, grading, periodic axes, and its cuts into simplices.
#include "fem_core/mesh/box.hpp"

#include "fem_core/mesh/axis.hpp"
#include "tests/unit/fem_mesh_checks.hpp"

namespace kerf::fem {
namespace {

const BoxMesh<2> plate{.origin = {1.0, 2.0}, .size = {3.0, 2.0}, .count = {3, 2}};
const BoxMesh<3> block{.origin = {0.0, 0.0, 0.0}, .size = {3.0, 4.0, 5.0}, .count = {3, 4, 5}};

template <int dim> BoxMesh<dim> with(BoxMesh<dim> box, Shape shape) {
  box.shape = shape;
  return box;
}

std::vector<std::uint32_t> nodes(const auto& mesh, std::size_t element) {
  const auto span = mesh.nodes_of_element(element);
  return {span.begin(), span.end()};
}

TEST(BoxMesh, numbers_nodes_with_x_fastest_and_elements_in_the_order_of_vtk) {
  const Mesh<2> mesh = make_box(plate);
  EXPECT_EQ(mesh.num_nodes(), 12u);
  EXPECT_EQ(mesh.num_elements(), 6u);
  EXPECT_EQ(mesh.position(5), Vec<2>(2.0, 3.0));
  EXPECT_EQ(mesh.position(11), Vec<2>(4.0, 4.0));
  EXPECT_EQ(nodes(mesh, 0), (std::vector<std::uint32_t>{0, 1, 5, 4}));

  // VTK file formats: a hexahedron is numbered round its lower face, then round its upper one.
  const Mesh<3> solid = make_box(block); // 4 x 5 x 6 nodes
  EXPECT_EQ(nodes(solid, 0), (std::vector<std::uint32_t>{0, 1, 5, 4, 20, 21, 25, 24}));
}

TEST(BoxMesh, has_faces_on_every_side_that_together_enclose_its_volume) {
  // Only faces that all look outward give the volume; exact up to the rounding of a few sums.
  EXPECT_NEAR(enclosed_volume(make_box(plate)), 6.0, 1e-13);
  EXPECT_NEAR(enclosed_volume(make_box(block)), 60.0, 1e-12);
  EXPECT_EQ(make_box(block).boundary.at("left").size(), 20u);
  EXPECT_EQ(nodes_with_tag(make_box(plate), "right", "").size(), 3u);
  EXPECT_EQ(nodes_with_tag(make_box(plate), "right", ""), (std::vector<std::uint32_t>{3, 7, 11}));
  EXPECT_EQ(nodes_with_tag(make_box(plate), "all", "").size(), 12u);
}

TEST(BoxMesh, has_each_side_at_its_end_of_its_axis) {
  const Mesh<3> mesh = make_box(with(block, Shape::tet4));
  const Vec<3> upper = block.origin + block.size;
  const char* names[] = {"left", "right", "bottom", "top", "back", "front"};
  for (int side = 0; side < 6; ++side)
    for (const std::uint32_t node : nodes_with_tag(mesh, names[side], ""))
      EXPECT_EQ(mesh.position(node)[side / 2], (side % 2 ? upper : block.origin)[side / 2]);
}

TEST(BoxMesh, is_conforming_and_fills_its_volume_in_every_shape) {
  // Volumes are sums of a few hundred products; they are exact to round-off.
  for (const Shape shape : {Shape::quad4, Shape::tri3}) {
    BoxMesh<2> box = with(plate, shape);
    box.grading = {5.0, 0.2};
    const Mesh<2> mesh = make_box(box);
    expect_conforming(mesh);
    EXPECT_GT(smallest_volume(mesh), 0.0);
    EXPECT_NEAR(volume_of(mesh), 6.0, 1e-12);
    EXPECT_NEAR(enclosed_volume(mesh), 6.0, 1e-12);
    EXPECT_EQ(mesh.num_elements(), shape == Shape::tri3 ? 12u : 6u);
  }
  for (const Shape shape : {Shape::hex8, Shape::tet4}) {
    BoxMesh<3> box = with(block, shape);
    box.grading = {5.0, 0.2, 1.0};
    const Mesh<3> mesh = make_box(box);
    expect_conforming(mesh);
    EXPECT_GT(smallest_volume(mesh), 0.0);
    EXPECT_NEAR(volume_of(mesh), 60.0, 1e-11);
    EXPECT_NEAR(enclosed_volume(mesh), 60.0, 1e-11);
    EXPECT_EQ(mesh.num_elements(), shape == Shape::tet4 ? 360u : 60u);
  }
}

TEST(BoxMesh, cuts_a_brick_into_six_equal_tetrahedra_around_one_diagonal) {
  const Mesh<3> mesh =
      make_box(BoxMesh<3>{.size = {1.0, 2.0, 3.0}, .count = {1, 1, 1}, .shape = Shape::tet4});
  ASSERT_EQ(mesh.num_elements(), 6u);
  for (std::size_t e = 0; e < 6; ++e) {
    EXPECT_NEAR(volume_of(mesh, e), 1.0, 1e-15);
    EXPECT_EQ(std::ranges::count(nodes(mesh, e), 0u), 1); // x fastest: corners 0 and 7
    EXPECT_EQ(std::ranges::count(nodes(mesh, e), 7u), 1);
  }
}

TEST(BoxMesh, grows_its_elements_geometrically_to_the_given_ratio) {
  for (const double ratio : {1e-3, 0.5, 1.0 - 1e-12, 1.0, 1.0 + 1e-12, 7.0, 1e4}) {
    const std::vector<double> x =
        positions_along({.origin = -2.0, .length = 8.0, .count = 9, .grading = ratio}, "x");
    ASSERT_EQ(x.size(), 10u);
    EXPECT_EQ(x.front(), -2.0);
    EXPECT_EQ(x.back(), 6.0);
    // Differences of positions near 6 lose the digits that the smallest element lacks.
    const double smallest = std::min(x[1] - x[0], x[9] - x[8]);
    const double slack = 1e-14 * 8.0 / smallest;
    EXPECT_NEAR((x[9] - x[8]) / (x[1] - x[0]) / ratio, 1.0, slack);
    for (std::size_t k = 1; k < 9; ++k)
      EXPECT_NEAR((x[k + 1] - x[k]) / (x[k] - x[k - 1]) / std::pow(ratio, 1.0 / 8.0), 1.0, slack);
  }
}

TEST(BoxMesh, joins_the_ends_of_a_periodic_axis_and_gives_them_no_tag) {
  const Mesh<2> mesh =
      make_box(BoxMesh<2>{.size = {3.0, 2.0}, .count = {3, 2}}, Period<2>{.length = {3.0, 0.0}});
  EXPECT_EQ(mesh.num_nodes(), 9u);
  EXPECT_EQ(nodes(mesh, 2), (std::vector<std::uint32_t>{2, 0, 3, 5}));
  EXPECT_EQ(mesh.boundary.count("left"), 0u);
  EXPECT_EQ(mesh.boundary.count("right"), 0u);
  EXPECT_EQ(mesh.boundary.count("top"), 1u);
}

TEST(BoxMesh, is_conforming_across_the_ends_of_its_periods_in_every_shape) {
  for (const Shape shape : {Shape::quad4, Shape::tri3})
    for (const Vec<2>& period : {Vec<2>{3.0, 0.0}, Vec<2>{0.0, 2.0}, Vec<2>{3.0, 2.0}}) {
      const Mesh<2> mesh =
          make_box(BoxMesh<2>{.size = {3.0, 2.0}, .count = {3, 4}, .shape = shape}, {period});
      expect_conforming(mesh);
      EXPECT_NEAR(volume_of(mesh), 6.0, 1e-13);
      EXPECT_NEAR(smallest_volume(mesh), shape == Shape::tri3 ? 0.25 : 0.5, 1e-14);
    }
  for (const Shape shape : {Shape::hex8, Shape::tet4})
    for (const Vec<3>& period :
         {Vec<3>{3.0, 0.0, 0.0}, Vec<3>{0.0, 4.0, 5.0}, Vec<3>{3.0, 4.0, 5.0}}) {
      const Mesh<3> mesh = make_box(with(block, shape), {period});
      expect_conforming(mesh);
      EXPECT_NEAR(volume_of(mesh), 60.0, 1e-12);
      EXPECT_NEAR(smallest_volume(mesh), shape == Shape::tet4 ? 1.0 / 6.0 : 1.0, 1e-14);
    }
}

TEST(BoxMesh, refuses_what_it_cannot_mesh_and_names_the_key) {
  const Period<2> period{.length = {3.0, 0.0}};
  const auto refused = [](const BoxMesh<2>& box, const Period<2>& of = {}) {
    return refusal([&] { make_box(box, of); });
  };
  EXPECT_EQ(refused({.size = {3.0, 0.0}, .count = {3, 2}}),
            "mesh.size: the size along y is 0 m; it must be positive");
  EXPECT_EQ(refused({.size = {3.0, 1.0}, .count = {3, 0}}),
            "mesh.count: there must be at least one element along y");
  EXPECT_EQ(refused({.size = {3.0, 1.0}, .count = {1u << 20, 1u << 20}}),
            "mesh.count: the mesh has more corners than 32 bits can number");
  EXPECT_EQ(refused({.size = {2.5, 1.0}, .count = {3, 2}}, period),
            "mesh.size: the size along the periodic axis x is 2.5 m; it must be the period, 3 m");
  EXPECT_EQ(refused({.size = {3.0, 1.0}, .count = {2, 2}}, period),
            "mesh.count: there are 2 elements along the periodic axis x; there must be at least "
            "three");
  EXPECT_EQ(refused({.size = {3.0, 1.0}, .count = {3, 2}, .grading = {2.0, 1.0}}, period),
            "mesh.grading: the grading along the periodic axis x is 2; it must be 1");
  EXPECT_EQ(refused({.size = {3.0, 1.0}, .count = {3, 2}, .grading = {-2.0, 1.0}}),
            "mesh.grading: the grading along x is -2; it must be positive: the size of the last "
            "element over that of the first");
  EXPECT_EQ(refused({.size = {3.0, 1.0}, .count = {3, 1}, .grading = {1.0, 2.0}}),
            "mesh.grading: the grading along y is 2, but there is a single element; give 1, or "
            "more elements");
  EXPECT_EQ(refused({.size = {3.0, 1.0}, .count = {3, 2}, .shape = Shape::tet4}),
            "mesh.shape: \"tet4\" is not an element of 2D; give quad4 or tri3");
}

TEST(BoxMesh, lists_its_tags_when_it_is_asked_for_another) {
  EXPECT_EQ(refusal([] { nodes_with_tag(make_box(plate), "front", "boundary[0].tag"); }),
            "boundary[0].tag: the mesh has no tag \"front\"; its tags are all, bottom, left, "
            "right, top");
}

TEST(NodesWithTag, are_those_of_faces_regions_and_node_sets_of_that_name) {
  Mesh<2> mesh = make_box(plate); // 4 x 3 nodes
  mesh.regions["here"] = {0};
  mesh.node_sets["here"] = {11};
  mesh.boundary["here"] = {{2, 1}}; // right of the third element
  EXPECT_EQ(nodes_with_tag(mesh, "here", ""), (std::vector<std::uint32_t>{0, 1, 3, 4, 5, 7, 11}));
}

TEST(Face, has_the_area_and_the_outward_normal_of_its_surface) {
  EXPECT_EQ(area_vector<2>((FaceCorners<2>(2, 2) << 0, 3, 0, 4).finished()), Vec<2>(4.0, -3.0));
  EXPECT_EQ(area_vector<3>((FaceCorners<3>(3, 3) << 0, 2, 0, 0, 0, 3, 0, 0, 0).finished()),
            Vec<3>(0.0, 0.0, 3.0));
  // A warped one: by Stokes, half the sum of the cross products of its corners in turn.
  const FaceCorners<3> warped =
      (FaceCorners<3>(3, 4) << 0, 2, 2.5, 0, 0, 0.3, 1, 1.5, 0, 0.4, 0, 0.7).finished();
  Vec<3> sum = Vec<3>::Zero();
  for (int k = 0; k < 4; ++k)
    sum += 0.5 * Vec<3>(warped.col(k)).cross(Vec<3>(warped.col((k + 1) % 4)));
  EXPECT_LT((area_vector<3>(warped) - sum).norm(), 1e-15 * 10.0);
}

} // namespace
} // namespace kerf::fem
