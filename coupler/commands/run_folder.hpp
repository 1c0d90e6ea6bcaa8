// The folder that a run writes its results to.
#pragma once

#include "common/config/case_file.hpp"
#include "coupler/broker/broker.hpp"

#include <filesystem>
#include <stdexcept>

namespace kerf::commands {

/// Makes the folder ready: earlier results of kerf in it are removed, anything else is left alone.
///
/// @param out  as the user gave it; empty: results/<case name>
/// @return the full path; it has the subfolders history and logs, and case.toml
/// @throws ConfigError when the folder holds something that is not a run of kerf
std::filesystem::path prepare_run_folder(const std::filesystem::path& out,
                                         const CaseFile& case_file);

/// Makes a folder ready to go on with the results that a checkpoint belongs to: those of its own
/// run, or copies of them where --out names another folder.
/// @throws as prepare_run_folder()
std::filesystem::path prepare_restart_folder(const coupler::Restart& restart,
                                             const std::filesystem::path& out,
                                             const CaseFile& case_file);

} // namespace kerf::commands
