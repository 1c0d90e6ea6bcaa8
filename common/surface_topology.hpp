// How the facets of a surface hang together: their edges and corners.
#pragma once

#include "common/surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf {

/// Lists of items, one for each of a number of owners.
struct Incidence {
  std::vector<std::uint32_t> offset; // [owners + 1]
  std::vector<std::uint32_t> item;   // those of owner i from offset[i] to offset[i + 1], ascending

  std::span<const std::uint32_t> operator[](std::size_t owner) const {
    return {item.data() + offset[owner], item.data() + offset[owner + 1]};
  }
};

/// Edges of a facet: a segment is its own edge.
template <int dim> inline constexpr int facet_edges = dim == 2 ? 1 : 3;

/// Facets with the same vertices have the same topology, wherever the vertices move.
template <int dim> struct SurfaceTopology {
  /// @pre find_fault() finds none
  explicit SurfaceTopology(const Surface<dim>& surface);

  /// Every edge has two facets that run along it in opposite directions; in 2D every corner has one
  /// that ends there and one that begins.
  bool is_closed() const;

  std::size_t num_vertices = 0;
  std::vector<Facet<dim>> facets;
  std::vector<std::array<std::uint32_t, 2>> edges; // in 3D lower vertex first; in 2D the facets
  /// Edge k of a facet runs from its vertex k to the next one.
  std::vector<std::array<std::uint32_t, facet_edges<dim>>> edges_of_facet;
  Incidence facets_of_edge;
  Incidence edges_of_vertex;
  Incidence facets_of_vertex;
};

} // namespace kerf
