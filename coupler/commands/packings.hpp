// The random packings of a case, made before its participants start.
#pragma once

#include "common/config/case_file.hpp"

#include <filesystem>

namespace kerf::commands {

/// Makes each packing of a case with `kerf-dem pack`, or takes it from the cache.
/// @return the settings with particles.file = <run folder>/packings/<participant>.txt instead of
///         particles.packing, so that no solver needs a generator
/// @throws ConfigError when a packing cannot be made
nlohmann::json with_packings(const CaseFile& case_file, const std::filesystem::path& run_folder);

} // namespace kerf::commands
