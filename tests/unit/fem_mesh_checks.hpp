// What must hold of every mesh, found out independently of how it was made.
#pragma once

#include "fem_core/face.hpp"
#include "fem_core/input_error.hpp"
#include "fem_core/mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace kerf::fem {

/// "key: sentence" of what the call refuses.
template <class Call> std::string refusal(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.key() + ": " + error.what();
  }
  return "nothing was refused";
}

/// The integral of x . n / dim over a face. Exact: of a bilinear one the integrand is of second
/// degree in each coordinate, which the 2 x 2 Gauss rule integrates.
template <int dim> double flux(const FaceCorners<dim>& x) {
  if (x.cols() < 4)
    return x.rowwise().mean().dot(area_vector<dim>(x)) / dim;
  double sum = 0.0;
  if constexpr (dim == 3)
    for (const double a : {-1.0, 1.0})
      for (const double b : {-1.0, 1.0}) {
        const double u = 0.5 + 0.5 * a / std::sqrt(3.0), v = 0.5 + 0.5 * b / std::sqrt(3.0);
        const Vec<3> along_u = (1 - v) * (x.col(1) - x.col(0)) + v * (x.col(2) - x.col(3));
        const Vec<3> along_v = (1 - u) * (x.col(3) - x.col(0)) + u * (x.col(2) - x.col(1));
        const Vec<3> point = (1 - u) * (1 - v) * x.col(0) + u * (1 - v) * x.col(1) +
                             u * v * x.col(2) + (1 - u) * v * x.col(3);
        sum += 0.25 * point.dot(along_u.cross(along_v)) / 3.0;
      }
  return sum;
}

/// What the faces of the given tags enclose, or those of all tags, by the divergence theorem: only
/// faces that all look outward give the volume.
template <int dim>
double enclosed_volume(const Mesh<dim>& mesh, const std::vector<std::string>& tags = {}) {
  double volume = 0.0;
  for (const auto& [tag, faces] : mesh.boundary)
    if (tags.empty() || std::find(tags.begin(), tags.end(), tag) != tags.end())
      for (const Face& face : faces)
        volume += flux<dim>(face_corners(mesh, face, mesh.positions));
  return volume;
}

/// The volume within the sides of an element, which have its own corners.
template <int dim> double volume_of(const Mesh<dim>& mesh, std::size_t element) {
  const auto corners = mesh.corners(element);
  const Shape shape = mesh.shape_of(element);
  double volume = 0.0;
  for (int side = 0; side < sides_of(shape); ++side) {
    const std::span<const std::uint8_t> nodes = side_nodes(shape, side);
    FaceCorners<dim> x(dim, static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t k = 0; k < nodes.size(); ++k)
      x.col(static_cast<Eigen::Index>(k)) = corners.col(nodes[k]);
    volume += flux<dim>(x);
  }
  return volume;
}

template <int dim> double volume_of(const Mesh<dim>& mesh) {
  double volume = 0.0;
  for (std::size_t e = 0; e < mesh.num_elements(); ++e)
    volume += volume_of(mesh, e);
  return volume;
}

template <int dim> double smallest_volume(const Mesh<dim>& mesh) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < mesh.num_elements(); ++e)
    smallest = std::min(smallest, volume_of(mesh, e));
  return smallest;
}

/// Every side belongs to two elements, or to one and then to exactly one tag; no node is left over.
/// @param inner  tags of sides between elements
template <int dim>
void expect_conforming(const Mesh<dim>& mesh, const std::vector<std::string>& inner = {}) {
  const auto key = [&](const Face& face) {
    std::vector<std::uint32_t> nodes = mesh.nodes_of_face(face);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  };
  std::map<std::vector<std::uint32_t>, int> elements, tags;
  for (std::uint32_t e = 0; e < mesh.num_elements(); ++e)
    for (int side = 0; side < sides_of(mesh.shape_of(e)); ++side)
      ++elements[key({e, static_cast<std::uint8_t>(side)})];
  for (const auto& [tag, faces] : mesh.boundary) {
    const bool is_inner = std::find(inner.begin(), inner.end(), tag) != inner.end();
    for (const Face& face : faces) {
      EXPECT_EQ(elements.at(key(face)), is_inner ? 2 : 1) << tag;
      tags[key(face)] += !is_inner;
    }
  }
  std::vector<bool> is_used(mesh.num_nodes());
  for (const auto& [nodes, count] : elements) {
    ASSERT_TRUE(count == 2 || (count == 1 && tags[nodes] == 1)) << fmt::format(
        "{} elements and {} tags have the side {}", count, tags[nodes], fmt::join(nodes, " "));
    for (const std::uint32_t node : nodes)
      is_used[node] = true;
  }
  EXPECT_EQ(std::count(is_used.begin(), is_used.end(), false), 0);
}

} // namespace kerf::fem
