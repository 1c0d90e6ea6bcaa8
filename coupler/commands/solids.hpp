// The solids of a case that continue a packing of particles.
#pragma once

#include "common/config/case_file.hpp"

#include <filesystem>

namespace kerf::commands {

/// Gives every material with model = "from_packing" the stiffness C11, C12 and the bulk density of
/// the bonded packing that it names, so that no solver needs to know of another one's particles: in
/// closed form for lattices, else as `kerf-dem pack --moduli` measures them.
///
/// @param settings  as with_packings() gives them
/// @return the settings with model = "linear_elastic" there
/// @throws ConfigError when the moduli are not to be had
nlohmann::json with_solids(const CaseFile& case_file, nlohmann::json settings,
                           const std::filesystem::path& run_folder);

} // namespace kerf::commands
