// Materials, who is of which, and what counts between two of them.
#pragma once

#include "dem_core/program/settings_node.hpp"
#include "dem_core/settings.hpp"

namespace kerf::dem {

/// Sets the materials and pairs of settings that have their particles.
/// @param participant  the whole table
/// @throws coupler::SettingsError
template <int dim> void read_materials(const Node& participant, Settings<dim>& settings);

} // namespace kerf::dem
