#include "fem_core/elements.hpp"

#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kerf::fem {

template <int dim> NodeValues<dim> shape_functions(const Vec<dim>& xi) {
  NodeValues<dim> N;
  for (int a = 0; a < element_nodes<dim>; ++a) {
    N[a] = 1.0;
    for (int i = 0; i < dim; ++i)
      N[a] *= 0.5 * (1.0 + (2 * corner_side(a, i) - 1) * xi[i]);
  }
  return N;
}

template <int dim> NodeVectors<dim> shape_derivatives(const Vec<dim>& xi) {
  NodeVectors<dim> dN;
  for (int a = 0; a < element_nodes<dim>; ++a)
    for (int j = 0; j < dim; ++j) {
      dN(j, a) = 1.0;
      for (int i = 0; i < dim; ++i) {
        const int sign = 2 * corner_side(a, i) - 1;
        dN(j, a) *= i == j ? 0.5 * sign : 0.5 * (1.0 + sign * xi[i]);
      }
    }
  return dN;
}

template <int dim> const std::array<Vec<dim>, gauss_points<dim>>& gauss_rule() {
  static const auto rule = [] {
    std::array<Vec<dim>, gauss_points<dim>> points;
    for (int q = 0; q < gauss_points<dim>; ++q)
      for (int i = 0; i < dim; ++i)
        points[q][i] = (2 * corner_side(q, i) - 1) / std::sqrt(3.0);
    return points;
  }();
  return rule;
}

namespace {

/// Lists the corners around each node, in the order of the elements.
template <int dim> void connect(Elements<dim>& elements, std::size_t num_nodes) {
  elements.first_corner.assign(num_nodes + 1, 0);
  for (const std::uint32_t node : elements.nodes)
    ++elements.first_corner[node + 1];
  for (std::size_t a = 0; a < num_nodes; ++a)
    elements.first_corner[a + 1] += elements.first_corner[a];
  elements.corners.resize(elements.nodes.size());
  std::vector<std::uint32_t> next(elements.first_corner.begin(), elements.first_corner.end() - 1);
  for (std::size_t c = 0; c < elements.nodes.size(); ++c)
    elements.corners[next[elements.nodes[c]]++] = static_cast<std::uint32_t>(c);
}

} // namespace

template <int dim>
Elements<dim> make_elements(const Mesh<dim>& mesh, std::span<const double> alpha) {
  constexpr std::size_t num_corners = element_nodes<dim>;
  if (!alpha.empty() && alpha.size() != mesh.num_nodes())
    throw std::invalid_argument(
        fmt::format("{} weights were given for {} nodes", alpha.size(), mesh.num_nodes()));
  for (std::size_t a = 0; a < alpha.size(); ++a)
    if (!(alpha[a] >= 0.0 && alpha[a] <= 1.0))
      throw std::invalid_argument(
          fmt::format("the weight of node {} is {}; it must be from 0 to 1", a, alpha[a]));

  std::array<NodeValues<dim>, gauss_points<dim>> N;
  std::array<NodeVectors<dim>, gauss_points<dim>> dN;
  for (int q = 0; q < gauss_points<dim>; ++q) {
    N[q] = shape_functions<dim>(gauss_rule<dim>()[q]);
    dN[q] = shape_derivatives<dim>(gauss_rule<dim>()[q]);
  }

  Elements<dim> elements;
  for (std::size_t e = 0; e < mesh.num_elements(); ++e) {
    const std::span nodes = std::span(mesh.elements).subspan(e * num_corners, num_corners);
    NodeValues<dim> share = NodeValues<dim>::Ones();
    NodeVectors<dim> X;
    const Vec<dim> first = mesh.position(nodes[0]);
    for (std::size_t a = 0; a < num_corners; ++a) {
      if (!alpha.empty())
        share[a] = alpha[nodes[a]];
      X.col(a) = first + mesh.period.shortest(mesh.position(nodes[a]) - first);
    }
    if (share.isZero(0.0))
      continue;
    elements.number.push_back(static_cast<std::uint32_t>(e));
    elements.nodes.insert(elements.nodes.end(), nodes.begin(), nodes.end());
    for (int q = 0; q < gauss_points<dim>; ++q) {
      const Tensor<dim> J = X * dN[q].transpose(); // dX/dxi
      const double det_J = J.determinant();
      if (!(det_J > 0.0))
        throw std::invalid_argument(fmt::format(
            "element {} has the Jacobian {} at Gauss point {}; it must be positive", e, det_J, q));
      const NodeVectors<dim> gradient = J.transpose().inverse() * dN[q]; // dN/dX
      elements.gradients.insert(elements.gradients.end(), gradient.data(),
                                gradient.data() + gradient.size());
      elements.volume.push_back(N[q].dot(share) * det_J);
    }
  }
  connect(elements, mesh.num_nodes());
  return elements;
}

template NodeValues<2> shape_functions<2>(const Vec<2>&);
template NodeValues<3> shape_functions<3>(const Vec<3>&);
template NodeVectors<2> shape_derivatives<2>(const Vec<2>&);
template NodeVectors<3> shape_derivatives<3>(const Vec<3>&);
template const std::array<Vec<2>, gauss_points<2>>& gauss_rule<2>();
template const std::array<Vec<3>, gauss_points<3>>& gauss_rule<3>();
template Elements<2> make_elements<2>(const Mesh<2>&, std::span<const double>);
template Elements<3> make_elements<3>(const Mesh<3>&, std::span<const double>);

} // namespace kerf::fem
