// What `run` and `check` have in common: a case, its participants as processes, and how a run that
// fails is told to the user.
#pragma once

#include "common/config/case_file.hpp"
#include "coupler/broker/broker.hpp"
#include "coupler/commands/commands.hpp"

#include <functional>
#include <optional>

namespace kerf::commands {

/// Runs a case with participants as child processes.
/// @return what run.json keeps
/// @throws as Broker::run()
nlohmann::json run_processes(const CaseFile& case_file, const std::filesystem::path& run_folder,
                             bool plan_only, decltype(coupler::RunSetup::progress) progress,
                             std::optional<coupler::Restart> restart = std::nullopt);

/// Reads the case and does something with it; turns exceptions into one sentence on stderr and an
/// exit code.
int with_case(const RunOptions& options, const std::function<int(const CaseFile&)>& body);

} // namespace kerf::commands
