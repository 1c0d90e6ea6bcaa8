#include "common/surface_topology.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace kerf {

namespace {

using Entry = std::pair<std::uint32_t, std::uint32_t>; // owner, item

Incidence sorted(std::size_t owners, std::vector<Entry> entries) {
  std::sort(entries.begin(), entries.end());
  Incidence incidence;
  incidence.offset.assign(owners + 1, 0);
  for (const auto& [owner, item] : entries) {
    ++incidence.offset[owner + 1];
    incidence.item.push_back(item);
  }
  std::partial_sum(incidence.offset.begin(), incidence.offset.end(), incidence.offset.begin());
  return incidence;
}

/// Which vertices each of some cells has, turned round.
template <class Cells> Incidence cells_of(std::size_t num_vertices, const Cells& cells) {
  std::vector<Entry> entries;
  for (std::uint32_t c = 0; c < cells.size(); ++c)
    for (const std::uint32_t vertex : cells[c])
      entries.emplace_back(vertex, c);
  return sorted(num_vertices, std::move(entries));
}

} // namespace

template <int dim>
SurfaceTopology<dim>::SurfaceTopology(const Surface<dim>& surface)
    : num_vertices(surface.vertices.size()), facets(surface.facets), edges_of_facet(facets.size()) {
  if constexpr (dim == 2) {
    edges = facets;
    for (std::uint32_t f = 0; f < facets.size(); ++f)
      edges_of_facet[f] = {f};
  } else {
    const auto edge_of = [&](std::uint32_t f, std::size_t k) {
      const auto [lower, upper] = std::minmax(facets[f][k], facets[f][(k + 1) % dim]);
      return std::array{lower, upper};
    };
    for (std::uint32_t f = 0; f < facets.size(); ++f)
      for (std::size_t k = 0; k < dim; ++k)
        edges.push_back(edge_of(f, k));
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (std::uint32_t f = 0; f < facets.size(); ++f)
      for (std::size_t k = 0; k < dim; ++k)
        edges_of_facet[f][k] = static_cast<std::uint32_t>(
            std::lower_bound(edges.begin(), edges.end(), edge_of(f, k)) - edges.begin());
  }
  facets_of_edge = cells_of(edges.size(), edges_of_facet);
  edges_of_vertex = cells_of(num_vertices, edges);
  facets_of_vertex = cells_of(num_vertices, facets);
}

template <int dim> bool SurfaceTopology<dim>::is_closed() const {
  // Directions cancel at every edge, or in 2D at every corner.
  std::vector<int> balance(dim == 2 ? num_vertices : edges.size(), 0);
  for (std::size_t f = 0; f < facets.size(); ++f)
    if constexpr (dim == 2) {
      --balance[facets[f][0]];
      ++balance[facets[f][1]];
    } else {
      for (std::size_t k = 0; k < dim; ++k)
        balance[edges_of_facet[f][k]] += facets[f][k] < facets[f][(k + 1) % dim] ? 1 : -1;
    }
  const Incidence& neighbours = dim == 2 ? facets_of_vertex : facets_of_edge;
  for (std::size_t i = 0; i < balance.size(); ++i)
    if (balance[i] != 0 || neighbours[i].size() > 2)
      return false;
  return true;
}

template struct SurfaceTopology<2>;
template struct SurfaceTopology<3>;

} // namespace kerf
