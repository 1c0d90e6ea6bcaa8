// Rigid walls and tools of a case, with the files of their surfaces.
#pragma once

#include "dem_core/program/settings_node.hpp"
#include "dem_core/settings.hpp"

#include <vector>

namespace kerf::dem {

/// @param list  the key `tools`
/// @throws coupler::SettingsError
template <int dim> std::vector<ToolSettings<dim>> read_tools(const Node& list);

/// The motion of a tool: of its table, or of one that changes it.
/// @param reference  the point at the start, m
/// @param axis       where the table gives none
template <int dim>
ToolMotion<dim> read_motion(const Node& tool, const Vec<dim>& reference, const Rot<dim>& axis);

} // namespace kerf::dem
