// Nodes at one place.
#pragma once

#include "fem_core/mesh.hpp"

#include <optional>
#include <utility>

namespace kerf::fem {

/// The first two nodes, by number, that are closer than the tolerance; nothing when there are none.
///
/// @param tolerance  m, > 0, less than half of the cell
/// @param cell       size of the cells that nodes are sorted into, m: the distance of other nodes
template <int dim>
std::optional<std::pair<std::uint32_t, std::uint32_t>>
coincident_nodes(const Mesh<dim>& mesh, double tolerance, double cell);

} // namespace kerf::fem
