// N: points are found in the elements around them, and interpolation is exact for linear fields.
#include "coupler/methods/locate.hpp"

#include <gtest/gtest.h>

#include <random>

namespace kerf::coupler {
namespace {

/// A box of n^dim elements with inner nodes moved by up to `skew` of an element.
template <int dim> struct TestMesh {
  std::vector<double> nodes;
  std::vector<std::uint32_t> elements;
  MeshView<dim> view(Period<dim> period = {}) const { return {nodes, elements, period}; }
};

template <int dim> TestMesh<dim> box(int n, double skew) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-skew, skew);
  TestMesh<dim> mesh;
  const int m = n + 1, layers = dim == 3 ? m : 1;
  for (int k = 0; k < layers; ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i) {
        const int index[3] = {i, j, k};
        for (int a = 0; a < dim; ++a) {
          const bool inner = i % n != 0 && j % n != 0 && (dim == 2 || k % n != 0);
          mesh.nodes.push_back(index[a] + (inner ? shift(random) : 0.0));
        }
      }
  for (int k = 0; k < (dim == 3 ? n : 1); ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (int layer = 0; layer < (dim == 3 ? 2 : 1); ++layer)
          for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
            mesh.elements.push_back(
                static_cast<std::uint32_t>(((k + layer) * m + j + dj) * m + i + di));
  return mesh;
}

template <int dim> void expect_linear_fields_are_exact() {
  const TestMesh<dim> mesh = box<dim>(5, 0.2);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> inside(0.0, 5.0);
  std::vector<double> points(100 * dim);
  for (double& x : points)
    x = inside(random);
  const auto found = locate<dim>(mesh.view(), points);
  Interpolation<dim> N;
  for (const auto& location : found) {
    ASSERT_TRUE(location);
    auto& row = N.node.emplace_back();
    for (int a = 0; a < corners<dim>; ++a)
      row[a] = mesh.elements[location->element * corners<dim> + a];
    N.shape.push_back(location->shape);
  }
  for (std::size_t p = 0; p < N.size(); ++p) {
    const Vec<dim> x = N.at(p, mesh.nodes); // positions are a linear field
    for (int a = 0; a < dim; ++a)
      EXPECT_NEAR(x[a], points[p * dim + a], 1e-13); // Newton stops at 1e-14 of an element
  }
}

// An isoparametric map reproduces linear fields (T. Hughes, The Finite Element Method, 1987, 3.3).
TEST(Locate, linear_fields_are_interpolated_exactly_on_distorted_quadrilaterals) {
  expect_linear_fields_are_exact<2>();
}
TEST(Locate, linear_fields_are_interpolated_exactly_on_distorted_hexahedra) {
  expect_linear_fields_are_exact<3>();
}

TEST(Locate, points_outside_the_mesh_are_not_found) {
  const TestMesh<2> mesh = box<2>(4, 0.1);
  const std::vector<double> points = {-1e-6, 2.0, 4.00001, 2.0, 2.0, -1e-6, 100.0, -50.0};
  for (const auto& location : locate<2>(mesh.view(), points))
    EXPECT_FALSE(location);
}

TEST(Locate, a_point_on_a_shared_face_goes_to_the_lowest_element) {
  const TestMesh<2> mesh = box<2>(4, 0.0);
  const std::vector<double> points = {1.0, 0.5, 0.0, 0.0, 4.0, 4.0};
  const auto found = locate<2>(mesh.view(), points);
  EXPECT_EQ(found[0]->element, 0u);
  EXPECT_EQ(found[1]->element, 0u);
  EXPECT_EQ(found[2]->element, 15u);
}

TEST(Locate, a_periodic_mesh_holds_every_image_of_a_point) {
  // Three rows; the last one joins the nodes at y = 2 with those at y = 0 (period 3).
  TestMesh<2> mesh;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 2; ++i)
      mesh.nodes.insert(mesh.nodes.end(), {static_cast<double>(i), static_cast<double>(j)});
  mesh.elements = {0, 1, 3, 2, 2, 3, 5, 4, 4, 5, 1, 0};
  const Period<2> period{Vec<2>(0.0, 3.0)};
  const std::vector<double> points = {0.5, 2.5, 0.5, -0.5, 0.5, 5.5, 0.5, 0.25};
  const auto found = locate<2>(mesh.view(period), points);
  for (const int p : {0, 1, 2}) {
    ASSERT_TRUE(found[p]);
    EXPECT_EQ(found[p]->element, 2u);
    for (const double N : found[p]->shape)
      EXPECT_DOUBLE_EQ(N, 0.25);
  }
  EXPECT_EQ(found[3]->element, 0u);
}

} // namespace
} // namespace kerf::coupler
