// Energy in a part of a body, from the last frame of a run.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>

namespace kerf::commands {

/// Kinetic and elastic energy of a participant in the measure's box, J. With a reference it is the
/// energy of the difference between the two participants, matched by their reference positions:
/// what an interface sent back into a body that behaves linearly.
///
/// @param m  the measure: participant, reference, box
/// @throws std::runtime_error without a frame; std::invalid_argument for bodies that do not match
double energy_in_region(const std::filesystem::path& run_folder, const nlohmann::json& settings,
                        const nlohmann::json& m);

} // namespace kerf::commands
