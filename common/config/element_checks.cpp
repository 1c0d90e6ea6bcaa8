// What can be wrong with what acts on a body of elements, and with its probes.
#include "common/config/case_reader.hpp"
#include "common/config/key_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace kerf::config {
namespace {

using nlohmann::json;
using std::string;

class ElementChecks : private KeyChecks {
public:
  ElementChecks(const json& settings, Problems& problems)
      : KeyChecks(settings, problems), settings_(settings) {}

  void run(const string& key, const json& participant) {
    check_loads(key + ".loads", participant["loads"]);
    for (std::size_t k = 0; k < participant["absorbing"].size(); ++k)
      check_wave(fmt::format("{}.absorbing[{}].wave", key, k), participant["absorbing"][k]["wave"]);
    for (std::size_t k = 0; k < participant["walls"].size(); ++k)
      check_one_of(fmt::format("{}.walls[{}]", key, k), participant["walls"][k], "velocity",
                   "velocities");
    if (!participant["in_situ_stress"].is_null())
      check_in_situ_stress(key, participant);
  }

  void check_loads(const string& list, const json& loads) {
    const std::vector<string> values = {"force",     "forces",   "traction",
                                        "tractions", "pressure", "pressures"};
    for (std::size_t k = 0; k < loads.size(); ++k) {
      const string key = fmt::format("{}[{}]", list, k);
      check_place(key, loads[k]);
      const std::vector<string> found = given(loads[k], values);
      if (found.size() != 1)
        problems_.add(key,
                      fmt::format("{} has {}.", key,
                                  found.empty() ? "neither a force nor a traction nor a pressure"
                                                : fmt::format("{}", fmt::join(found, " and "))),
                      fmt::format("give one of {}: the last of each two is a table of times.",
                                  fmt::join(values, ", ")));
      else if (!found[0].starts_with("force") && loads[k]["tag"].is_null())
        problems_.add(key + ".tag",
                      fmt::format("{}.tag is missing, which {} needs.", key, found[0]),
                      "give the tag of faces.");
    }
  }

private:
  void check_wave(const string& key, const json& wave) {
    if (wave.is_null())
      return;
    check_one_of(key, wave, "velocity", "velocities");
    if (wave["velocity"].is_null() && wave["velocities"].is_null())
      problems_.add(key, key + " has neither velocity nor velocities.",
                    "give the velocity and the duration of a pulse, or a table of velocities.");
    if (wave["velocity"].is_null() != wave["duration"].is_null())
      problems_.add(key + ".duration",
                    fmt::format("{}.duration is {}.", key,
                                wave["duration"].is_null() ? "missing" : "given without velocity"),
                    "give velocity and duration of a pulse, or only velocities.");
  }

  /// Laws that store a stress can begin with one; plane stress has none across the plane.
  void check_in_situ_stress(const string& participant, const json& table) {
    const string key = participant + ".in_situ_stress";
    const json& stress = table["in_situ_stress"];
    check_stress(key, stress, is_plane_ ? "xx yy zz xy" : "xx yy zz yz xz xy", table["gravity"]);
    const json& g = table["gravity"];
    if (!stress["K0"].is_null() && !g.is_null() &&
        std::ranges::count_if(g, [](const json& c) { return c != 0.0; }) != 1)
      problems_.add(
          participant + ".gravity",
          fmt::format("{}.gravity is not along an axis, but {}.K0 is given.", participant, key),
          "give gravity along an axis, or stress instead of K0.");
    const bool has_zz =
        !stress["K0"].is_null() ||
        (!stress["stress"].is_null() && stress["stress"].size() > 2 && stress["stress"][2] != 0.0);
    if (table["plane"] == "stress" && has_zz)
      problems_.add(key, key + " has a component zz, but plane = \"stress\".",
                    "give stress with zz = 0, or plane = \"strain\".");
    const auto check_material = [&](const json& material) {
      if (!material.is_null() && material["model"] == "neo_hookean")
        problems_.add(key, key + " is given, but a neo_hookean material stores no stress.",
                      "leave it out, or give another model.");
    };
    check_material(table["material"]);
    for (const json& material : table["materials"])
      check_material(material);
    const string name = participant.substr(participant.rfind('.') + 1);
    for (const json& coupling : settings_["couplings"])
      for (const json& member : coupling["between"])
        if (member == name)
          problems_.add(key, key + " is given, but coupled bodies begin without stress.",
                        "leave it out, or the coupling.");
  }

  const json& settings_;
};

} // namespace

void check_elements(const string& participant, const json& settings, Problems& problems) {
  const string name = participant.substr(participant.rfind('.') + 1);
  ElementChecks(settings, problems).run(participant, settings["participants"][name]);
}

void check_node_loads(const string& list, const json& loads, const json& settings,
                      Problems& problems) {
  ElementChecks(settings, problems).check_loads(list, loads);
}

} // namespace kerf::config
