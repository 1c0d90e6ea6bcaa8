// What can be wrong with stages and stop conditions beyond the types of their values.
#include "common/config/case_reader.hpp"
#include "common/config/key_checks.hpp"
#include "common/config/value_types.hpp"
#include "common/nearest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace kerf::config {
namespace {

using nlohmann::json;
using std::string;

class StageChecks : private KeyChecks {
public:
  StageChecks(const json& settings, Problems& problems)
      : KeyChecks(settings, problems), settings_(settings) {}

  void run() {
    const json& stages = settings_["stages"];
    if (settings_["case"]["end_time"].is_null() && stages.empty())
      problems_.add("case.end_time", "case.end_time is missing.",
                    "give the time at which the run ends, for example 4e-5, or stages.");
    check_conditions("case.stop", settings_["case"]["stop"]);
    for (std::size_t k = 0; k < settings_["measures"].size(); ++k)
      if (settings_["measures"][k]["name"] == "end")
        problems_.add(fmt::format("measures[{}].name", k), "a measure is named \"end\".",
                      "give it another name: this one is that of the end of the run.");
    std::set<string> names;
    for (std::size_t s = 0; s < stages.size(); ++s) {
      const string key = fmt::format("stages[{}]", s);
      if (!names.insert(stages[s]["name"]).second)
        problems_.add(key + ".name",
                      fmt::format("two stages are named {}.", shown(stages[s]["name"])),
                      "give each one a name of its own.");
      check_conditions(key + ".stop", stages[s]["stop"]);
      for (std::size_t k = 0; k < stages[s]["changes"].size(); ++k)
        check_change(fmt::format("{}.changes[{}]", key, k), stages[s]["changes"][k]);
    }
  }

private:
  /// The participant that a table names, or the only one; null when there is none to look at.
  const json* participant_of(const string& key, const json& table) {
    const json& participants = settings_["participants"];
    const json& name = table["participant"];
    std::vector<string> names;
    for (const auto& [other, participant] : participants.items())
      names.push_back(other);
    if (name.is_null()) {
      if (names.size() == 1)
        return &participants[names.front()];
      problems_.add(key, fmt::format("{}.participant is missing.", key),
                    fmt::format("name one of {}.", fmt::join(names, ", ")));
      return nullptr;
    }
    if (participants.contains(name.get<string>()))
      return &participants[name.get<string>()];
    const string meant = nearest(name.get<string>(), names);
    problems_.add(key + ".participant",
                  fmt::format("{}.participant = {} is not a participant.", key, shown(name)),
                  meant.empty() ? fmt::format("name one of {}.", fmt::join(names, ", "))
                                : "did you mean " + meant + "?");
    return nullptr;
  }

  void check_conditions(const string& list, const json& conditions) {
    for (std::size_t k = 0; k < conditions.size(); ++k) {
      const string key = fmt::format("{}[{}]", list, k);
      const json& condition = conditions[k];
      if (!names_.insert(condition["name"]).second)
        problems_.add(key + ".name",
                      fmt::format("two conditions are named {}.", shown(condition["name"])),
                      "give each one a name of its own.");
      if (condition["above"].is_null() == condition["below"].is_null())
        problems_.add(key,
                      fmt::format("{} has {} bound.", key,
                                  condition["above"].is_null() ? "no" : "more than one"),
                      "give above or below.");
      if (const json* participant = participant_of(key, condition))
        check_quantity(key, condition, *participant);
    }
  }

  void check_quantity(const string& key, const json& condition, const json& participant) {
    const string quantity = condition["quantity"];
    const bool of_elements = participant["kind"] == "fem";
    const std::vector<string> known = {"unbalanced_force", "kinetic_ratio", "stress",
                                       "displacement", "force"};
    if (of_elements && std::find(known.begin(), known.end(), quantity) == known.end()) {
      problems_.add(key + ".quantity",
                    fmt::format("{}.quantity = \"{}\" is not one of elements.", key, quantity),
                    fmt::format("give one of {}.", fmt::join(known, ", ")));
      return;
    }
    const bool of_pair = quantity == "strain" || quantity == "stress";
    const bool of_motion = quantity == "displacement", of_force = quantity == "force";
    check_named(key, condition, "probe", of_pair || (of_elements && of_motion), participant);
    check_named(key, condition, "tool", !of_elements && (of_motion || of_force), participant);
    check_named(key, condition, "wall", of_elements && of_force, participant);
    check_component(key, condition, of_pair, of_motion || of_force, of_elements);
  }

  /// A probe, a tool or a wall is named where the quantity has one, and it is there.
  void check_named(const string& key, const json& condition, const char* what, bool is_needed,
                   const json& participant) {
    const json& name = condition[what];
    if (is_needed == name.is_null())
      problems_.add(
          fmt::format("{}.{}", key, what),
          fmt::format("{}.{} is {}.", key, what, is_needed ? "missing" : "given"),
          fmt::format("quantity = {} {}.", shown(condition["quantity"]),
                      is_needed ? fmt::format("needs the name of a {}", what) : "does not use it"));
    if (is_needed && !name.is_null())
      check_member(fmt::format("{}.{}", key, what), name, what,
                   participant[fmt::format("{}s", what)]);
  }

  void check_member(const string& key, const json& name, const char* what, const json& list) {
    std::vector<string> names;
    for (const json& member : list)
      names.push_back(member["name"]);
    if (std::find(names.begin(), names.end(), name.get<string>()) != names.end())
      return;
    const string meant = nearest(name.get<string>(), names);
    problems_.add(key,
                  fmt::format("{} = {} is not a {} of the participant.", key, shown(name), what),
                  names.empty()   ? fmt::format("the participant has no {}s.", what)
                  : meant.empty() ? fmt::format("name one of {}.", fmt::join(names, ", "))
                                  : "did you mean " + meant + "?");
  }

  void check_component(const string& key, const json& condition, bool of_pair, bool of_axis,
                       bool of_elements) {
    using Words = std::vector<string>;
    Words allowed;
    if (of_pair)
      allowed = !is_plane_    ? Words{"xx", "yy", "zz", "yz", "xz", "xy"}
                : of_elements ? Words{"xx", "yy", "zz", "xy"}
                              : Words{"xx", "yy", "xy"};
    if (of_axis)
      allowed = is_plane_ ? Words{"x", "y"} : Words{"x", "y", "z"};
    const json& component = condition["component"];
    if (allowed.empty() && !component.is_null())
      problems_.add(key + ".component", key + ".component is given.",
                    fmt::format("quantity = {} does not use it.", shown(condition["quantity"])));
    else if (!allowed.empty() &&
             (component.is_null() ||
              std::find(allowed.begin(), allowed.end(), component.get<string>()) == allowed.end()))
      problems_.add(key + ".component",
                    component.is_null()
                        ? key + ".component is missing."
                        : fmt::format("{}.component = {} is none of quantity = {}.", key,
                                      shown(component), shown(condition["quantity"])),
                    fmt::format("give one of {}.", fmt::join(allowed, ", ")));
  }

  static bool has_springs(const json& participant) {
    json all = participant["materials"];
    all.push_back(participant["material"]);
    return std::any_of(all.begin(), all.end(), [](const json& material) {
      return !material["normal_stiffness"].is_null() || !material["contact_modulus"].is_null();
    });
  }

  void check_change(const string& key, const json& change) {
    const json* participant = participant_of(key, change);
    if (participant == nullptr)
      return;
    for (std::size_t k = 0; k < change["boundary"].size(); ++k)
      check_boundary(fmt::format("{}.boundary[{}]", key, k), change["boundary"][k]);
    if ((*participant)["kind"] == "fem") {
      check_node_loads(key + ".loads", change["loads"], settings_, problems_);
      return;
    }
    if (!change["bond_gap"].is_null() && !has_springs(*participant))
      problems_.add(key + ".bond_gap",
                    key + ".bond_gap is given, but its materials have no springs for bonds.",
                    "leave it out, or give a material normal_stiffness and tangential_stiffness.");
    for (std::size_t k = 0; k < change["tools"].size(); ++k)
      check_member(fmt::format("{}.tools[{}].name", key, k), change["tools"][k]["name"], "tool",
                   (*participant)["tools"]);
  }

  const json& settings_;
  std::set<string> names_; // of all conditions: the summary tells them apart by it
};

} // namespace

void check_stages(const json& settings, Problems& problems) {
  StageChecks(settings, problems).run();
}

} // namespace kerf::config
