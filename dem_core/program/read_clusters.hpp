// Rigid clusters from the case.
#pragma once

#include "dem_core/program/settings_node.hpp"
#include "dem_core/settings.hpp"

#include <vector>

namespace kerf::dem {

/// @param particles  how many there are
template <int dim>
std::vector<ClusterSettings<dim>> read_clusters(const Node& list, std::size_t particles);

} // namespace kerf::dem
