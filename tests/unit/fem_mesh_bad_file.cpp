// Mesh files that cannot be used are refused with a fix.
#include "tests/unit/fem_mesh_file.hpp"

#include "fem_core/mesh/box.hpp"
#include "fem_core/program/read_mesh.hpp"

#include <nlohmann/json.hpp>

namespace kerf::fem {
namespace {

class BadMeshFile : public MeshFileTest {
protected:
  template <int dim = 2> std::string refused(const MeshFile& file) const {
    std::string text = refusal([&] { read_mesh_file<dim>(file); });
    for (std::size_t at; (at = text.find(path("").string())) != std::string::npos;)
      text.erase(at, path("").string().size());
    return text;
  }
};

TEST_F(BadMeshFile, is_named_with_what_gmsh_says_of_it) {
  EXPECT_EQ(refused({.path = written("bad.geo", "Point(1) = {0, 0, 0;\n")}).substr(0, 42),
            "mesh.file: Gmsh cannot use bad.geo: 'bad.g");
  const auto path = written("bad.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n");
  EXPECT_EQ(refused({.path = path}),
            "mesh.file: Gmsh cannot use bad.msh: Could not read nodes; Error loading 'bad.msh'");
  EXPECT_EQ(refused({.path = "none.msh"}), "mesh.file: there is no file none.msh");
  EXPECT_EQ(refused({.path = "mesh.inp"}),
            "mesh.file: mesh.inp must be a .msh, .geo, .step or .stp file");
  EXPECT_EQ(refused({.path = written("bad.step", "solid\n"), .element_size = 1.0}),
            "mesh.file: bad.step is not a STEP file: it does not begin with ISO-10303-21");
  // After a failure the library is as good as new.
  EXPECT_EQ(refused({.path = written("disc.geo", disc_geometry), .element_size = 5.0}),
            "nothing was refused");
}

TEST_F(BadMeshFile, has_the_wrong_dimension) {
  const auto solid =
      save(make_box(BoxMesh<3>{.size = {1, 1, 1}, .count = {1, 1, 1}}), "solid.msh", [] {});
  EXPECT_EQ(refused({.path = solid}), "mesh.file: solid.msh: it has elements of volume; give "
                                      "case.dimension = 3, or a mesh of surfaces");
  const auto plane =
      save(make_box(BoxMesh<2>{.size = {1, 1}, .count = {1, 1}}), "plane.msh", [] {});
  EXPECT_EQ(refused<3>({.path = plane}),
            "mesh.file: plane.msh: it has no elements of volume; mesh it in 3D, or give "
            "case.dimension = 2. When there are physical groups, Gmsh saves their elements only: "
            "is there one of volumes?");
  const auto bent = written("bent.geo", R"(SetFactory("OpenCASCADE"); Sphere(1) = {0, 0, 0, 1};)");
  EXPECT_EQ(refused({.path = bent, .element_size = 0.5}),
            "mesh.file: bent.geo: its z runs from -1 to 1 m; a mesh of the plane must have the "
            "same z everywhere");
}

TEST_F(BadMeshFile, has_elements_that_kerf_does_not_have) {
  const auto disc = written("disc.geo", disc_geometry + "Mesh.ElementOrder = 2;\n");
  EXPECT_EQ(refused({.path = disc, .element_size = 5.0}),
            "mesh.file: disc.geo: it has elements of type \"Triangle 6\"; kerf has tri3 and quad4. "
            "Give Mesh.ElementOrder = 1 in Gmsh");
  const auto prism = written("prism.geo", R"(SetFactory("OpenCASCADE"); Disk(1) = {0, 0, 0, 1};
Extrude {0, 0, 1} { Surface{1}; Layers{2}; Recombine; }
)");
  EXPECT_EQ(refused<3>({.path = prism, .element_size = 0.5}),
            "mesh.file: prism.geo: it has elements of type \"Prism 6\"; kerf has tet4 and hex8. "
            "Mesh the body with these only");
}

TEST_F(BadMeshFile, has_groups_that_do_not_belong_to_the_body) {
  Mesh<2> mesh = make_box(BoxMesh<2>{.size = {2, 1}, .count = {2, 1}});
  const auto diagonal = save(mesh, "diagonal.msh", [] {
    gmsh::model::addDiscreteEntity(1, 99);
    gmsh::model::mesh::addElementsByType(99, 1, {100}, {1, 5});
    gmsh::model::setPhysicalName(1, gmsh::model::addPhysicalGroup(1, {99}), "crack");
  });
  EXPECT_EQ(refused({.path = diagonal}),
            "mesh.file: diagonal.msh: element 100 of the group \"crack\" is no side of an element "
            "of the body; mesh both together, and join surfaces that touch with Coherence or "
            "BooleanFragments");
  const auto point = save(mesh, "point.msh", [] {
    gmsh::model::addDiscreteEntity(0, 99);
    gmsh::model::mesh::addNodes(0, 99, {50}, {7.0, 7.0, 0.25});
    gmsh::model::mesh::addElementsByType(99, 15, {100}, {50});
    gmsh::model::setPhysicalName(0, gmsh::model::addPhysicalGroup(0, {99}), "probe");
  });
  EXPECT_EQ(refused({.path = point}),
            "mesh.file: point.msh: node 50 of the group \"probe\" belongs to no element of the "
            "body; put the point into it, in Gmsh with Point{…} In Surface{…}");
  mesh.regions["all"] = {0, 1};
  EXPECT_EQ(refused({.path = save(mesh, "all.msh", [] {})}),
            "mesh.file: all.msh: a group has the name \"all\", which means every node; give it "
            "another name");
}

TEST_F(BadMeshFile, has_a_size_or_a_scale_that_makes_no_sense) {
  const auto disc = written("disc.geo", disc_geometry);
  EXPECT_EQ(refused({.path = disc, .scale = 0.0}),
            "mesh.scale: the scale is 0; it must be positive");
  EXPECT_EQ(refused({.path = disc, .element_size = -1.0}),
            "mesh.element_size: it is -1 m; it must be positive");
  EXPECT_EQ(refused({.path = "a.msh", .element_size = 1.0}),
            "mesh.element_size: a.msh is a mesh, whose elements have a size; leave it out");
  EXPECT_EQ(refused({.path = "a.step"}),
            "mesh.element_size: a.step is a geometry; give the largest size of its elements");
}

TEST_F(BadMeshFile, has_elements_that_cannot_be_computed_with) {
  const auto told = [](const std::filesystem::path& file) {
    const nlohmann::json participant = {{"mesh", {{"type", "file"}, {"file", file.string()}}}};
    return refusal([&] { read_mesh(Table(participant, ""), Period<2>{}); });
  };
  Mesh<2> mesh = make_box(BoxMesh<2>{.size = {2, 1}, .count = {2, 1}});
  const auto good = save(mesh, "good.msh", [] {});
  EXPECT_EQ(told(good), "nothing was refused");

  mesh.positions[2 * 5] = 0.8; // the upper right corner of the second element comes to the first
  EXPECT_TRUE(told(save(mesh, "folded.msh", [] {
              })).starts_with("mesh.file: element 1 (quad4, region \"body\") has a Jacobian of "));

  mesh.positions[2 * 5] = 2.0;
  mesh.positions.insert(mesh.positions.end(), {1.0, 0.0});
  mesh.blocks[0].nodes[4] = 6; // in place of node 1: the second element is not joined there
  mesh.boundary.clear();
  EXPECT_TRUE(told(save(mesh, "parted.msh", [] {
              })).starts_with("mesh.file: nodes 1 and 6 are both at (1, 0)"));
}

} // namespace
} // namespace kerf::fem
