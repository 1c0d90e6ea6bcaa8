// The keys of stages, and of what ends a run or a stage before its time.
#include "common/config/schema_rows.hpp"

namespace kerf::config {
namespace {

/// Rows of a participant again, under another table.
std::vector<Key> moved(const std::vector<Key>& from, const std::string& table,
                       const std::string& to, const std::vector<std::string>& only = {}) {
  std::vector<Key> keys;
  for (const Key& key : from) {
    if (!key.path.starts_with(table))
      continue;
    const std::string rest = key.path.substr(table.size());
    bool is_wanted = only.empty() || rest.empty();
    for (const std::string& name : only)
      is_wanted = is_wanted || rest == name || rest.starts_with(name + ".");
    if (!is_wanted || (!rest.empty() && rest.front() != '.' && rest.front() != '['))
      continue;
    Key copy = key;
    copy.path = to + rest;
    if (copy.path == to && copy.type == Type::table) {
      copy.type = Type::optional_table;
      copy.standard = none;
    }
    if (copy.path == to + "[].name")
      copy.doc = "the name of the tool";
    keys.push_back(std::move(copy));
  }
  return keys;
}

} // namespace

std::vector<Key> stop_keys(const std::string& key) {
  using enum Type;
  return {
      {key, "", list, "", empty, anything, "stop condition",
       "what ends it before its time; the first that is met"},
      {key + "[].name", "", name, "", required, anything,
       key == "case.stop" ? R"("at_rest")" : R"("settled")", "a name, for the summary"},
      {key + "[].participant", "", text, "", none, anything, R"("rock")",
       "the participant whose quantity it is; the only one when not given", live},
      {key + "[].quantity", "", text, "", required,
       one_of({"unbalanced_force", "kinetic_ratio", "cracks", "strain", "stress", "displacement",
               "force"}),
       R"("unbalanced_force")",
       "what is looked at: a ratio of the body, the number of cracks, a probe, a tool, or a wall"},
      {key + "[].probe", "", text, "", none, anything, R"("middle")",
       "the probe of quantity = \"strain\" or \"stress\", of elements also of \"displacement\""},
      {key + "[].tool", "", text, "", none, anything, R"("blade")",
       "the tool of quantity = \"displacement\" or \"force\" of particles"},
      {key + "[].wall", "", text, "", none, anything, R"("anvil")",
       "the wall of quantity = \"force\" of elements"},
      {key + "[].component", "", text, "", none,
       one_of({"x", "y", "z", "xx", "yy", "zz", "yz", "xz", "xy"}), R"("x")",
       "the component: an axis of a motion or a force, a pair of axes of a strain or a stress"},
      {key + "[].above", "", number, "", none, anything, "0.0",
       "the bound that is met from above, in SI units"},
      {key + "[].below", "", number, "", none, anything, "1e-3",
       "the bound that is met from below, in SI units", live},
      {key + "[].after", "", number, "s", "0.0", in(from_zero), "1e-5",
       "how long after the beginning of the run or stage it is not looked at"},
      {key + "[].every", "", integer, "", "10", in(from_one), "10",
       "the number of steps from one look to the next"},
  };
}

std::vector<Key> stage_keys(const std::vector<Key>& particles, const std::vector<Key>& elements) {
  using enum Type;
  const std::string change = "stages[].changes[]";
  std::vector<Key> keys = {
      {"stages", "", list, "", empty, anything, "stage",
       "parts of the run in their order, each with its own duration and changes"},
      {"stages[].name", "", name, "", required, anything, R"("settle")", "a name, used once"},
      {"stages[].duration", "", number, "s", required, in(above_zero), "2e-5",
       "how long it takes, at most"},
  };
  const auto add = [&](const std::vector<Key>& more) {
    keys.insert(keys.end(), more.begin(), more.end());
  };
  add(stop_keys("stages[].stop"));
  add({
      {"stages[].changes", "", list, "", empty, anything, "change",
       "what changes at its beginning; everything else stays"},
      {change + ".participant", "", text, "", none, anything, R"("rock")",
       "the participant that it changes; the only one when not given", live},
      {change + ".gravity", "", vector, "m/s²", none, anything, "[0.0, -9.81]", "the new gravity"},
      {change + ".friction", "dem", number, "", none, in(from_zero), "0.5",
       "the new friction of contacts without a bond"},
      {change + ".bond_gap", "dem", number, "", none, in(from_zero), "1e-3",
       "the largest gap that is bonded now, over the sum of the two radii; no new bonds when not "
       "given"},
      {change + ".release", "", flag, "", "false", anything, "false",
       "whether all prescribed motions end; a boundary given here does so, too"},
      {change + ".unload", "fem", flag, "", "false", anything, "false",
       "whether all loads end; a load given here does so, too"},
      {change + ".remove", "fem", texts, "", none, anything, R"(["excavation"])",
       "regions of the mesh whose elements are taken out"},
      {change + ".reset_displacement", "fem", flag, "", "false", anything, "false",
       "whether displacements of supports and probes count from here"},
  });
  add(moved(particles, "participants.*.damping", change + ".damping"));
  add(moved(particles, "participants.*.boundary", change + ".boundary"));
  add(moved(particles, "participants.*.tools", change + ".tools",
            {"[].name", "[].velocity", "[].velocities", "[].rotation", "[].servo", "[].free",
             "[].free_rotation"}));
  add(moved(elements, "participants.*.damping", change + ".damping"));
  add(moved(elements, "participants.*.boundary", change + ".boundary"));
  add(moved(elements, "participants.*.loads", change + ".loads"));
  return keys;
}

} // namespace kerf::config
