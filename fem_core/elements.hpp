// The elements quad4 and hex8: shape functions, quadrature, and what they give on a mesh.
#pragma once

#include "fem_core/materials.hpp"
#include "fem_core/mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kerf::fem {

/// Points of the 2 x 2 (x 2) Gauss rule; every weight is one.
template <int dim> inline constexpr int gauss_points = 1 << dim;

/// One value at each node of an element.
template <int dim> using NodeValues = Eigen::Matrix<double, element_nodes<dim>, 1>;

/// One vector at each node of an element, as columns: [element_nodes][dim] in memory.
template <int dim> using NodeVectors = Eigen::Matrix<double, dim, element_nodes<dim>>;

/// Shape functions N_a at a point of the reference element [-1, 1]^dim.
template <int dim> NodeValues<dim> shape_functions(const Vec<dim>& xi);

/// Their derivatives dN_a / dxi.
template <int dim> NodeVectors<dim> shape_derivatives(const Vec<dim>& xi);

/// The Gauss points of the reference element.
template <int dim> const std::array<Vec<dim>, gauss_points<dim>>& gauss_rule();

/// The elements that take part in a run, ready for integration over their volume.
template <int dim> struct Elements {
  std::vector<std::uint32_t> number; // [size] in the mesh, ascending
  std::vector<std::uint32_t> nodes;  // [size][element_nodes]
  std::vector<double> gradients;     // [size][gauss_points][element_nodes][dim] dN_a/dX, 1/m
  /// [size][gauss_points] alpha detJ, m³ (m² in 2D): the share alpha of the elements in the blended
  /// virtual work, interpolated from the nodes, is part of the volume; Rojek (2008) eqs 44, 46
  std::vector<double> volume;

  /// Corners of the elements around each node, in the order of the elements: node a has those from
  /// first_corner[a] up to first_corner[a + 1]; a corner is element * element_nodes + local node.
  std::vector<std::uint32_t> first_corner; // [num_nodes + 1]
  std::vector<std::uint32_t> corners;      // [size * element_nodes]

  std::size_t size() const { return number.size(); }
  std::size_t num_nodes() const { return first_corner.size() - 1; }

  Eigen::Map<const NodeVectors<dim>> gradient(std::size_t element, int point) const {
    constexpr std::size_t stride = element_nodes<dim> * dim;
    return Eigen::Map<const NodeVectors<dim>>(
        gradients.data() +
        (element * gauss_points<dim> + static_cast<std::size_t>(point)) * stride);
  }
  double volume_at(std::size_t element, int point) const {
    return volume[element * gauss_points<dim> + static_cast<std::size_t>(point)];
  }
  /// Displacements of an element's nodes from that of its first one, out of [num_nodes][dim]: only
  /// differences strain, and a body that travels keeps its digits.
  NodeVectors<dim> relative_displacement(std::size_t element, std::span<const double> u) const {
    const std::uint32_t* node = nodes.data() + element * element_nodes<dim>;
    const auto at = [&](int a) {
      return Eigen::Map<const Vec<dim>>(&u[std::size_t{node[a]} * dim]);
    };
    NodeVectors<dim> differences;
    for (int a = 0; a < element_nodes<dim>; ++a)
      differences.col(a) = at(a) - at(0);
    return differences;
  }
  /// Small strain at a Gauss point for the displacements of the element's nodes.
  Tensor<dim> strain(std::size_t element, int point, const NodeVectors<dim>& displacement) const {
    const Tensor<dim> H = displacement * gradient(element, point).transpose(); // du/dX
    return 0.5 * (H + H.transpose());
  }
};

/// Prepares the elements of a mesh. Those whose alpha is zero at all their nodes are left out.
///
/// @param alpha  [num_nodes] share of the elements in the blended virtual work, from 0 to 1; empty:
///               one everywhere
/// @throws std::invalid_argument for a wrong size, an alpha outside [0, 1], or an element whose
///         Jacobian is not positive (wrong node order, too distorted), by number
template <int dim>
Elements<dim> make_elements(const Mesh<dim>& mesh, std::span<const double> alpha = {});

} // namespace kerf::fem
