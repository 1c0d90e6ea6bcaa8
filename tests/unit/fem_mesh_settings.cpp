// The settings of a mesh: from JSON to the mesh, in both dimensions.
#include "fem_core/program/read_mesh.hpp"

#include "fem_core/mesh/quality.hpp"
#include "tests/unit/fem_mesh_checks.hpp"

#include <nlohmann/json.hpp>

namespace kerf::fem {
namespace {

using nlohmann::json;

/// @param mesh  JSON; keys that are not given are null in a run and may be left out here
template <int dim> Mesh<dim> read(const std::string& mesh, const Period<dim>& period = {}) {
  const json participant = {{"mesh", json::parse(mesh)}};
  return read_mesh(Table(participant, ""), period);
}

template <int dim> std::string refused(const std::string& mesh, const Period<dim>& period = {}) {
  try {
    return refusal([&] { read(mesh, period); });
  } catch (const coupler::SettingsError& error) {
    return error.key() + ": " + error.what();
  }
}

/// Area of the regular polygon of n corners on a circle.
double polygon(double radius, double n) {
  return 0.5 * n * radius * radius * std::sin(2.0 * 3.14159265358979323846 / n);
}

/// Volumes are exact to round-off of some hundred terms.
template <int dim>
void expect_body(const Mesh<dim>& mesh, double volume, std::size_t elements, Shape shape) {
  EXPECT_NEAR(volume_of(mesh), volume, 1e-12 * volume);
  EXPECT_EQ(mesh.num_elements(), elements);
  EXPECT_EQ(mesh.blocks.at(0).shape, shape);
}

TEST(MeshSettings, are_read_as_they_are_written) {
  expect_body(read<2>(R"({"type": "box", "origin": [1, 2], "size": [3, 2], "count": [3, 2],
                          "grading": [2, 1], "shape": null})"),
              6.0, 6, Shape::quad4);
  expect_body(read<3>(R"({"type": "bar", "origin": [1, 2, 0], "size": [3, 2, 1], "elements": 5,
                          "shape": "tet4"})"),
              6.0, 30, Shape::tet4);
  expect_body(read<2>(R"({"type": "disc", "center": [0, 0], "radius": 2, "count": [2, 8],
                          "shape": "tri3"})"),
              polygon(2.0, 8), 40, Shape::tri3);
  expect_body(read<3>(R"({"type": "cylinder", "center": [0, 0, 1], "radius": 2, "length": 3,
                          "count": [2, 8, 5]})"),
              3.0 * polygon(2.0, 8), 100, Shape::hex8);
  expect_body(read<2>(R"({"type": "ring", "center": [0, 0], "radius": 2, "inner_radius": 1,
                          "count": [2, 9], "radial_grading": 3})"),
              polygon(2.0, 9) - polygon(1.0, 9), 18, Shape::quad4);
  expect_body(read<3>(R"({"type": "ring", "center": [0, 0, 1], "radius": 2, "inner_radius": 1,
                          "length": 3, "count": [2, 9, 1]})"),
              3.0 * (polygon(2.0, 9) - polygon(1.0, 9)), 18, Shape::hex8);
  expect_body(read<2>(R"({"type": "tunnel", "origin": [0, 0], "size": [8, 6], "radius": 1,
                          "center": [3, 3], "count": [4, 8], "excavation": true})"),
              48.0, 32 + 4 + 8, Shape::quad4);
  expect_body(read<3>(R"({"type": "tunnel", "origin": [0, 0, 1], "size": [8, 6, 2], "radius": 1,
                          "count": [4, 8, 3], "radial_grading": 2})"),
              2.0 * (48.0 - polygon(1.0, 8)), 96, Shape::hex8);
}

TEST(MeshSettings, place_the_mesh_where_they_say) {
  const Mesh<2> box = read<2>(R"({"type": "box", "origin": [1, 2], "size": [3, 2], "count": [2, 2],
                                  "grading": [2, 1]})");
  EXPECT_EQ(box.position(1), Vec<2>(2.0, 2.0)); // elements of 1 m and 2 m
  const Mesh<3> cylinder = read<3>(R"({"type": "cylinder", "center": [5, 6, 1], "radius": 2,
                                       "length": 3, "count": [1, 8, 5]})");
  const Box<3> extent = quality_of(cylinder).extent;
  EXPECT_LT((extent.lower - Vec<3>(5.0 - std::sqrt(2.0), 6.0 - std::sqrt(2.0), 1.0)).maxCoeff(),
            1e-14);
  EXPECT_EQ(extent.upper[2], 4.0);
  const Mesh<2> tunnel = read<2>(R"({"type": "tunnel", "origin": [0, 0], "size": [8, 6],
                                     "radius": 1, "center": [3, 3], "count": [4, 8]})");
  for (const std::uint32_t node : nodes_with_tag(tunnel, "wall", ""))
    EXPECT_NEAR((tunnel.position(node) - Vec<2>(3.0, 3.0)).norm(), 1.0, 1e-15);
}

TEST(MeshSettings, that_make_no_mesh_are_refused_with_their_key) {
  const Period<2> period{.length = {0.0, 2.0}};
  EXPECT_EQ(
      refused<2>(R"({"type": "disc", "center": [0, 0], "radius": 1, "count": [1, 4]})", period),
      "mesh.type: \"disc\" cannot be periodic");
  EXPECT_EQ(refused<3>(R"({"type": "disc"})"),
            "mesh.type: \"disc\" must be box, bar, cylinder, ring, tunnel or file");
  EXPECT_EQ(refused<2>(R"({"type": "box", "origin": [0, 0], "size": [1, 1], "count": [1, 1],
                           "shape": "hex20"})"),
            "mesh.shape: \"hex20\" must be tri3, quad4, tet4 or hex8");
  EXPECT_EQ(refused<2>(R"({"type": "bar", "origin": [0, 0], "size": [1, 1]})"),
            "mesh.elements: it is missing; give a positive integer");
  EXPECT_EQ(refused<2>(R"({"type": "bar", "origin": [0, 0], "size": [1, 1],
                           "elements": 5000000000})"),
            "mesh.elements: 5000000000 are too many elements");
  EXPECT_EQ(refused<3>(R"({"type": "tunnel", "origin": [0, 0, 1], "size": [8, 6, 2], "radius": 1,
                           "center": [4, 3, 0], "count": [4, 8, 3]})"),
            "mesh.center: it is at the lower end of the tunnel: give it the z of origin");
  EXPECT_EQ(refused<2>(R"({"type": "tunnel", "origin": [0, 0], "size": [8, 6], "radius": 1,
                           "count": [4, 8], "excavation": 1})"),
            "mesh.excavation: it is 1; it must be true or false");
  EXPECT_EQ(refused<2>(R"({"type": "file", "file": "/nowhere/rock.msh"})"),
            "mesh.file: there is no file /nowhere/rock.msh");
}

} // namespace
} // namespace kerf::fem
