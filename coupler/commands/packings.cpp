#include "coupler/commands/packings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace kerf::commands {
namespace {

using nlohmann::json;
using std::string;

/// All numbers of a value, with all digits.
string numbers(const json& value) {
  if (!value.is_array())
    return fmt::format("{}", value.get<double>());
  std::vector<string> words;
  for (const json& member : value)
    words.push_back(numbers(member));
  return fmt::format("{}", fmt::join(words, ","));
}

string region_word(const json& region, std::size_t dimension) {
  if (!region["box"].is_null())
    return "box:" + numbers(region["box"]);
  if (!region["surface"].is_null())
    return "surface:" + region["surface"].get<string>();
  if (!region["center"].is_null())
    return fmt::format("{}:{},{}", dimension == 2 ? "disc" : "sphere", numbers(region["center"]),
                       numbers(region["radius"]));
  return fmt::format("cylinder:{},{},{}", numbers(region["bottom"]), numbers(region["top"]),
                     numbers(region["radius"]));
}

string radii_word(const json& radii) {
  const string law = radii["law"];
  if (law == "uniform")
    return fmt::format("uniform:{},{}", numbers(radii["min"]), numbers(radii["max"]));
  if (law == "power")
    return fmt::format("power:{},{},{}", numbers(radii["min"]), numbers(radii["max"]),
                       numbers(radii["exponent"]));
  std::vector<string> words;
  for (std::size_t k = 0; k < radii["values"].size(); ++k)
    words.push_back(numbers(radii["values"][k]) +
                    (radii["weights"].is_null() ? "" : "*" + numbers(radii["weights"][k])));
  return fmt::format("list:{}", fmt::join(words, ","));
}

/// Axes along which the box is the period of the case; there it has no walls.
string periodic_axes(const json& box, const json& case_table) {
  string axes;
  for (std::size_t a = 0; !box.is_null() && a < box[0].size(); ++a) {
    const json& period = case_table["periodic"][string(1, "xyz"[a])];
    if (!period.is_null() && period[0] == box[0][a] && period[1] == box[1][a])
      axes += "xyz"[a];
  }
  return axes;
}

/// The command line that makes a packing.
std::vector<string> command(const json& packing, const json& case_table,
                            const std::filesystem::path& file) {
  const auto dimension = case_table["dimension"].get<std::size_t>();
  const json& seed = packing["seed"].is_null() ? case_table["seed"] : packing["seed"];
  const auto programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::vector<string> words = {(programs / "kerf-dem").string(),
                               "pack",
                               "--region",
                               region_word(packing["region"], dimension),
                               "--radii",
                               radii_word(packing["radii"]),
                               "--porosity",
                               numbers(packing["porosity"]),
                               "--seed",
                               seed.dump(),
                               "--cache",
                               "--out",
                               file.string()};
  if (!packing["count"].is_null())
    words.insert(words.end(), {"--count", packing["count"].dump()});
  if (const string axes = periodic_axes(packing["region"]["box"], case_table); !axes.empty())
    words.insert(words.end(), {"--periodic", axes});
  if (!packing["cut"].is_null())
    words.insert(words.end(), {"--cut", region_word(packing["cut"], dimension)});
  return words;
}

/// Waits for the program, its output in the log. @return whether it ended with exit code 0
bool run(std::vector<string> words, const std::filesystem::path& log) {
  std::vector<char*> arguments;
  for (string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  setenv("OMP_WAIT_POLICY", "passive", 0); // its parallel regions are too short to spin between
  pid_t pid = 0;
  const int error = posix_spawn(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw std::system_error(error, std::generic_category(), "cannot start " + words[0]);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// The last line of the log, which says what was wrong.
string complaint(const std::filesystem::path& log) {
  std::ifstream file(log);
  string line, last;
  while (std::getline(file, line))
    if (!line.empty())
      last = line;
  const string speaker = "kerf pack: ";
  return last.starts_with(speaker) ? last.substr(speaker.size()) : last;
}

} // namespace

json with_packings(const CaseFile& case_file, const std::filesystem::path& run_folder) {
  json settings = case_file.settings();
  for (auto& [name, participant] : settings["participants"].items()) {
    json& particles = participant["particles"];
    if (particles.is_null() || particles["packing"].is_null())
      continue;
    const auto file = run_folder / "packings" / (name + ".txt");
    const auto log = run_folder / "logs" / (name + "_packing.log");
    if (!run(command(particles["packing"], settings["case"], file), log))
      throw case_file.error(
          "participants." + name + ".particles.packing",
          fmt::format("the packing of {} cannot be made: {}", name, complaint(log)),
          "change its region, its radii or their number.");
    particles["file"] = file.string();
    particles["packing"] = nullptr;
  }
  return settings;
}

} // namespace kerf::commands
