// From the tables of the case, as JSON, to the settings of the engine.
#pragma once

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

} // namespace kerf::dem
