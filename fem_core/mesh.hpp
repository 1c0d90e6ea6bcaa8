// The mesh: nodes, elements and named faces; and the structured box.
#pragma once

#include "common/vec.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace kerf::fem {

/// Nodes of an element: quad4 in 2D, hex8 in 3D, in VTK's order.
template <int dim> inline constexpr int element_nodes = 1 << dim;

/// Nodes of a face of an element.
template <int dim> inline constexpr int face_nodes = 1 << (dim - 1);

/// Side of an element on which its corner lies along an axis: 0 lower, 1 upper. VTK's order goes
/// round the lower face, then round the upper one.
constexpr int corner_side(int corner, int axis) {
  return axis == 0 ? (corner ^ (corner >> 1)) & 1 : (corner >> axis) & 1;
}

/// Nodes and elements in the reference configuration.
template <int dim> struct Mesh {
  std::vector<double> positions;       // [num_nodes][dim] m
  std::vector<std::uint32_t> elements; // [num_elements][element_nodes]
  /// Faces by tag, [num_faces][face_nodes]; seen from outside counter-clockwise in 3D, with the
  /// body on the left in 2D.
  std::map<std::string, std::vector<std::uint32_t>> boundary;
  Period<dim> period; // an element across the end of the period joins both ends of the node list

  std::size_t num_nodes() const { return positions.size() / dim; }
  std::size_t num_elements() const { return elements.size() / element_nodes<dim>; }
  Vec<dim> position(std::size_t node) const {
    return Eigen::Map<const Vec<dim>>(positions.data() + node * dim);
  }
};

/// A box that is cut into equal elements.
template <int dim> struct BoxMesh {
  Vec<dim> origin = Vec<dim>::Zero();        // lower corner, m
  Vec<dim> size = Vec<dim>::Zero();          // m
  std::array<std::uint64_t, dim> count = {}; // elements along each axis
};

/// Meshes a box, nodes and elements numbered with x fastest. Its faces are tagged left and right
/// (across x), bottom and top (y), back and front (z). Along a periodic axis the nodes of the upper
/// end are those of the lower one, and there are no tags.
/// @throws InputError for a size that is not positive, no elements, more nodes than 32 bits can
///         number, or, along a periodic axis, another size than the period or fewer than three
///         elements (two could not be told from their images)
template <int dim> Mesh<dim> make_box(const BoxMesh<dim>& box, const Period<dim>& period = {});

/// The nodes on the faces with a tag, ascending; all of them for "all".
/// @param key  what an error names, for example "boundary[0].tag"
/// @throws InputError for an unknown tag, with the list of tags
template <int dim>
std::vector<std::uint32_t> nodes_with_tag(const Mesh<dim>& mesh, const std::string& tag,
                                          const std::string& key);

} // namespace kerf::fem
