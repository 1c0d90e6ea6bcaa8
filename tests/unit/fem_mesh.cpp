// The structured mesh: numbering, tags, periodic axes.
#include "fem_core/input_error.hpp"
#include "fem_core/mesh.hpp"

#include <gtest/gtest.h>

namespace kerf::fem {
namespace {

const BoxMesh<2> plate{.origin = {1.0, 2.0}, .size = {3.0, 2.0}, .count = {3, 2}};
const BoxMesh<3> block{.origin = {0.0, 0.0, 0.0}, .size = {3.0, 4.0, 5.0}, .count = {3, 4, 5}};

template <class Call> InputError caught(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error;
  }
  return {"nothing was thrown", ""};
}

/// Volume under the faces of a tag by the divergence theorem: the mean of x . n dA / dim.
template <int dim> double enclosed_volume(const Mesh<dim>& mesh) {
  double volume = 0.0;
  for (const auto& [tag, faces] : mesh.boundary)
    for (std::size_t f = 0; f < faces.size(); f += face_nodes<dim>) {
      const Vec<dim> a = mesh.position(faces[f]);
      if constexpr (dim == 2) {
        const Vec<2> b = mesh.position(faces[f + 1]);
        volume += 0.5 * (a[0] * b[1] - a[1] * b[0]);
      } else {
        const Vec<3> b = mesh.position(faces[f + 1]);
        const Vec<3> c = mesh.position(faces[f + 2]);
        const Vec<3> d = mesh.position(faces[f + 3]);
        volume += (a.dot(b.cross(c)) + a.dot(c.cross(d))) / 6.0;
      }
    }
  return volume;
}

TEST(BoxMesh, numbers_nodes_with_x_fastest_and_elements_in_the_order_of_vtk) {
  const Mesh<2> mesh = make_box(plate);
  EXPECT_EQ(mesh.num_nodes(), 12u);
  EXPECT_EQ(mesh.num_elements(), 6u);
  EXPECT_EQ(mesh.position(5), Vec<2>(2.0, 3.0));
  EXPECT_EQ(mesh.position(11), Vec<2>(4.0, 4.0));
  const std::vector<std::uint32_t> first(mesh.elements.begin(), mesh.elements.begin() + 4);
  EXPECT_EQ(first, (std::vector<std::uint32_t>{0, 1, 5, 4}));

  // VTK file formats: a hexahedron is numbered round its lower face, then round its upper one.
  const Mesh<3> solid = make_box(block); // 4 x 5 x 6 nodes
  const std::vector<std::uint32_t> hex(solid.elements.begin(), solid.elements.begin() + 8);
  EXPECT_EQ(hex, (std::vector<std::uint32_t>{0, 1, 5, 4, 20, 21, 25, 24}));
}

TEST(BoxMesh, has_faces_on_every_side_that_together_enclose_its_volume) {
  // Only faces that all look outward give the volume; exact up to the rounding of a few sums.
  EXPECT_NEAR(enclosed_volume(make_box(plate)), 6.0, 1e-13);
  EXPECT_NEAR(enclosed_volume(make_box(block)), 60.0, 1e-12);
  EXPECT_EQ(make_box(block).boundary.at("left").size(), 4u * 20u);
  EXPECT_EQ(nodes_with_tag(make_box(plate), "right", "").size(), 3u);
  EXPECT_EQ(nodes_with_tag(make_box(plate), "right", ""), (std::vector<std::uint32_t>{3, 7, 11}));
  EXPECT_EQ(nodes_with_tag(make_box(plate), "all", "").size(), 12u);
}

TEST(BoxMesh, joins_the_ends_of_a_periodic_axis_and_gives_them_no_tag) {
  const Mesh<2> mesh =
      make_box(BoxMesh<2>{.size = {3.0, 2.0}, .count = {3, 2}}, Period<2>{.length = {3.0, 0.0}});
  EXPECT_EQ(mesh.num_nodes(), 9u);
  const std::vector<std::uint32_t> last(mesh.elements.begin() + 8, mesh.elements.begin() + 12);
  EXPECT_EQ(last, (std::vector<std::uint32_t>{2, 0, 3, 5}));
  EXPECT_EQ(mesh.boundary.count("left"), 0u);
  EXPECT_EQ(mesh.boundary.count("right"), 0u);
  EXPECT_EQ(mesh.boundary.count("top"), 1u);
}

TEST(BoxMesh, refuses_what_it_cannot_mesh_and_names_the_key) {
  const Period<2> period{.length = {3.0, 0.0}};
  EXPECT_EQ(caught([] {
              make_box(BoxMesh<2>{.size = {3.0, 0.0}, .count = {3, 2}});
            }).key(),
            "mesh.size");
  EXPECT_EQ(caught([] {
              make_box(BoxMesh<2>{.size = {3.0, 1.0}, .count = {3, 0}});
            }).key(),
            "mesh.count");
  EXPECT_EQ(caught([] {
              make_box(BoxMesh<2>{.size = {3.0, 1.0}, .count = {1u << 20, 1u << 20}});
            }).key(),
            "mesh.count");
  const InputError other_size = caught([&] {
    make_box(BoxMesh<2>{.size = {2.5, 1.0}, .count = {3, 2}}, period);
  });
  EXPECT_EQ(other_size.key(), "mesh.size");
  EXPECT_STREQ(other_size.what(),
               "the size along the periodic axis x is 2.5 m; it must be the period, 3 m");
  EXPECT_EQ(caught([&] {
              make_box(BoxMesh<2>{.size = {3.0, 1.0}, .count = {2, 2}}, period);
            }).key(),
            "mesh.count");
}

TEST(BoxMesh, lists_its_tags_when_it_is_asked_for_another) {
  const InputError error =
      caught([] { nodes_with_tag(make_box(plate), "front", "boundary[0].tag"); });
  EXPECT_EQ(error.key(), "boundary[0].tag");
  EXPECT_STREQ(error.what(),
               "the mesh has no tag \"front\"; its tags are all, bottom, left, right, top");
}

} // namespace
} // namespace kerf::fem
