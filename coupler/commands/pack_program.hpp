// `kerf-dem pack`, started for a case.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kerf::commands {

/// Waits for the program, with its output in the log.
/// @return what was wrong; nothing when it ended with exit code 0
/// @throws std::system_error when it cannot be started
std::optional<std::string> run_pack(const std::vector<std::string>& arguments,
                                    const std::filesystem::path& log);

} // namespace kerf::commands
