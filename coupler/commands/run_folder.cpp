#include "coupler/commands/run_folder.hpp"

#include "common/atomic_file.hpp"

#include <fmt/format.h>

namespace kerf::commands {

namespace fs = std::filesystem;

fs::path prepare_run_folder(const fs::path& out, const CaseFile& case_file) {
  const std::string name = case_file.settings().at("case").at("name");
  const fs::path folder = fs::absolute(out.empty() ? fs::path("results") / name : out);
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw ConfigError({"--out", 0}, fmt::format("{} is not a folder.", folder.string()),
                      "give the path of a folder, it need not exist.");
  if (fs::exists(folder) && !fs::is_empty(folder)) {
    if (!fs::exists(folder / "case.toml"))
      throw ConfigError({"--out", 0},
                        fmt::format("{} holds files that are not a run of kerf.", folder.string()),
                        "give an empty or a new folder.");
    for (const char* part : {"history", "frames", "logs", "packings", "run.json", "summary.json"})
      fs::remove_all(folder / part);
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".xdmf")
        fs::remove(entry.path());
  }
  fs::create_directories(folder / "history");
  fs::create_directories(folder / "logs");
  write_text(folder / "case.toml", case_file.to_toml());
  return folder;
}

} // namespace kerf::commands
