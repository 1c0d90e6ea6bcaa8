// Quality of elements against shapes whose measures are known; meshes that are refused.
#include "fem_core/mesh/quality.hpp"

#include "fem_core/mesh/box.hpp"
#include "fem_core/mesh/coincidence.hpp"
#include "tests/unit/fem_mesh_checks.hpp"

namespace kerf::fem {
namespace {

template <int dim> Mesh<dim> single(Shape shape, std::vector<double> positions) {
  Mesh<dim> mesh;
  mesh.positions = std::move(positions);
  mesh.blocks.push_back({.shape = shape, .nodes = {}});
  for (std::uint32_t a = 0; a < static_cast<std::uint32_t>(nodes_of(shape)); ++a)
    mesh.blocks[0].nodes.push_back(a);
  return mesh;
}

TEST(MeshQuality, is_one_of_regular_elements) {
  // detJ of a square, a cube of edge 2, and twice the area or six times the volume of simplices.
  const double h = std::sqrt(3.0) / 2.0, t = std::sqrt(2.0 / 3.0);
  const auto expect = [](const auto& mesh, double jacobian) {
    const auto quality = quality_of(mesh);
    EXPECT_NEAR(quality.scaled_jacobian.value, 1.0, 1e-15 * 4.0);
    EXPECT_NEAR(quality.aspect_ratio.value, 1.0, 1e-15 * 4.0);
    EXPECT_NEAR(quality.jacobian.value, jacobian, 1e-15 * 4.0);
  };
  expect(make_box(BoxMesh<2>{.size = {2.0, 2.0}, .count = {1, 1}}), 1.0);
  expect(make_box(BoxMesh<3>{.size = {2.0, 2.0, 2.0}, .count = {1, 1, 1}}), 1.0);
  expect(single<2>(Shape::tri3, {0, 0, 1, 0, 0.5, h}), h);
  expect(single<3>(Shape::tet4, {0, 0, 0, 1, 0, 0, 0.5, h, 0, 0.5, h / 3.0, t}), h * t);
}

TEST(MeshQuality, of_a_parallelogram_is_the_sine_of_its_angle_and_the_ratio_of_its_sides) {
  const double angle = 0.6;
  const Mesh<2> mesh = single<2>(Shape::quad4, {0, 0, 3, 0, 3 + std::cos(angle), std::sin(angle),
                                                std::cos(angle), std::sin(angle)});
  EXPECT_NEAR(quality_of(mesh).scaled_jacobian.value, std::sin(angle), 1e-15);
  EXPECT_NEAR(quality_of(mesh).aspect_ratio.value, 3.0, 1e-14);
}

TEST(MeshQuality, names_the_worst_element_and_its_region) {
  Mesh<2> mesh = make_box(BoxMesh<2>{.size = {4.0, 4.0}, .count = {4, 4}});
  mesh.positions[2 * 12] += 0.5; // node 12 is the one in the middle: the quad 6 to its lower right
  mesh.positions[2 * 12 + 1] -= 0.5;
  mesh.regions["left half"] = {0, 1, 4, 5, 8, 9, 12, 13};
  mesh.regions["right half"] = {2, 3, 6, 7, 10, 11, 14, 15};
  const Quality<2> quality = quality_of(mesh);
  EXPECT_EQ(quality.jacobian.element, 6u);
  EXPECT_EQ(quality.jacobian.region, "right half");
  // At the moved corner J is half the edges (1, -1/2) and (1/2, ... ): its sides run to (3, 2) and
  // (2, 1) from (2.5, 1.5): (0.5, 0.5) and (-0.5, -0.5), which lie on one line: detJ = 0.
  EXPECT_NEAR(quality.jacobian.value, 0.0, 1e-16);
  EXPECT_NEAR(quality.scaled_jacobian.value, 0.0, 1e-15);
  EXPECT_EQ(quality.extent.upper, Vec<2>(4.0, 4.0));
}

TEST(MeshQuality, sees_a_hex_that_is_folded_inside_although_its_volume_is_positive) {
  Mesh<3> mesh = make_box(BoxMesh<3>{.size = {1.0, 1.0, 1.0}, .count = {1, 1, 1}});
  const std::uint32_t corner = mesh.nodes_of_element(0)[6];
  for (int a = 0; a < 3; ++a)
    mesh.positions[3 * corner + static_cast<std::uint32_t>(a)] = 0.3;
  EXPECT_GT(volume_of(mesh), 0.0);
  EXPECT_LT(quality_of(mesh).jacobian.value, 0.0);
}

TEST(CheckMesh, names_an_element_that_is_turned_inside_out_with_region_and_nodes) {
  Mesh<2> mesh = make_box(BoxMesh<2>{.size = {2.0, 1.0}, .count = {2, 1}});
  std::swap(mesh.blocks[0].nodes[5], mesh.blocks[0].nodes[7]);
  mesh.regions["rock"] = {0, 1};
  EXPECT_EQ(refusal([&] { check_mesh(mesh, "mesh.file"); }),
            "mesh.file: element 1 (quad4, region \"rock\") has a Jacobian of -0.25 m², which must "
            "be positive: it is folded or its nodes are in a wrong order; its nodes are 1 at (1, "
            "0), 4 at (1, 1), 5 at (2, 1), 2 at (2, 0). Move them, or mesh this part finer");
  mesh.regions.clear();
  EXPECT_NE(refusal([&] { check_mesh(mesh, "mesh.file"); }).find("(quad4, in no region)"),
            std::string::npos);
}

TEST(CheckMesh, names_nodes_that_no_element_has_and_nodes_that_were_not_merged) {
  Mesh<2> mesh = make_box(BoxMesh<2>{.size = {2.0, 1.0}, .count = {2, 1}});
  EXPECT_EQ(refusal([&] { check_mesh(mesh, "mesh"); }), "nothing was refused");
  mesh.positions.insert(mesh.positions.end(), {1.0 + 1e-9, 0.0});
  EXPECT_EQ(refusal([&] { check_mesh(mesh, "mesh"); }),
            "mesh: node 6 at (1, 0) belongs to no element; take it out of the mesh");
  mesh.blocks[0].nodes[4] = 6; // the second element has now a corner of its own, near node 1
  EXPECT_EQ(
      refusal([&] { check_mesh(mesh, "mesh"); }),
      "mesh: nodes 1 and 6 are both at (1, 0): elements that meet there are not joined. Merge "
      "them, in Gmsh with Coherence Mesh, or part them");
  mesh.positions[12] = 1.0 + 1e-3; // a thin slit
  EXPECT_EQ(refusal([&] { check_mesh(mesh, "mesh"); }), "nothing was refused");
  mesh.positions[13] = std::nan("");
  EXPECT_EQ(refusal([&] { check_mesh(mesh, "mesh"); }),
            "mesh: node 6 is at (1.001, nan); give it a position");
  EXPECT_EQ(refusal([] { check_mesh(Mesh<3>(), "mesh"); }), "mesh: the mesh has no elements");
}

TEST(CoincidentNodes, are_found_wherever_they_lie_in_the_cells_that_nodes_are_sorted_into) {
  // Cells begin half a cell before the first node. With cells of 0.3 the nodes are in their
  // middles, with 0.6 every second one is on their faces, and its twin is in another cell.
  const Mesh<3> box = make_box(BoxMesh<3>{.size = {0.6, 0.6, 0.6}, .count = {2, 2, 2}});
  for (const double cell : {0.3, 0.6})
    for (std::uint32_t twin = 0; twin < 27; ++twin)
      for (const double shift : {-1e-8, 1e-8}) {
        Mesh<3> mesh = box;
        const Vec<3> x = mesh.position(twin).array() + shift;
        mesh.positions.insert(mesh.positions.end(), x.begin(), x.end());
        EXPECT_EQ(coincident_nodes(mesh, 1e-7, cell), std::pair(twin, 27u));
        EXPECT_EQ(coincident_nodes(mesh, 1e-8, cell), std::nullopt);
      }
}

TEST(CheckMesh, doubts_the_unit_of_a_mesh_that_waves_cannot_cross) {
  const auto quality = [](double size) {
    return quality_of(make_box(BoxMesh<2>{.size = {size, size}, .count = {10, 10}}));
  };
  // 50 mm of rock, 4000 m/s, 100 µs: 0.4 m. The same mesh in millimetres has edges of 5 m.
  EXPECT_EQ(doubt_of_unit(quality(50e-3), 0.4), std::nullopt);
  EXPECT_EQ(doubt_of_unit(quality(50.0), 0.4),
            "in the whole run a wave travels 0.4 m, less than the shortest edge of the mesh, 5 m; "
            "if it is not in metres, give mesh.scale, for example 1e-3 for millimetres");
  const double unknown = std::numeric_limits<double>::infinity();
  EXPECT_EQ(doubt_of_unit(quality(50.0), unknown), std::nullopt);
  EXPECT_NE(doubt_of_unit(quality(2e5), unknown), std::nullopt);
  EXPECT_NE(doubt_of_unit(quality(1e-7), unknown), std::nullopt);
}

} // namespace
} // namespace kerf::fem
