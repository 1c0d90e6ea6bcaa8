// What `run` and `check` have in common: a case, its participants as processes, and how a run that
// fails is told to the user.
#pragma once

#include "common/config/case_file.hpp"
#include "coupler/broker/broker.hpp"
#include "coupler/commands/commands.hpp"

#include <functional>

namespace kerf::commands {

/// The case of the options, with the transport written into it.
CaseFile read_case(const RunOptions& options);

/// Runs a case with participants as child processes.
/// @return what run.json keeps
/// @throws as Broker::run()
nlohmann::json run_processes(const CaseFile& case_file, const std::filesystem::path& run_folder,
                             bool plan_only, decltype(coupler::RunSetup::progress) progress);

/// Runs a command body and turns its exceptions into one sentence on stderr and an exit code.
/// @param after_interrupt  said after Ctrl-C or SIGTERM: what is left of the run
int guarded(const std::function<int()>& body, const CaseFile*& case_file);

} // namespace kerf::commands
