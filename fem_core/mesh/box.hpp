// The structured box.
#pragma once

#include "fem_core/mesh.hpp"

#include <array>

namespace kerf::fem {

template <int dim> struct BoxMesh {
  Vec<dim> origin = Vec<dim>::Zero();     // m, lower corner
  Vec<dim> size;                          // m, > 0
  std::array<std::uint32_t, dim> count{}; // of cells along each axis
  Vec<dim> grading = Vec<dim>::Ones(); // size of the last cell over that of the first, by axis, > 0
  Shape shape = dim == 2 ? Shape::quad4 : Shape::hex8; // cells are cut as in_shape() does
};

/// Nodes and cells are numbered with x fastest. The sides are tagged left, right (across x),
/// bottom, top (y), back and front (z). Along a periodic axis the two ends are one and have no
/// tag.
///
/// @throws InputError for a size, count or grading that is not positive, a box that does not span
///         the period, is graded along it or has fewer than three cells there, more corners than 32
///         bits can number, or a shape of another dimension
template <int dim> Mesh<dim> make_box(const BoxMesh<dim>& box, const Period<dim>& period = {});

} // namespace kerf::fem
