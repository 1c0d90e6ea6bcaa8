// Whether elements can be computed with, and how well they are shaped.
#pragma once

#include "fem_core/mesh.hpp"

#include <optional>
#include <string>

namespace kerf::fem {

/// An element and the value that it is named for.
struct Worst {
  double value = 0.0;
  std::uint32_t element = 0;
  std::string region; // the first of its tags; empty: it has none
};

template <int dim> struct Quality {
  /// Smallest detJ at corners and Gauss points, over the volume of the reference element: m³, m² in
  /// 2D. Positive of an element that can be computed with.
  Worst jacobian;
  /// Smallest detJ at a corner over the product of the edges there, one for squares, cubes and
  /// regular simplices; Knupp, Int. J. Numer. Meth. Eng. 48 (2000) 401-420.
  Worst scaled_jacobian;
  Worst aspect_ratio; // largest ratio of the longest edge of an element to its shortest, >= 1
  double shortest_edge = 0.0, longest_edge = 0.0; // m
  Box<dim> extent;                                // around the nodes, m
};

/// @pre the mesh has elements
template <int dim> Quality<dim> quality_of(const Mesh<dim>& mesh);

/// Refuses a mesh that cannot be computed with.
///
/// @param key  what the error names, for example "mesh.file"
/// @return its quality
/// @throws InputError for a mesh without elements, positions that are not numbers, a node without
///         an element, two nodes at one place (closer than 1e-6 of the shortest edge), and an
///         element whose Jacobian is not positive at a corner or a Gauss point, with its region and
///         the positions of its nodes
template <int dim> Quality<dim> check_mesh(const Mesh<dim>& mesh, const std::string& key);

/// A doubt whether a mesh is in metres: a body of more than 100 km or less than 1 µm, or elements
/// so large that a wave does not get through one of them in the whole run.
///
/// @param travelled  wave speed times duration of the run, m; infinity when that is not known
/// @return a sentence; nothing without a doubt
template <int dim>
std::optional<std::string> doubt_of_unit(const Quality<dim>& quality, double travelled);

} // namespace kerf::fem
