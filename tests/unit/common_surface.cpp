// Surfaces, how their facets hang together, and the files that they come from.
#include "common/surface_file.hpp"
#include "common/surface_topology.hpp"
#include "tests/cases/surfaces.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace kerf {
namespace {

namespace fs = std::filesystem;
using cases::box_surface;

/// A folder that is gone with the test.
class SurfaceFile : public testing::Test {
protected:
  SurfaceFile() { fs::create_directories(folder_); }
  ~SurfaceFile() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  fs::path path(const std::string& name) const { return folder_ / name; }

private:
  fs::path folder_ = fs::temp_directory_path() /
                     ("kerf_surface_" +
                      std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

/// What is said about a file that cannot be used, from behind its folder on.
template <class Read> std::string complaint(const fs::path& path, Read read) {
  try {
    read();
  } catch (const FileError& error) {
    const std::string text = error.what();
    const auto name = text.find(path.filename().string());
    return name == std::string::npos ? text : text.substr(name);
  }
  return "";
}

template <int dim> void expect_same(const Surface<dim>& a, const Surface<dim>& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.facets, b.facets);
}

// Reference: 2 (ab + bc + ca), abc; Euler: corners - edges + facets = 2.
TEST(Surface, of_a_box_has_its_area_volume_edges_and_corners) {
  const auto box = box_surface({1.0, 2.0, 0.5});
  EXPECT_DOUBLE_EQ(area(box), 7.0);
  EXPECT_DOUBLE_EQ(enclosed_volume(box), 1.0);
  EXPECT_EQ(bounding_box(box).upper, Vec<3>(1.0, 2.0, 0.5));
  const SurfaceTopology<3> topology(box);
  EXPECT_EQ(topology.edges.size(), 18U);
  EXPECT_TRUE(topology.is_closed());
  for (std::size_t e = 0; e < topology.edges.size(); ++e)
    EXPECT_EQ(topology.facets_of_edge[e].size(), 2U);
  for (std::size_t f = 0; f < box.facets.size(); ++f) {
    const Vec<3> from_middle = box.shape(f)[0] - Vec<3>(0.5, 1.0, 0.25);
    EXPECT_GT(scaled_normal<3>(box.shape(f)).dot(from_middle), 0.0);
  }
}

TEST(Surface, of_a_polygon_has_its_length_and_area_and_normals_to_the_right) {
  const auto triangle = cases::polygon({{0.0, 0.0}, {4.0, 0.0}, {0.0, 3.0}});
  EXPECT_DOUBLE_EQ(area(triangle), 12.0);
  EXPECT_DOUBLE_EQ(enclosed_volume(triangle), 6.0);
  EXPECT_EQ(scaled_normal<2>(triangle.shape(0)), Vec<2>(0.0, -4.0));
  EXPECT_TRUE(SurfaceTopology<2>(triangle).is_closed());
}

TEST(Surface, is_open_when_a_facet_is_missing_or_turned_round) {
  auto box = box_surface({1.0, 1.0, 1.0});
  std::swap(box.facets[3][0], box.facets[3][1]);
  EXPECT_FALSE(SurfaceTopology<3>(box).is_closed());
  box.facets.erase(box.facets.begin() + 3);
  EXPECT_FALSE(SurfaceTopology<3>(box).is_closed());

  auto square = cases::polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  std::swap(square.facets[1][0], square.facets[1][1]);
  EXPECT_FALSE(SurfaceTopology<2>(square).is_closed());
  square.facets.pop_back();
  EXPECT_FALSE(SurfaceTopology<2>(square).is_closed());
}

TEST(Surface, turned_inside_out_encloses_a_negative_volume) {
  auto box = box_surface({1.0, 2.0, 3.0});
  for (auto& facet : box.facets)
    std::swap(facet[1], facet[2]);
  EXPECT_TRUE(SurfaceTopology<3>(box).is_closed());
  EXPECT_DOUBLE_EQ(enclosed_volume(box), -6.0);
}

TEST(Surface, names_its_first_fault) {
  const auto sentence = [](const auto& surface) {
    const auto fault = find_fault(surface);
    return fault ? fault->sentence : "";
  };
  auto box = box_surface({1.0, 1.0, 1.0});
  EXPECT_EQ(sentence(box), "");
  EXPECT_EQ(sentence(Surface<3>{}), "the surface has no facets");
  box.facets[5][1] = 8;
  EXPECT_EQ(sentence(box), "facet 5 needs vertex 8, but there are 8");
  box.facets[5] = {0, 1, 1};
  EXPECT_EQ(sentence(box), "facet 5 with a corner at (0, 0, 0) m has no area");
  box.vertices[7][2] = std::nan("");
  EXPECT_EQ(sentence(box), "vertex 7 at (1, 1, nan) m is not finite");
  EXPECT_EQ(sentence(Surface<3>{{{0, 0, 0}, {1, 0, 0}, {2, 1e-10, 0}}, {{0, 1, 2}}}),
            "facet 0 with a corner at (0, 0, 0) m has no area");
  EXPECT_EQ(sentence(Surface<2>{{{0, 0}, {1, 2}, {1, 2}}, {{0, 1}, {1, 2}}}),
            "facet 1 with a corner at (1, 2) m has no length");
}

TEST(Surface, makes_one_of_equal_vertices_and_drops_those_without_a_facet) {
  const Surface<2> loose{{{9, 9}, {0.0, 0}, {1, 0}, {1, 0}, {1, 1}, {1, 1}, {-0.0, 0}},
                         {{1, 2}, {3, 4}, {5, 6}}};
  const auto merged = merge_vertices(loose);
  EXPECT_EQ(merged.vertices, (std::vector<Vec<2>>{{0, 0}, {1, 0}, {1, 1}}));
  EXPECT_EQ(merged.facets, (std::vector<Facet<2>>{{0, 1}, {1, 2}, {2, 0}}));
}

// The coordinates are multiples of 1/8, which STL's numbers hold exactly.
TEST_F(SurfaceFile, stl_in_binary_gives_back_what_was_written) {
  const auto box = merge_vertices(box_surface({1.0, 2.125, 0.5}));
  write_stl(path("box.stl"), box);
  EXPECT_EQ(fs::file_size(path("box.stl")), 84U + 12U * 50U);
  expect_same(read_surface<3>(path("box.stl")), box);
}

TEST_F(SurfaceFile, stl_in_ascii_gives_the_same_as_in_binary) {
  const auto box = merge_vertices(box_surface({1.0, 2.125, 0.5}));
  std::ostringstream text;
  text << "solid a box\n";
  for (std::size_t f = 0; f < box.facets.size(); ++f) {
    text << "  facet normal 0 0 0\n    outer loop\n";
    for (const Vec<3>& x : box.shape(f))
      text << "      vertex " << x[0] << " " << x[1] << " " << x[2] << "\r\n";
    text << "    endloop\n  endfacet\n";
  }
  text << "endsolid a box\n";
  expect_same(read_surface<3>(write("box.stl", text.str())), box);
}

TEST_F(SurfaceFile, stl_in_binary_may_begin_as_if_it_were_ascii) {
  write_stl(path("box.stl"), box_surface({1.0, 1.0, 1.0}));
  std::fstream(path("box.stl"), std::ios::in | std::ios::out | std::ios::binary) << "solid box";
  EXPECT_EQ(read_stl(path("box.stl")).facets.size(), 12U);
}

TEST_F(SurfaceFile, stl_that_is_broken_says_where) {
  const std::string begin = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
  const auto says = [&](const std::string& text) {
    const auto file = write("s.stl", text);
    return complaint(file, [&] { read_stl(file); });
  };
  EXPECT_EQ(says(begin + "vertex 0 1 zero\n"), "s.stl:6: \"zero\" is not a finite number");
  EXPECT_EQ(says(begin + "vertex 0 1\n"), "s.stl:6: the line ends after 3 values, but needs 4");
  EXPECT_EQ(says(begin + "vertex 0 1 0\n"), "s.stl:6: the file ends where \"endloop\" is expected");
  EXPECT_EQ(says(begin + "endloop\n"),
            "s.stl:6: \"endloop\" is found where \"vertex\" is expected");
  EXPECT_EQ(says(begin + "vertex 2 0 0\nendloop\nendfacet\nendsolid\n"),
            "s.stl:2: facet 0 with a corner at (0, 0, 0) m has no area");
  EXPECT_EQ(says("solid nothing\nendsolid\n"), "s.stl: the surface has no facets");
  EXPECT_EQ(says("ply\n"),
            "s.stl is no STL file: it does not begin with \"solid\", and with 4 bytes "
            "it is too short for a binary one");
  write_stl(path("s.stl"), box_surface({1.0, 1.0, 1.0}));
  fs::resize_file(path("s.stl"), 600);
  EXPECT_EQ(complaint(path("s.stl"), [&] { read_stl(path("s.stl")); }),
            "s.stl is no STL file: it does not begin with \"solid\", and as a binary file of 12 "
            "facets it must have 684 bytes, but has 600");
  EXPECT_NE(complaint("none.stl", [&] { read_stl(path("none.stl")); }).find("cannot be opened"),
            std::string::npos);
}

// Two triangles of the group "cutting edge", one quadrangle of "back"; node 9 has no facet. Layout:
// Gmsh reference manual, MSH file format, versions 2.2 and 4.1.
const std::string names = "$PhysicalNames\n3\n1 1 \"rim\"\n2 7 \"cutting edge\"\n2 8 \"back\"\n"
                          "$EndPhysicalNames\n";
const std::string mesh_2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names +
    "$Nodes\n7\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n9 5 5 5\n5 0 0 1\n6 1 0 1\n$EndNodes\n"
    "$Elements\n5\n1 15 2 0 1 1\n2 1 2 1 1 1 2\n3 2 2 7 1 1 2 3\n4 2 2 7 1 1 3 4\n"
    "5 3 2 8 2 1 2 6 5\n$EndElements\n";
const std::string mesh_4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + names +
    "$Entities\n1 1 2 0\n1 0 0 0 0\n1 0 0 0 1 0 0 1 1 2 1 -1\n1 0 0 0 1 1 0 1 -7 1 1\n"
    "2 0 0 0 1 0 1 2 3 8 0\n$EndEntities\n"
    "$Nodes\n2 7 1 9\n2 1 0 5\n1\n2\n3\n4\n9\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n5 5 5\n"
    "2 2 0 2\n5\n6\n0 0 1\n1 0 1\n$EndNodes\n"
    "$Elements\n4 5 1 5\n0 1 15 1\n1 1\n1 1 1 1\n2 1 2\n2 1 2 2\n3 1 2 3\n4 1 3 4\n"
    "2 2 3 1\n5 1 2 6 5\n$EndElements\n$NodeData\n1\n\"x\"\n$EndNodeData\n";

TEST_F(SurfaceFile, gmsh_mesh_in_2_2_and_4_1_has_the_facets_of_a_group_or_all) {
  for (const std::string& mesh : {mesh_2, mesh_4}) {
    const auto file = write("tool.msh", mesh);
    const auto edge = read_surface<3>(file, "cutting edge");
    EXPECT_EQ(edge.vertices, (std::vector<Vec<3>>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(edge.facets, (std::vector<Facet<3>>{{0, 1, 2}, {0, 2, 3}}));
    const auto all = read_surface<3>(file);
    EXPECT_EQ(all.facets, (std::vector<Facet<3>>{{0, 1, 2}, {0, 2, 3}, {0, 1, 4}, {0, 4, 5}}));
    EXPECT_DOUBLE_EQ(area(read_surface<3>(file, "back")), 1.0);
  }
}

TEST_F(SurfaceFile, gmsh_mesh_in_2D_has_segments) {
  std::string mesh = mesh_2;
  mesh.replace(mesh.find("9 5 5 5\n5 0 0 1\n6 1 0 1"), 23, "9 5 5 0\n5 0 0 0\n6 1 0 0");
  const auto rim = read_surface<2>(write("rim.msh", mesh), "rim");
  EXPECT_EQ(rim.vertices, (std::vector<Vec<2>>{{0, 0}, {1, 0}}));
  EXPECT_EQ(rim.facets, (std::vector<Facet<2>>{{0, 1}}));
}

TEST_F(SurfaceFile, gmsh_mesh_that_cannot_be_used_says_why) {
  const auto says = [&](std::string mesh, const std::string& old, const std::string& replacement,
                        const std::string& group = "") {
    mesh.replace(mesh.find(old), old.size(), replacement);
    const auto file = write("m.msh", mesh);
    return complaint(file, [&] { read_surface<3>(file, group); });
  };
  EXPECT_EQ(says(mesh_2, "2.2 0", "3 0"),
            "m.msh:2: the format is 3, but must be 2.2 or 4.1: save it with gmsh -format msh41");
  EXPECT_EQ(says(mesh_4, "4.1 0", "4.1 1"),
            "m.msh:2: the mesh is binary, but must be ASCII: save it without -bin");
  EXPECT_EQ(says(mesh_2, "3 1 1 0\n", "3 1 one 0\n"), "m.msh:14: \"one\" is not a finite number");
  EXPECT_EQ(says(mesh_2, "1 1 2 3\n", "1 1 2 33\n"), "m.msh:24: there is no node 33");
  EXPECT_EQ(says(mesh_2, "1 1 2 3\n", "1 1 2 2\n"),
            "m.msh:24: facet 0 with a corner at (0, 0, 0) m has no area");
  EXPECT_EQ(says(mesh_2, "3 2 2 7", "3 9 2 7"),
            "m.msh:24: the facets are curved, but must be flat: mesh with -order 1");
  EXPECT_EQ(says(mesh_4, "$EndNodes", "$EndElements"),
            "m.msh:35: \"$EndElements\" is found where $EndNodes is expected");
  EXPECT_EQ(says(mesh_4, "5 1 2 6 5\n$EndElements\n$NodeData\n1\n\"x\"\n$EndNodeData\n", ""),
            "m.msh:45: the file ends inside a section");
  EXPECT_EQ(
      says(mesh_4, "0 0 1\n", "0 0 1\n", "bakc"),
      "m.msh has no physical surface \"bakc\", did you mean \"back\"?; it has back, cutting edge");
  EXPECT_EQ(says("solid\n", "solid", "solid"),
            "m.msh:1: \"solid\" is found where a section must begin with $");
  const auto file = write("flat.msh", mesh_2);
  EXPECT_EQ(complaint(file, [&] { read_surface<2>(file); }),
            "flat.msh:16: a node of a model in 2D must have z = 0, not 5");
}

TEST_F(SurfaceFile, polyline_closes_when_its_last_point_is_its_first) {
  const auto open = read_surface<2>(write("a.txt", "# a pick\n0 0\n1, 0\n\n1 1 # tip\n"));
  EXPECT_EQ(open.facets, (std::vector<Facet<2>>{{0, 1}, {1, 2}}));
  EXPECT_FALSE(SurfaceTopology<2>(open).is_closed());
  const auto closed = read_surface<2>(write("b.txt", "0 0\n1 0\n1 1\n0 0\n"));
  EXPECT_EQ(closed.vertices.size(), 3U);
  EXPECT_TRUE(SurfaceTopology<2>(closed).is_closed());
}

TEST_F(SurfaceFile, polyline_that_is_broken_says_where) {
  const auto says = [&](const std::string& text) {
    const auto file = write("p.txt", text);
    return complaint(file, [&] { read_polyline(file); });
  };
  EXPECT_EQ(says("0 0\n1 0 0\n"), "p.txt:2: a line must hold 2 values, x y, but this one holds 3");
  EXPECT_EQ(says("0 0\n1 nan\n"), "p.txt:2: \"nan\" is not a finite number");
  EXPECT_EQ(says("0 0\n1 0\n1 0\n"), "p.txt:3: facet 1 with a corner at (1, 0) m has no length");
  EXPECT_EQ(says("0 0\n"), "p.txt: the surface has no facets");
}

TEST_F(SurfaceFile, of_another_kind_is_refused) {
  EXPECT_EQ(complaint("a.obj", [] { read_surface<3>("a.obj"); }),
            "a.obj is no surface in 3D: its name must end in .stl or .msh");
  EXPECT_EQ(complaint("a.stl", [] { read_surface<2>("a.stl"); }),
            "a.stl is no surface in 2D: its name must end in .txt or .msh");
  EXPECT_EQ(complaint("a.stl", [] { read_surface<3>("a.stl", "edge"); }),
            "a.stl is no Gmsh mesh and has no group \"edge\"");
}

} // namespace
} // namespace kerf
