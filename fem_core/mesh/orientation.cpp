#include "fem_core/mesh/orientation.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace kerf::fem {
namespace {

/// The order of the nodes of an element seen in a mirror.
std::span<const std::uint8_t> mirrored(Shape shape) {
  static constexpr std::uint8_t tri[] = {0, 2, 1}, quad[] = {0, 3, 2, 1}, tet[] = {0, 1, 3, 2},
                                hex[] = {0, 3, 2, 1, 4, 7, 6, 5};
  switch (shape) {
  case Shape::tri3:
    return tri;
  case Shape::quad4:
    return quad;
  case Shape::tet4:
    return tet;
  case Shape::hex8:
    break;
  }
  return hex;
}

/// Has the sign of detJ in the middle of an element.
template <int dim> double orientation(const Mesh<dim>& mesh, std::size_t element) {
  const auto x = mesh.corners(element);
  Eigen::Matrix<double, dim, dim> J;
  if (x.cols() == dim + 1)
    J = x.template rightCols<dim>().colwise() - x.col(0);
  else if constexpr (dim == 2)
    J << x.col(1) + x.col(2) - x.col(0) - x.col(3), x.col(2) + x.col(3) - x.col(0) - x.col(1);
  else
    J << x.col(1) + x.col(2) + x.col(5) + x.col(6) - x.col(0) - x.col(3) - x.col(4) - x.col(7),
        x.col(2) + x.col(3) + x.col(6) + x.col(7) - x.col(0) - x.col(1) - x.col(4) - x.col(5),
        x.template rightCols<4>().rowwise().sum() - x.template leftCols<4>().rowwise().sum();
  return J.determinant();
}

} // namespace

template <int dim> void orient(Mesh<dim>& mesh) {
  assert(mesh.boundary.empty());
  std::size_t element = 0;
  for (Block& block : mesh.blocks) {
    const std::span<const std::uint8_t> order = mirrored(block.shape);
    for (std::size_t k = 0; k < block.nodes.size(); k += order.size(), ++element) {
      if (orientation(mesh, element) >= 0.0)
        continue;
      std::array<std::uint32_t, 8> old;
      std::copy_n(&block.nodes[k], order.size(), old.begin());
      for (std::size_t a = 0; a < order.size(); ++a)
        block.nodes[k + a] = old[order[a]];
    }
  }
}

template void orient<2>(Mesh<2>&);
template void orient<3>(Mesh<3>&);

} // namespace kerf::fem
