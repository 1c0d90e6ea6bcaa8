// kerf check - everything of a run but its steps: files, geometry, time step, plan.
#include "common/exit_code.hpp"
#include "common/log.hpp"
#include "coupler/commands/case_run.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace kerf::commands {
namespace {

/// A folder that is gone when the check is over.
class TemporaryFolder {
public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "kerf-check-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw std::runtime_error("cannot make a temporary folder");
    path_ = pattern;
    std::filesystem::create_directories(path_ / "logs");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

void print_plan(const nlohmann::json& record, const nlohmann::json& settings) {
  for (const auto& [name, p] : record.at("participants").items()) {
    const bool particles = p.at("kind") == "dem";
    // The broker knows the elements of meshes of one shape only; participants count theirs.
    const nlohmann::json::json_pointer counted("/summary/elements");
    const long elements = p.value("elements", p.value(counted, 0L));
    fmt::print("  {:<12} {}: {} {}{}, about {:.1f} MB\n", name, p.at("program").get<std::string>(),
               p.at("points").get<long>(), particles ? "particles" : "nodes",
               particles ? "" : fmt::format(", {} elements", elements),
               p.at("memory_estimate").get<double>() / 1e6);
  }
  for (const auto& [name, c] : record.at("couplings").items())
    fmt::print("  {:<12} couples {} particles with {} nodes\n", name, c.at("particles").get<long>(),
               c.at("nodes").get<long>());
  fmt::print("  time step    {:.6g} s, {:.3g} of the critical {:.6g} s that {} sets; {} steps\n",
             record.at("time_step").get<double>(),
             record.at("time_step").get<double>() / record.at("critical_time_step").get<double>(),
             record.at("critical_time_step").get<double>(),
             record.at("limited_by").get<std::string>(), record.at("steps").get<long>());
  fmt::print("  transport    {}\n", record.at("transport").get<std::string>());
  for (const nlohmann::json& m : settings.at("measures"))
    fmt::print("  measures     {}\n", m.at("name").get<std::string>());
}

} // namespace

int check(const RunOptions& options) {
  return with_case(options, [&](const CaseFile& case_file) {
    const TemporaryFolder folder;
    start_log({.name = "kerf", .file = folder.path() / "logs" / "kerf.log", .to_stderr = false});
    const nlohmann::json record = run_processes(case_file, folder.path(), true, {});
    fmt::print("{} can be run:\n", options.case_file.string());
    print_plan(record, case_file.settings());
    return static_cast<int>(exit_code::done);
  });
}

} // namespace kerf::commands
