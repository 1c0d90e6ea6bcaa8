#include "coupler/commands/restart.hpp"

#include "common/checkpoint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <regex>

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

ConfigError fault(const std::string& problem, const std::string& fix) {
  return {{"--restart", 0}, problem, fix};
}

/// Keys that do not change what the steps compute and how far apart results are.
bool may_differ(const std::string& key) {
  static const std::regex free(
      R"(case\.(end_time|transport|hang_limit|handshake_limit|output\.(keep_)?checkpoints))"
      R"(|participants\.[^.]*\.threads|measures.*)");
  return std::regex_match(key, free);
}

/// "/couplings/0/width" as couplings[0].width.
std::string key_of(const std::string& pointer) {
  static const std::regex index(R"(\.(\d+)(?=\.|$))");
  std::string key = pointer.substr(1);
  std::replace(key.begin(), key.end(), '/', '.');
  return std::regex_replace(key, index, "[$1]");
}

/// "case.seed = 2, it was 1" of every key that matters.
std::vector<std::string> differences(const json& now, const json& before) {
  const json a = now.flatten(), b = before.flatten();
  std::vector<std::string> found;
  const auto text = [](const json& flat, const std::string& pointer) {
    return flat.contains(pointer) ? flat.at(pointer).dump() : "not there";
  };
  json pointers = a;
  pointers.update(b);
  for (const auto& [pointer, value] : pointers.items())
    if (text(a, pointer) != text(b, pointer) && !may_differ(key_of(pointer)))
      found.push_back(
          fmt::format("{} is {} and was {}", key_of(pointer), text(a, pointer), text(b, pointer)));
  return found;
}

/// @return the folder of the run, and the step if one is named
std::pair<fs::path, std::optional<std::uint64_t>> parts_of(const std::string& option) {
  const std::size_t at = option.rfind('@');
  std::uint64_t step = 0;
  if (at == std::string::npos || fs::is_directory(option))
    return {option, std::nullopt};
  const char* end = option.data() + option.size();
  const auto result = std::from_chars(option.data() + at + 1, end, step);
  if (result.ec != std::errc() || result.ptr != end)
    throw fault(fmt::format("\"{}\" is not the number of a step.", option.substr(at + 1)),
                "give DIR for the last checkpoint, or DIR@STEP.");
  return {option.substr(0, at), step};
}

/// @throws ConfigError when the record cannot be used with this program and case
json read_record(const fs::path& file, const CaseFile& case_file) {
  std::ifstream stream(file);
  json record = json::parse(stream, nullptr, false);
  const json wanted = identity(case_file);
  for (const char* key : {"kerf", "settings", "step", "time_step", "steps", "history_every",
                          "last_step", "stage_ends", "conditions", "frame_every"})
    if (!record.is_object() || !record.contains(key))
      throw fault(fmt::format("{} is truncated or no record of a checkpoint.", file.string()),
                  "go on from another checkpoint, with --restart DIR@STEP.");
  if (record.at("kerf") != wanted.at("kerf"))
    throw fault(fmt::format("the checkpoint was written by kerf {}, and this is {}.",
                            record.at("kerf").dump(), wanted.at("kerf").dump()),
                "use the same version, or begin the run again.");
  std::vector<std::string> found = differences(wanted.at("settings"), record.at("settings"));
  if (found.empty())
    return record;
  const std::size_t count = found.size();
  found.resize(std::min<std::size_t>(count, 5));
  throw fault(
      fmt::format("the checkpoint is of another case: {}{}.", fmt::join(found, "; "),
                  count > 5 ? fmt::format("; and {} more", count - 5) : ""),
      "go on with the case as it was; its end, threads, transport, checkpoints and measures may "
      "change.");
}

} // namespace

json identity(const CaseFile& case_file) {
  return {{"kerf", KERF_VERSION}, {"settings", case_file.settings()}};
}

std::optional<coupler::Restart> find_restart(const std::string& option, const CaseFile& case_file) {
  if (option.empty())
    return std::nullopt;
  const auto [folder, wanted] = parts_of(option);
  const std::vector<std::uint64_t> steps = list_checkpoints(folder);
  if (steps.empty())
    throw fault(fmt::format("{} has no checkpoints.", folder.string()),
                "name the folder of a run that wrote some: see case.output.checkpoints.");
  const std::uint64_t step = wanted.value_or(steps.back());
  if (std::find(steps.begin(), steps.end(), step) == steps.end())
    throw fault(fmt::format("{} has no checkpoint of step {}.", folder.string(), step),
                fmt::format("there are those of {}.", fmt::join(steps, ", ")));
  const fs::path place = checkpoint_folder(fs::absolute(folder).lexically_normal(), step);
  return coupler::Restart{place, read_record(place / "checkpoint.json", case_file)};
}

} // namespace kerf::commands
