#include "coupler/commands/packings.hpp"

#include "coupler/commands/pack_program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

/// The arguments that make a packing.
std::vector<string> arguments(const json& packing, const json& case_table,
                              const std::filesystem::path& file) {
  const auto dimension = case_table["dimension"].get<std::size_t>();
  const json& seed = packing["seed"].is_null() ? case_table["seed"] : packing["seed"];
  std::vector<string> words = {"--region",   region_word(packing["region"], dimension),
                               "--radii",    radii_word(packing["radii"]),
                               "--porosity", numbers(packing["porosity"]),
                               "--seed",     seed.dump(),
                               "--cache",    "--out",
                               file.string()};
  if (!packing["count"].is_null())
    words.insert(words.end(), {"--count", packing["count"].dump()});
  if (const string axes = periodic_axes(packing["region"]["box"], case_table); !axes.empty())
    words.insert(words.end(), {"--periodic", axes});
  if (!packing["cut"].is_null())
    words.insert(words.end(), {"--cut", region_word(packing["cut"], dimension)});
  return words;
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
    if (const auto complaint =
            run_pack(arguments(particles["packing"], settings["case"], file), log))
      throw case_file.error("participants." + name + ".particles.packing",
                            fmt::format("the packing of {} cannot be made: {}", name, *complaint),
                            "change its region, its radii or their number.");
    particles["file"] = file.string();
    particles["packing"] = nullptr;
  }
  return settings;
}

} // namespace kerf::commands
