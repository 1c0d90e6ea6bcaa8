// From the tables of the case, as JSON, to the settings of the engine.
#pragma once

#include "dem_core/change.hpp"
#include "dem_core/engine.hpp"
#include "dem_core/program/settings_node.hpp"
#include "dem_core/program/watch.hpp"
#include "dem_core/settings.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>

namespace kerf::dem {

/// Reads a packing file or makes a lattice, too.
/// @param table  the participant's table with every default filled in
/// @param case_table  the table [case], likewise
/// @throws coupler::SettingsError with the key inside the participant's table
template <int dim>
Settings<dim> read_settings(const nlohmann::json& table, const nlohmann::json& case_table);

/// Probes and domain of the participant's table.
template <int dim> Watch<dim> read_watch(const nlohmann::json& table);

/// Threads that the case asks for; nothing for "auto".
std::optional<int> read_threads(const nlohmann::json& table);

/// What a stage changes; the new motions of tools go on from their poses of the start.
/// @throws coupler::SettingsError
template <int dim> Change<dim> read_change(const Node& node, const Engine<dim>& engine);

} // namespace kerf::dem
