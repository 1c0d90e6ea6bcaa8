// kerf run - runs a case from start to end.
#include "common/atomic_file.hpp"
#include "common/exit_code.hpp"
#include "common/log.hpp"
#include "coupler/commands/case_run.hpp"
#include "coupler/commands/measures.hpp"
#include "coupler/commands/progress.hpp"
#include "coupler/commands/restart.hpp"
#include "coupler/commands/run_folder.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

namespace kerf::commands {
namespace {

nlohmann::json machine() {
  utsname system{};
  uname(&system);
  std::string processor = "unknown", line;
  std::ifstream cpuinfo("/proc/cpuinfo");
  while (std::getline(cpuinfo, line))
    if (line.starts_with("model name"))
      processor = line.substr(line.find(':') + 2);
  return {{"system", fmt::format("{} {}", system.sysname, system.release)},
          {"processor", processor},
          {"cores", std::thread::hardware_concurrency()}};
}

/// The table of measures at the end of a run. @return true when every expectation is met
bool print_measures(const std::vector<Measure>& measures) {
  bool all_met = true;
  for (const Measure& m : measures) {
    std::string expectation, verdict;
    if (m.least)
      expectation += fmt::format(" >= {:g}", *m.least);
    if (m.most)
      expectation += fmt::format(" <= {:g}", *m.most);
    if (!expectation.empty())
      verdict = m.met() ? "pass" : "FAIL";
    fmt::print("  {:<24} {:>14.6g} {:<5} {:<4} {}\n", m.name, m.value, m.unit, verdict,
               expectation.empty() ? "" : "expected" + expectation);
    all_met = all_met && m.met();
  }
  return all_met;
}

/// When the run ended and why: the last condition, if it is met in the last step.
nlohmann::json end_of(const nlohmann::json& record) {
  const auto steps = record.at("steps").get<std::uint64_t>();
  const nlohmann::json& conditions = record.at("conditions");
  const bool is_early = !conditions.empty() && conditions.back().at("step") == steps - 1;
  return {{"value", static_cast<double>(steps) * record.at("time_step").get<double>()},
          {"unit", "s"},
          {"steps", steps},
          {"by", is_early ? conditions.back().at("name") : "time"},
          {"conditions", conditions}};
}

void print_conditions(const nlohmann::json& conditions) {
  for (const nlohmann::json& c : conditions)
    fmt::print("  {} {} ended by {} = {:.6g} at t = {:.6g} s, step {}\n",
               c.at("ends").get<std::string>(),
               c.contains("stage") ? c.at("stage").get<std::string>() : "",
               c.at("name").get<std::string>(), c.at("value").get<double>(),
               c.at("time").get<double>(), c.at("step").get<std::uint64_t>());
}

int run_case(const CaseFile& case_file, const RunOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  std::optional<coupler::Restart> restart = find_restart(options.restart, case_file);
  const std::filesystem::path folder =
      restart ? prepare_restart_folder(*restart, options.out, case_file)
              : prepare_run_folder(options.out, case_file);
  start_log({.name = "kerf", .file = folder / "logs" / "kerf.log", .to_stderr = false});

  ProgressDisplay display(isatty(STDOUT_FILENO) != 0);
  nlohmann::json record = run_processes(
      case_file, folder, false,
      [&](const std::string& name, std::uint64_t step, std::uint64_t steps) {
        display.update(name, step, steps);
      },
      std::move(restart));
  display.finish();
  const double wall_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  record["kerf"] = KERF_VERSION;
  record["machine"] = machine();
  record["seed"] = case_file.settings().at("case").at("seed");
  record["wall_time"] = wall_time;
  write_text(folder / "run.json", record.dump(2) + "\n");

  const std::vector<Measure> measures = measure(case_file, folder, wall_time);
  nlohmann::json all = summary(measures);
  const nlohmann::json& settings = case_file.settings();
  if (!settings.at("stages").empty() || !settings.at("case").at("stop").empty())
    all["end"] = end_of(record);
  write_text(folder / "summary.json", all.dump(2) + "\n");

  print_conditions(record.at("conditions"));
  const bool all_met = print_measures(measures);
  fmt::print("{} steps of {:.4g} s in {:.2f} s. Results: {}\n", record.at("steps").get<long>(),
             record.at("time_step").get<double>(), wall_time,
             std::filesystem::proximate(folder).string());
  return all_met ? exit_code::done : exit_code::check_failed;
}

} // namespace

int run(const RunOptions& options) {
  return with_case(options,
                   [&](const CaseFile& case_file) { return run_case(case_file, options); });
}

} // namespace kerf::commands
