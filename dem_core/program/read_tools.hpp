// Rigid walls and tools of a case, with the files of their surfaces.
#pragma once

#include "dem_core/program/settings_node.hpp"
#include "dem_core/settings.hpp"

#include <vector>

namespace kerf::dem {

/// @param list  the key `tools`
/// @throws coupler::SettingsError
template <int dim> std::vector<ToolSettings<dim>> read_tools(const Node& list);

} // namespace kerf::dem
