// Where points lie in a mesh: the operator N that interpolates nodal values to the points.
#pragma once

#include "common/vec.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kerf::coupler {

/// Number of nodes of the multilinear element: quad4 in 2D, hex8 in 3D (VTK's node order).
template <int dim> inline constexpr int corners = 1 << dim;

/// A mesh of multilinear elements in its reference configuration.
template <int dim> struct MeshView {
  std::span<const double> nodes;           // [num_nodes][dim] m
  std::span<const std::uint32_t> elements; // [num_elements][corners]
  Period<dim> period;
};

/// Shape function values of the element around a point; they sum to one.
template <int dim> struct Location {
  std::uint32_t element = 0;
  std::array<double, corners<dim>> shape{};
};

/// Finds the element around each point by a grid over the elements' boxes and the inverse of the
/// isoparametric map. A point on a shared face goes to the element with the lowest index.
///
/// @param points  [num_points][dim] reference positions, m
/// @return [num_points] nothing for a point outside the mesh
template <int dim>
std::vector<std::optional<Location<dim>>> locate(const MeshView<dim>& mesh,
                                                 std::span<const double> points);

/// N of a set of points, in compressed form: the value at row r is the sum over its corners a of
/// shape[r][a] times the value at node[r][a].
template <int dim> struct Interpolation {
  std::vector<std::array<std::uint32_t, corners<dim>>> node; // [num_points]
  std::vector<std::array<double, corners<dim>>> shape;       // [num_points]

  std::size_t size() const { return node.size(); }

  /// Interpolated value at row r. @param nodal [num_nodes][dim]
  Vec<dim> at(std::size_t r, std::span<const double> nodal) const {
    Vec<dim> value = Vec<dim>::Zero();
    for (int a = 0; a < corners<dim>; ++a)
      value += shape[r][a] * Eigen::Map<const Vec<dim>>(nodal.data() + dim * node[r][a]);
    return value;
  }
};

} // namespace kerf::coupler
