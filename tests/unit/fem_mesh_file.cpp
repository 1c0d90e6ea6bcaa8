// Meshes from files: what Gmsh writes in all of its versions is what the generators made, groups
// are tags, geometries are meshed.
#include "tests/unit/fem_mesh_file.hpp"

#include "fem_core/mesh/box.hpp"
#include "fem_core/mesh/disc.hpp"
#include "fem_core/mesh/quality.hpp"
#include "fem_core/mesh/simplices.hpp"
#include "fem_core/mesh/tunnel.hpp"

#include <omp.h>

#include <numbers>

namespace kerf::fem {
namespace {

/// Faces in one order: a file does not keep theirs.
std::vector<std::pair<std::uint32_t, int>> sorted(const std::vector<Face>& faces) {
  std::vector<std::pair<std::uint32_t, int>> result;
  for (const Face& face : faces)
    result.emplace_back(face.element, face.side);
  std::sort(result.begin(), result.end());
  return result;
}

/// @param digits  relative error of numbers in the file
template <int dim> void expect_equal(const Mesh<dim>& read, const Mesh<dim>& made, double digits) {
  ASSERT_EQ(read.num_nodes(), made.num_nodes());
  for (std::size_t k = 0; k < made.positions.size(); ++k)
    EXPECT_NEAR(read.positions[k], made.positions[k], digits * std::abs(made.positions[k]));
  ASSERT_EQ(read.blocks.size(), made.blocks.size());
  for (std::size_t k = 0; k < made.blocks.size(); ++k) {
    EXPECT_EQ(read.blocks[k].shape, made.blocks[k].shape);
    EXPECT_EQ(read.blocks[k].nodes, made.blocks[k].nodes);
  }
  ASSERT_EQ(read.boundary.size(), made.boundary.size());
  for (const auto& [tag, faces] : made.boundary)
    EXPECT_EQ(sorted(read.boundary.at(tag)), sorted(faces)) << tag;
  for (const auto& [tag, elements] : made.regions)
    EXPECT_EQ(read.regions.at(tag), elements) << tag;
  EXPECT_EQ(read.node_sets, made.node_sets);
}

TEST_F(MeshFileTest, of_every_version_and_shape_is_what_the_generator_made) {
  const auto check = [&]<int dim>(const Mesh<dim>& made, const std::string& name) {
    for (const double version : {2.2, 4.1})
      for (const bool is_binary : {false, true}) {
        const std::string file = fmt::format("{}_{}_{}.msh", name, version, is_binary);
        const auto path = save(made, file, [&] {
          gmsh::option::setNumber("Mesh.MshFileVersion", version);
          gmsh::option::setNumber("Mesh.Binary", is_binary);
        });
        SCOPED_TRACE(file);
        // Gmsh writes 16 digits, or all bits.
        expect_equal(read_mesh_file<dim>({.path = path}), made, is_binary ? 0.0 : 5e-16);
      }
  };
  const TunnelMesh tunnel{
      .size = {3.0, 2.0}, .radius = 0.5, .radial = 2, .around = 8, .excavation = true};
  for (const Shape shape : {Shape::quad4, Shape::tri3}) {
    Mesh<2> mesh = in_shape(make_tunnel(tunnel), shape);
    mesh.boundary.erase("wall"); // its faces are between elements: below
    mesh.node_sets["probe"] = {3, 7};
    check.operator()<2>(mesh, std::string(name_of(shape)));
  }
  for (const Shape shape : {Shape::hex8, Shape::tet4}) {
    Mesh<3> mesh = make_box(BoxMesh<3>{
        .size = {3.0, 0.7, 1.0}, .count = {3, 2, 2}, .grading = {3.0, 1.0, 0.5}, .shape = shape});
    mesh.node_sets["corner"] = {0};
    check.operator()<3>(mesh, std::string(name_of(shape)));
  }
}

TEST_F(MeshFileTest, can_mix_shapes_which_are_grouped) {
  const Mesh<2> read = read_mesh_file<2>({.path = written("mixed.msh", R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
2 4 "rock"
$EndPhysicalNames
$Nodes
6
10 0 0 0
20 1 0 0
30 2 0.5 0
40 1 1 0
50 0 1 0
60 9 9 0
$EndNodes
$Elements
4
7 3 2 4 1 10 20 40 50
5 2 2 4 1 20 40 30
9 1 2 3 1 30 40
8 1 2 3 1 50 10
$EndElements
)")});
  ASSERT_EQ(read.blocks.size(), 2u);
  EXPECT_EQ(read.blocks[0].nodes, (std::vector<std::uint32_t>{1, 2, 3})); // was clockwise
  EXPECT_EQ(read.blocks[1].nodes, (std::vector<std::uint32_t>{0, 1, 3, 4}));
  EXPECT_EQ(read.num_nodes(), 5u); // node 60 has no element
  EXPECT_EQ(sorted(read.boundary.at("3")),
            (std::vector<std::pair<std::uint32_t, int>>{{0, 1}, {1, 0}}));
  EXPECT_EQ(read.regions.at("rock"), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_NEAR(volume_of(read), 1.5, 1e-15);
}

TEST_F(MeshFileTest, has_its_elements_turned_when_they_are_inside_out) {
  const auto mirrored = [&]<int dim>(Mesh<dim> mesh) {
    for (std::size_t k = 0; k < mesh.positions.size(); k += dim)
      mesh.positions[k] *= -1.0;
    const double volume = -volume_of(mesh);
    EXPECT_GT(volume, 0.0);
    const Mesh<dim> read = read_mesh_file<dim>({.path = save(mesh, "mirrored.msh", [] {})});
    EXPECT_NEAR(volume_of(read), volume, 1e-14);
    EXPECT_NEAR(enclosed_volume(read), volume, 1e-14);
    EXPECT_GT(check_mesh(read, "mesh").jacobian.value, 0.0);
    expect_conforming(read);
  };
  for (const Shape shape : {Shape::quad4, Shape::tri3})
    mirrored.operator()<2>(
        make_box(BoxMesh<2>{.size = {1.0, 1.0}, .count = {2, 3}, .shape = shape}));
  for (const Shape shape : {Shape::hex8, Shape::tet4})
    mirrored.operator()<3>(
        make_box(BoxMesh<3>{.size = {1.0, 1.0, 1.0}, .count = {2, 2, 1}, .shape = shape}));
}

TEST_F(MeshFileTest, has_every_element_once_although_it_is_in_two_groups) {
  const Mesh<3> made = make_box(BoxMesh<3>{.size = {1.0, 1.0, 1.0}, .count = {2, 2, 2}});
  for (const double version : {2.2, 4.1}) { // 2.2 writes such an element twice
    const auto path = save(made, "groups.msh", [&] {
      gmsh::model::setPhysicalName(3, gmsh::model::addPhysicalGroup(3, {1}), "other");
      gmsh::option::setNumber("Mesh.MshFileVersion", version);
    });
    const Mesh<3> read = read_mesh_file<3>({.path = path});
    EXPECT_EQ(read.num_elements(), 8u);
    EXPECT_EQ(read.regions.at("body").size(), 8u);
    EXPECT_EQ(read.regions.at("other"), read.regions.at("body"));
  }
}

TEST_F(MeshFileTest, has_every_face_once_although_two_groups_of_one_name_have_it) {
  const Mesh<2> made = make_box(BoxMesh<2>{.size = {1.0, 1.0}, .count = {2, 2}});
  const auto path = save(made, "groups.msh", [] { // entities 2 and 3 are the bottom and the left
    gmsh::model::addPhysicalGroup(1, {2, 3}, 99); // has its number for a name
    gmsh::model::setPhysicalName(1, gmsh::model::addPhysicalGroup(1, {2}, 98), "99");
  });
  EXPECT_EQ(sorted(read_mesh_file<2>({.path = path}).boundary.at("99")),
            (std::vector<std::pair<std::uint32_t, int>>{{0, 0}, {0, 2}, {1, 2}, {2, 0}}));
}

TEST_F(MeshFileTest, takes_a_face_between_two_elements_as_a_side_of_the_first) {
  const Mesh<2> made = make_tunnel(
      {.size = {2.0, 2.0}, .radius = 0.5, .radial = 1, .around = 8, .excavation = true});
  const Mesh<2> read = read_mesh_file<2>({.path = save(made, "tunnel.msh", [] {})});
  EXPECT_EQ(read.boundary.at("wall").size(), 8u);
  for (const Face& face : read.boundary.at("wall"))
    EXPECT_TRUE(std::ranges::binary_search(read.regions.at("excavation"), face.element));
  EXPECT_EQ(nodes_with_tag(read, "wall", ""), nodes_with_tag(made, "wall", ""));
}

TEST_F(MeshFileTest, of_a_geometry_is_meshed_by_gmsh_and_scaled) {
  // A polygon of n >= 2 pi r / h sides lacks at most 2 pi³ r² / (3 n²) of the circle, and the
  // longest edge of a mesh of triangles is at most some half longer than the size that was wanted.
  const Mesh<2> mesh = read_mesh_file<2>(
      {.path = written("disc.geo", disc_geometry), .scale = 1e-3, .element_size = 2e-3});
  expect_conforming(mesh);
  const double area = std::numbers::pi * 20e-3 * 20e-3, lack = area - volume_of(mesh);
  EXPECT_GT(lack, 0.0);
  EXPECT_LT(lack, area * 2.0 * std::pow(2e-3 / 20e-3, 2) / 12.0);
  EXPECT_LT(check_mesh(mesh, "mesh").longest_edge, 1.5 * 2e-3);
  EXPECT_EQ(mesh.regions.at("plate").size(), mesh.num_elements());
  for (const std::uint32_t node : nodes_with_tag(mesh, "rim", ""))
    EXPECT_NEAR(mesh.position(node).norm(), 20e-3, 1e-12);
}

TEST_F(MeshFileTest, of_a_step_file_is_in_metres) {
  // Gmsh writes STEP files in millimetres, and says so in them.
  const auto make = [&] {
    gmsh::model::add("box");
    gmsh::model::occ::addBox(0, 0, 0, 10, 20, 30);
    gmsh::model::occ::synchronize();
    gmsh::write(path("box.step").string());
  };
  testing::internal::CaptureStdout(); // OpenCASCADE prints when it writes
  with_gmsh(make);
  testing::internal::GetCapturedStdout();
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const Mesh<3> mesh = read_mesh_file<3>({.path = path("box.step"), .element_size = 5e-3});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NEAR(volume_of(mesh), 6e-6, 1e-12 * 6e-6);
  EXPECT_GT(check_mesh(mesh, "mesh").jacobian.value, 0.0);
}

TEST_F(MeshFileTest, is_the_same_mesh_every_time) {
  const auto path = written("disc.geo", disc_geometry);
  const Mesh<2> first = read_mesh_file<2>({.path = path, .element_size = 3.0});
  const Mesh<2> second = read_mesh_file<2>({.path = path, .element_size = 3.0});
  EXPECT_EQ(first.positions, second.positions);
  EXPECT_EQ(first.blocks[0].nodes, second.blocks[0].nodes);
}

TEST_F(MeshFileTest, leaves_the_number_of_threads_as_it_was) {
  omp_set_num_threads(3);
  read_mesh_file<2>({.path = written("disc.geo", disc_geometry), .element_size = 10.0});
  EXPECT_EQ(omp_get_max_threads(), 3);
  omp_set_num_threads(1);
}

} // namespace
} // namespace kerf::fem
