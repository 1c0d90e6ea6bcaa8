#include "fem_core/face.hpp"

namespace kerf::fem {

template <int dim>
FaceCorners<dim> face_corners(const Mesh<dim>& mesh, const Face& face,
                              std::span<const double> positions) {
  const std::span<const std::uint32_t> nodes = mesh.nodes_of_element(face.element);
  const std::span<const std::uint8_t> side = side_nodes(mesh.shape_of(face.element), face.side);
  const auto at = [&](std::uint8_t a) {
    return Eigen::Map<const Vec<dim>>(&positions[std::size_t{nodes[a]} * dim]);
  };
  FaceCorners<dim> corners(dim, static_cast<Eigen::Index>(side.size()));
  for (std::size_t k = 0; k < side.size(); ++k)
    corners.col(static_cast<Eigen::Index>(k)) =
        at(side[0]) + mesh.period.shortest(at(side[k]) - at(side[0]));
  return corners;
}

template <int dim> Vec<dim> area_vector(const FaceCorners<dim>& x) {
  if constexpr (dim == 2)
    return {x(1, 1) - x(1, 0), x(0, 0) - x(0, 1)};
  else {
    const Eigen::Index last = x.cols() - 1; // of a triangle: two edges; of a quad: its diagonals
    const Vec<3> first = x.cols() == 3 ? x.col(1) - x.col(0) : x.col(2) - x.col(0);
    const Vec<3> second = x.cols() == 3 ? x.col(last) - x.col(0) : x.col(last) - x.col(1);
    return 0.5 * first.cross(second);
  }
}

template FaceCorners<2> face_corners<2>(const Mesh<2>&, const Face&, std::span<const double>);
template FaceCorners<3> face_corners<3>(const Mesh<3>&, const Face&, std::span<const double>);
template Vec<2> area_vector<2>(const FaceCorners<2>&);
template Vec<3> area_vector<3>(const FaceCorners<3>&);

} // namespace kerf::fem
