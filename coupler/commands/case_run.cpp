#include "coupler/commands/case_run.hpp"

#include "common/exit_code.hpp"
#include "coupler/broker/process_supervisor.hpp"
#include "coupler/commands/packings.hpp"
#include "coupler/commands/restart.hpp"
#include "coupler/commands/solids.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <optional>

namespace kerf::commands {

namespace {

/// The case of the options, with the transport written into it.
CaseFile read_case(const RunOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.transport.empty())
    overrides.push_back("case.transport=" + options.transport);
  return CaseFile::read(options.case_file, overrides);
}

/// The error of a fault that a participant or the broker found, with its line in the case.
ConfigError located(const CaseFile& case_file, const coupler::RunError& error) {
  const std::string sentence = error.what();
  const auto line_break = sentence.find('\n');
  const std::string fix = line_break == std::string::npos
                              ? "see configs/reference.toml for what is allowed"
                              : sentence.substr(line_break + 1);
  return case_file.error(error.key(), error.key() + ": " + sentence.substr(0, line_break) + ".",
                         fix + ".");
}

void say(const std::string& sentence) {
  fmt::print(stderr, "{}\n", sentence);
}

/// What participants doubt of a case that can be run.
void say_warnings(const nlohmann::json& record) {
  for (const auto& [name, participant] : record.at("participants").items())
    if (const auto& summary = participant.at("summary"); summary.is_object())
      for (const auto& warning : summary.value("warnings", nlohmann::json::array()))
        say(fmt::format("warning: participants.{}: {}", name, warning.get<std::string>()));
}

} // namespace

nlohmann::json run_processes(const CaseFile& case_file, const std::filesystem::path& run_folder,
                             bool plan_only, decltype(coupler::RunSetup::progress) progress,
                             std::optional<coupler::Restart> restart) {
  const nlohmann::json settings =
      with_solids(case_file, with_packings(case_file, run_folder), run_folder);
  coupler::ProcessSupervisor supervisor(
      settings.at("participants"), std::filesystem::read_symlink("/proc/self/exe").parent_path(),
      run_folder / "logs");
  coupler::Broker broker({.settings = settings,
                          .run_folder = run_folder,
                          .plan_only = plan_only,
                          .transport = settings.at("case").at("transport"),
                          .identity = identity(case_file),
                          .version = KERF_VERSION,
                          .restart = std::move(restart),
                          .progress = std::move(progress)},
                         supervisor);
  try {
    nlohmann::json record = broker.run();
    supervisor.stop(std::chrono::seconds(5));
    say_warnings(record);
    return record;
  } catch (...) {
    supervisor.stop(std::chrono::milliseconds(300)); // they were told; who hangs is killed
    throw;
  }
}

int with_case(const RunOptions& options, const std::function<int(const CaseFile&)>& body) {
  std::optional<CaseFile> case_file;
  try {
    case_file = read_case(options);
    return body(*case_file);
  } catch (const ConfigError& error) {
    say(error.what());
    return exit_code::bad_input;
  } catch (const coupler::RunError& error) {
    if (error.kind() == coupler::ErrorKind::bad_input) {
      say(located(*case_file, error).what());
      return exit_code::bad_input;
    }
    say(fmt::format("kerf: {}.", error.what()));
    return exit_code::run_failed;
  } catch (const coupler::Interrupted& interrupted) {
    const bool by_user = interrupted.signal() == SIGINT;
    say(fmt::format("kerf: the run was ended by {} {}; its histories and frames up to then are "
                    "kept. {}.",
                    by_user ? "Ctrl-C" : "signal " + std::to_string(interrupted.signal()),
                    interrupted.what(), interrupted.checkpoint()));
    return by_user ? exit_code::interrupted : exit_code::terminated;
  } catch (const std::exception& error) {
    say(fmt::format("kerf: {}.", error.what()));
    return exit_code::run_failed;
  }
}

} // namespace kerf::commands
