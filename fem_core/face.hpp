// Where a side of an element is, and how large.
#pragma once

#include "fem_core/mesh.hpp"

namespace kerf::fem {

/// Corners of a face as columns, in the order of Mesh::nodes_of_face(), m.
template <int dim> using FaceCorners = Eigen::Matrix<double, dim, Eigen::Dynamic, 0, dim, 4>;

/// The corners of a face in any configuration.
///
/// @param positions  [num_nodes][dim] m; of a periodic mesh, images next to the first corner are
///                   taken
template <int dim>
FaceCorners<dim> face_corners(const Mesh<dim>& mesh, const Face& face,
                              std::span<const double> positions);

/// The integral of the outward unit normal over a face: area times normal where the face is plane,
/// exact for the bilinear surface where it is not, m² (m in 2D).
template <int dim> Vec<dim> area_vector(const FaceCorners<dim>& corners);

} // namespace kerf::fem
