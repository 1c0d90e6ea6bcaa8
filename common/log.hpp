// The log of a process: lines "[12:34:56.789] name: text" through spdlog.
#pragma once

#include <filesystem>
#include <string>

namespace kerf {

struct LogSettings {
  std::string name;           // who speaks: "kerf", or the participant's name
  std::filesystem::path file; // also written here, one line at a time; empty: no file
  bool to_stderr = true;
};

/// Makes spdlog::info, warn and error write as the settings say, from now on and for the whole
/// process. Warnings and errors say so before their text.
/// @throws std::runtime_error when the file cannot be written
void start_log(const LogSettings& settings);

} // namespace kerf
