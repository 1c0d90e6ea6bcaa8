// The mesh: nodes, elements, and sets of both by tag.
#pragma once

#include "common/vec.hpp"
#include "fem_core/shape.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace kerf::fem {

/// Elements of one shape.
struct Block {
  Shape shape = Shape::quad4;
  std::vector<std::uint32_t> nodes; // [size][nodes_of(shape)]

  std::size_t size() const { return nodes.size() / static_cast<std::size_t>(nodes_of(shape)); }
};

/// A side of an element.
struct Face {
  std::uint32_t element;
  std::uint8_t side; // as in side_nodes()
};

/// Nodes and elements in the reference configuration. Elements are numbered through the blocks.
template <int dim> struct Mesh {
  std::vector<double> positions;                               // [num_nodes][dim] m
  std::vector<Block> blocks;                                   // no two of one shape
  std::map<std::string, std::vector<Face>> boundary;           // faces by tag
  std::map<std::string, std::vector<std::uint32_t>> regions;   // elements by tag, ascending
  std::map<std::string, std::vector<std::uint32_t>> node_sets; // nodes by tag, ascending
  Period<dim> period; // an element across the end of the period joins both ends of the node list

  std::size_t num_nodes() const { return positions.size() / dim; }
  std::size_t num_elements() const;
  Vec<dim> position(std::size_t node) const {
    return Eigen::Map<const Vec<dim>>(positions.data() + node * dim);
  }
  Shape shape_of(std::size_t element) const;
  /// [nodes_of(shape)]
  std::span<const std::uint32_t> nodes_of_element(std::size_t element) const;
  /// Seen from outside counter-clockwise in 3D, with the body on the left in 2D.
  std::vector<std::uint32_t> nodes_of_face(const Face& face) const;
  /// Corners of an element as columns; the images of a periodic axis that lie next to the first.
  Eigen::Matrix<double, dim, Eigen::Dynamic, 0, dim, 8> corners(std::size_t element) const;
};

/// The nodes with a tag, ascending: those on faces, of a region or of a node set; all of them for
/// "all".
/// @param key  what an error names, for example "boundary[0].tag"
/// @throws InputError for an unknown tag, with the list of tags
template <int dim>
std::vector<std::uint32_t> nodes_with_tag(const Mesh<dim>& mesh, const std::string& tag,
                                          const std::string& key);

} // namespace kerf::fem
