#include "common/config/key_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace kerf::config {

using nlohmann::json;
using std::string;

std::vector<string> KeyChecks::given(const json& table, const std::vector<string>& names) {
  std::vector<string> found;
  for (const string& name : names)
    if (!table[name].is_null())
      found.push_back(name);
  return found;
}

void KeyChecks::check_one_of(const string& key, const json& table, const string& first,
                             const string& second) {
  if (!table[first].is_null() && !table[second].is_null())
    problems_.add(key + "." + second, fmt::format("{} has both {} and {}.", key, first, second),
                  fmt::format("give {} for one value, or {} for a table of times.", first, second));
}

void KeyChecks::check_keys_of(const string& key, const json& table, const string& choice_key,
                              const string& choice,
                              const std::map<string, std::set<string>>& keys) {
  const auto own = keys.find(choice);
  const std::set<string> keys_of_choice = own == keys.end() ? std::set<string>() : own->second;
  for (const auto& [other, names] : keys)
    for (const string& name : names) {
      const string full = key + "." + name;
      if (other == choice && table[name].is_null())
        problems_.add(
            full, fmt::format("{} is missing.", full),
            fmt::format("{} = \"{}\" needs {}.", choice_key, choice, fmt::join(names, ", ")));
      if (other != choice && !keys_of_choice.contains(name) && !table[name].is_null())
        problems_.add(
            full,
            fmt::format("{} is given, but {} = \"{}\" does not use it.", full, choice_key, choice),
            fmt::format("leave it out, or give {} = \"{}\".", choice_key, other));
    }
}

void KeyChecks::check_components(const string& key, const json& components) {
  for (const json& component : components)
    if (is_plane_ && component == "z")
      problems_.add(key, key + " has \"z\", but case.dimension = 2.", "give \"x\" or \"y\".");
}

void KeyChecks::check_rotation(const string& key, const json& tool) {
  const json& rotation = tool["rotation"];
  const bool has_axis = !rotation.is_null() && !rotation["axis"].is_null();
  if (!rotation.is_null())
    check_one_of(key + ".rotation", rotation, "rate", "rates");
  if (is_plane_ && has_axis)
    problems_.add(key + ".rotation.axis",
                  key + ".rotation.axis is given, but in 2D everything turns in the plane.",
                  "leave it out; a positive rate turns x towards y.");
  const bool turns = !rotation.is_null() || !tool.value("free_rotation", json()).is_null();
  if (!is_plane_ && turns && !has_axis)
    problems_.add(key + ".rotation.axis", key + ".rotation.axis is missing.",
                  "give the direction of the axis, for example [0.0, 0.0, 1.0].");
}

void KeyChecks::check_boundary(const string& key, const json& boundary) {
  const bool of_nodes = boundary.contains("tag");
  check_components(key + ".components", boundary["components"]);
  const string motion = boundary["motion"];
  const bool has_table = !boundary["velocities"].is_null();
  std::map<string, std::set<string>> keys = {{"velocity", {has_table ? "velocities" : "velocity"}},
                                             {"hann", {"amplitude", "duration"}}};
  if (of_nodes)
    keys["displacement"] = {"displacements"};
  check_keys_of(key, boundary, "motion", motion, keys);
  if (motion == "velocity")
    check_one_of(key, boundary, "velocity", "velocities");
  if (!of_nodes)
    return check_rotation(key, boundary);
  check_place(key, boundary);
  if (motion != "symmetry")
    return;
  if (boundary["tag"].is_null())
    problems_.add(key + ".tag", key + ".tag is missing.",
                  "give the tag of faces in a plane across an axis: symmetry holds their normal.");
  if (!boundary["components"].is_null())
    problems_.add(key + ".components",
                  key + ".components is given, but motion = \"symmetry\" holds the normal.",
                  "leave it out, or give motion = \"fixed\".");
}

void KeyChecks::check_place(const string& key, const json& table) {
  if (table["tag"].is_null() == table["box"].is_null())
    problems_.add(key,
                  fmt::format("{} has {} tag {} box.", key,
                              table["tag"].is_null() ? "neither" : "both",
                              table["tag"].is_null() ? "nor" : "and"),
                  "give the tag of a boundary, or a box around points.");
}

void KeyChecks::check_stress(const string& key, const json& stress, const string& order,
                             const json& gravity) {
  const bool is_uniform = !stress["stress"].is_null();
  if (is_uniform != stress["K0"].is_null())
    problems_.add(key, key + " needs either stress or K0.", "give one of them.");
  if (is_uniform && stress["stress"].size() != (order.size() + 1) / 3)
    problems_.add(key + ".stress",
                  fmt::format("{}.stress has {} numbers, but case.dimension = {}.", key,
                              stress["stress"].size(), is_plane_ ? 2 : 3),
                  "give " + order + ".");
  if (!stress["K0"].is_null() && stress["surface"].is_null())
    problems_.add(key + ".surface", key + ".surface is missing.",
                  "give the height of the ground, where depth is zero.");
  if (!stress["K0"].is_null() && gravity.is_null())
    problems_.add(key + ".K0", key + ".K0 is given, but there is no gravity.",
                  "give gravity, or stress instead of K0.");
}

void KeyChecks::check_name(const string& key, const string& name, const string& list,
                           std::set<string>& names) {
  if (!names.insert(name).second)
    problems_.add(key + ".name", fmt::format("two {} are named \"{}\".", list, name),
                  "give each one a name of its own.");
}

} // namespace kerf::config
