// Particles that a table of the case names.
#pragma once

#include "dem_core/program/settings_node.hpp"

#include <cstdint>
#include <map>
#include <vector>

namespace kerf::dem {

/// @throws coupler::SettingsError when one is not a whole number from 0
std::vector<std::uint32_t> read_ids(const Node& node);

/// The particles of each number in the last column of a file, by ascending numbers; those of a
/// negative one are left out.
/// @param particles  how many there are
std::map<double, std::vector<std::uint32_t>> read_groups(const Node& node, std::size_t particles);

} // namespace kerf::dem
