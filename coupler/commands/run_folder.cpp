#include "coupler/commands/run_folder.hpp"

#include "common/atomic_file.hpp"
#include "common/checkpoint.hpp"

#include <fmt/format.h>

namespace kerf::commands {

namespace fs = std::filesystem;

namespace {

/// Removes the results of an earlier run.
/// @throws ConfigError when the path is no folder, or one with other files
void clear(const fs::path& folder) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw ConfigError({"--out", 0}, fmt::format("{} is not a folder.", folder.string()),
                      "give the path of a folder, it need not exist.");
  if (!fs::exists(folder) || fs::is_empty(folder))
    return;
  if (!fs::exists(folder / "case.toml"))
    throw ConfigError({"--out", 0},
                      fmt::format("{} holds files that are not a run of kerf.", folder.string()),
                      "give an empty or a new folder.");
  for (const char* part :
       {"checkpoints", "history", "frames", "logs", "packings", "run.json", "summary.json"})
    fs::remove_all(folder / part);
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".xdmf")
      fs::remove(entry.path());
}

/// Copies the results of a run; its checkpoints stay where they are.
void copy_results(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  for (const auto& entry : fs::directory_iterator(from)) {
    const std::string name = entry.path().filename().string();
    if (name == "history" || name == "frames" || name == "packings" ||
        entry.path().extension() == ".xdmf")
      fs::copy(entry.path(), to / name, fs::copy_options::recursive);
  }
}

} // namespace

fs::path prepare_run_folder(const fs::path& out, const CaseFile& case_file) {
  const std::string name = case_file.settings().at("case").at("name");
  const fs::path folder = fs::absolute(out.empty() ? fs::path("results") / name : out);
  clear(folder);
  fs::create_directories(folder / "history");
  fs::create_directories(folder / "logs");
  write_text(folder / "case.toml", case_file.to_toml());
  return folder;
}

fs::path prepare_restart_folder(const coupler::Restart& restart, const fs::path& out,
                                const CaseFile& case_file) {
  const fs::path from = restart.folder.parent_path().parent_path();
  const fs::path folder = out.empty() ? from : fs::absolute(out);
  std::error_code none; // a folder that is not there yet is another one
  if (!fs::equivalent(from, folder, none)) {
    clear(folder);
    copy_results(from, folder);
  }
  for (const char* file : {"run.json", "summary.json"})
    fs::remove(folder / file);
  fs::create_directories(folder / "logs");
  write_text(folder / "case.toml", case_file.to_toml());
  return folder;
}

} // namespace kerf::commands
