#include "common/config/case_reader.hpp"
#include "common/config/key_checks.hpp"

#include "common/config/schema.hpp"
#include "common/nearest.hpp"

#include <fmt/format.h>

#include <set>

namespace kerf::config {
namespace {

using nlohmann::json;
using std::string;

class Checks : private KeyChecks {
public:
  Checks(json& settings, const Document& document, Problems& problems)
      : KeyChecks(settings, problems), settings_(settings), document_(document) {
    for (const auto& [name, participant] : settings["participants"].items())
      participants_.push_back(name);
    for (const json& coupling : settings["couplings"])
      couplings_.push_back(coupling["name"]);
  }

  void run() {
    if (is_plane_ && !settings_["case"]["periodic"]["z"].is_null())
      problems_.add("case.periodic.z", "case.periodic.z is given, but case.dimension = 2.",
                    "leave it out, or give dimension = 3.");
    for (auto& [name, participant] : settings_["participants"].items())
      check_participant("participants." + name, participant);
    check_couplings();
    check_measures();
  }

private:
  void check_participant(const string& key, json& participant) {
    if (!participant["command"].is_null()) {
      if (document_.places.contains(key + ".solver"))
        problems_.add(key + ".command", key + " has both solver and command.",
                      "give the name of a solver, or the command line of your own.");
      participant["solver"] = nullptr;
    }
    if (participant["kind"] == "dem") {
      check_particles(key + ".particles", participant["particles"]);
      check_bonds(key + ".bonds", participant["bonds"]);
      check_material(key + ".material", participant["material"], participant["materials"]);
      for (std::size_t k = 0; k < participant["materials"].size(); ++k)
        check_material(fmt::format("{}.materials[{}]", key, k), participant["materials"][k],
                       participant["materials"]);
      check_materials(key, participant, problems_);
      check_series(key, participant, {"probes"}, {"cracks", "boundary", "loads", "clusters"});
      check_tools(key, participant["tools"]);
      check_loads(key + ".loads", participant["loads"]);
      check_clusters(key + ".clusters", participant["clusters"]);
      if (!participant["in_situ_stress"].is_null())
        check_in_situ_stress(key, participant);
    } else {
      check_mesh(key + ".mesh", participant["mesh"], settings_["case"], problems_);
      check_solids(key, settings_, problems_);
      check_elements(key, settings_, problems_);
      check_series(key, participant, {"probes", "walls"}, {"boundary", "loads"});
    }
    if (!participant["mass_scaling"].is_null())
      check_mass_scaling(key, participant);
    for (std::size_t k = 0; k < participant["boundary"].size(); ++k)
      check_boundary(fmt::format("{}.boundary[{}]", key, k), participant["boundary"][k]);
    for (std::size_t k = 0; k < participant["initial"].size(); ++k)
      check_initial(fmt::format("{}.initial[{}]", key, k), participant["initial"][k]);
  }

  /// Springs of Hertzian particles are those of their bonds; moduli of others are for their pairs.
  void check_material(const string& key, const json& material, const json& others) {
    std::map<string, std::set<string>> keys = {
        {"linear", {"normal_stiffness", "tangential_stiffness"}},
        {"linear_by_size", {"contact_modulus", "stiffness_ratio"}},
        {"hertz_mindlin", {"young_modulus", "poisson_ratio"}}};
    if (material["law"] == "hertz_mindlin")
      keys = {*keys.find("hertz_mindlin")};
    else if (!others.empty())
      keys.erase("hertz_mindlin");
    check_keys_of(key, material, "law", material["law"], keys);
  }

  void check_particles(const string& key, const json& particles) {
    const json& lattice = particles["lattice"];
    const std::vector<string> sources = given(particles, {"lattice", "file", "packing"});
    if (sources.size() != 1)
      problems_.add(key,
                    fmt::format("{} has {}.", key,
                                sources.empty() ? "neither lattice nor file nor packing"
                                                : fmt::format("{}", fmt::join(sources, " and "))),
                    fmt::format("give one: a table [{}.lattice], a table [{}.packing], or file = "
                                "\"packing.txt\".",
                                key, key));
    else if (lattice.is_null() && !particles["radius"].is_null())
      problems_.add(key + ".radius",
                    fmt::format("{}.radius is given, but the {} has the radii.", key, sources[0]),
                    "leave radius out.");
    if (!particles["packing"].is_null())
      check_packing(key + ".packing", particles["packing"]);
    if (lattice.is_null())
      return;
    const string type = lattice["type"];
    const bool in_plane = type == "triangular" || type == "square";
    if (type != "chain" && in_plane != is_plane_)
      problems_.add(key + ".lattice.type",
                    fmt::format("{}.lattice.type = \"{}\" is not of case.dimension = {}.", key,
                                type, is_plane_ ? 2 : 3),
                    is_plane_ ? "give chain, triangular or square." : "give chain, cubic or fcc.");
    for (std::size_t axis = 1; type == "chain" && axis < lattice["count"].size(); ++axis)
      if (lattice["count"][axis] != 1) {
        problems_.add(key + ".lattice.count",
                      fmt::format("{}.lattice.count = {} is not that of a chain along x.", key,
                                  value_text(lattice["count"])),
                      "give 1 for the other axes, for example [80, 1].");
        break;
      }
  }

  void check_packing(const string& key, const json& packing) {
    check_region(key + ".region", packing["region"]);
    if (!packing["cut"].is_null())
      check_region(key + ".cut", packing["cut"]);
    const json& radii = packing["radii"];
    check_keys_of(
        key + ".radii", radii, "law", radii["law"],
        {{"uniform", {"min", "max"}}, {"power", {"min", "max", "exponent"}}, {"list", {"values"}}});
    if (radii["max"] < radii["min"])
      problems_.add(key + ".radii.max",
                    fmt::format("{}.radii.max = {} is below min = {}.", key,
                                value_text(radii["max"]), value_text(radii["min"])),
                    "give min below max.");
    if (!radii["weights"].is_null() && radii["weights"].size() != radii["values"].size())
      problems_.add(key + ".radii.weights",
                    fmt::format("{}.radii has {} weights for {} values.", key,
                                radii["weights"].size(), radii["values"].size()),
                    "give one weight for each of the values.");
  }

  void check_region(const string& key, const json& region) {
    const std::vector<string> found =
        given(region, {"box", "center", "bottom", "top", "radius", "surface"});
    using Words = std::vector<string>;
    const bool is_good = found == Words{"box"} || found == Words{"center", "radius"} ||
                         (found == Words{"bottom", "top", "radius"} && !is_plane_) ||
                         found == Words{"surface"};
    if (!is_good)
      problems_.add(
          key,
          fmt::format("{} has {}.", key,
                      found.empty() ? "no shape" : fmt::format("{}", fmt::join(found, ", "))),
          fmt::format("give one shape: box; center with radius; {}or surface.",
                      is_plane_ ? "" : "bottom and top with radius; "));
  }

  /// Bonds by their gap or by their number; the one that is not given takes no part.
  void check_bonds(const string& key, json& bonds) {
    if (bonds["coordination_number"].is_null())
      return;
    if (document_.places.contains(key + ".gap_tolerance"))
      problems_.add(key + ".coordination_number",
                    key + " has both gap_tolerance and coordination_number.",
                    "give one of them: the other follows.");
    bonds["gap_tolerance"] = nullptr;
  }

  /// Each has a file of its own, which is named after it.
  /// @param names  of the files that there are anyway
  void check_series(const string& participant, const json& table, const std::vector<string>& lists,
                    std::set<string> names) {
    for (const string& list : lists)
      for (std::size_t k = 0; k < table[list].size(); ++k)
        check_name(fmt::format("{}.{}[{}]", participant, list, k), table[list][k]["name"],
                   "time series of " + participant, names);
    for (const string& name : names) {
      const string file = participant.substr(participant.find('.') + 1) + "_" + name;
      for (const auto* others : {&participants_, &couplings_})
        if (std::find(others->begin(), others->end(), file) != others->end())
          problems_.add(participant,
                        fmt::format("\"{}\" of {} would have the same file as \"{}\".", name,
                                    participant, file),
                        fmt::format("give \"{}\" another name.", file));
    }
  }

  void check_tools(const string& participant, const json& tools) {
    std::set<string> names = {"boundary", "loads", "clusters"};
    for (std::size_t k = 0; k < tools.size(); ++k) {
      const string key = fmt::format("{}.tools[{}]", participant, k);
      check_name(key, tools[k]["name"], "tools", names);
      check_history(key, participant, tools[k]["name"]);
      check_keys_of(key, tools[k], "shape", tools[k]["shape"],
                    {{"plane", {"point", "normal"}}, {"file", {"file"}}, {"box", {"box"}}});
      check_one_of(key, tools[k], "velocity", "velocities");
      check_rotation(key, tools[k]);
      if (const json& servo = tools[k]["servo"]; !servo.is_null()) {
        check_one_of(key + ".servo", servo, "force", "forces");
        if (servo["force"].is_null() && servo["forces"].is_null())
          problems_.add(key + ".servo", key + ".servo has neither force nor forces.",
                        "give the force that is wanted, or a table of forces.");
      }
      if (const json& free = tools[k]["free"]; !free.is_null())
        check_components(key + ".free.axes", free["axes"]);
    }
  }

  void check_loads(const string& list, const json& loads) {
    for (std::size_t k = 0; k < loads.size(); ++k) {
      const string key = fmt::format("{}[{}]", list, k);
      check_one_of(key, loads[k], "force", "forces");
      if (loads[k]["force"].is_null() && loads[k]["forces"].is_null())
        problems_.add(key, key + " has neither force nor forces.",
                      "give the force, or a table of forces.");
    }
  }

  void check_clusters(const string& list, const json& clusters) {
    for (std::size_t k = 0; k < clusters.size(); ++k) {
      const string key = fmt::format("{}[{}]", list, k);
      const json& cluster = clusters[k];
      const std::vector<string> members = given(cluster, {"box", "ids", "file"});
      if (members.size() != 1)
        problems_.add(key,
                      fmt::format("{} has {}.", key,
                                  members.empty() ? "neither box nor ids nor file"
                                                  : fmt::format("{}", fmt::join(members, " and "))),
                      "give one of them: it says which particles are joined.");
      check_one_of(key, cluster, "velocity", "velocities");
      check_rotation(key, cluster);
      const bool is_free = cluster["motion"] == "free";
      for (const char* name : {"mass", "center", "inertia"})
        if (!cluster[name].is_null() && (!is_free || !cluster["file"].is_null()))
          problems_.add(key + "." + name,
                        fmt::format("{}.{} is given, but it is only of one free body.", key, name),
                        "leave it out.");
      for (const char* name : {"velocities", "reference"})
        if (!cluster[name].is_null() && is_free)
          problems_.add(key + "." + name,
                        fmt::format("{}.{} is given, but the body is free.", key, name),
                        "leave it out, or give motion = \"prescribed\".");
      if (!is_free && !cluster["file"].is_null())
        problems_.add(key + ".file", key + ".file is given, but its bodies are free.",
                      "give motion = \"free\", or a prescribed body by its box or ids.");
    }
  }

  /// Bonds carry it.
  void check_in_situ_stress(const string& participant, const json& table) {
    const string key = participant + ".in_situ_stress";
    check_stress(key, table["in_situ_stress"], is_plane_ ? "xx yy xy" : "xx yy zz yz xz xy",
                 table["gravity"]);
    if (table["bonds"]["kind"] == "none" || table["material"]["law"] == "hertz_mindlin")
      problems_.add(key, key + " is given, but there are no bonds that could carry it.",
                    "leave it out, or give bonds.");
    if (!table["clusters"].empty())
      problems_.add(key, key + " is given, but clusters have no stress.", "leave out one of them.");
    const string name = participant.substr(participant.rfind('.') + 1);
    for (const json& coupling : settings_["couplings"])
      for (const json& member : coupling["between"])
        if (member == name)
          problems_.add(key, key + " is given, but coupled bodies begin without stress.",
                        "leave it out, or the coupling.");
  }

  /// Waves are slower in a heavier body.
  void check_mass_scaling(const string& participant, const json& table) {
    const string key = participant + ".mass_scaling";
    const json& scaling = table["mass_scaling"];
    if (scaling["critical_step"].is_null() == scaling["factor"].is_null())
      problems_.add(key, key + " needs either critical_step or factor.", "give one of them.");
    const string name = participant.substr(participant.rfind('.') + 1);
    for (const json& coupling : settings_["couplings"])
      for (const json& member : coupling["between"])
        if (member == name)
          problems_.add(key,
                        fmt::format("{} is given, but {} is coupled: waves would not cross.", key,
                                    participant),
                        "leave it out, or the coupling.");
    const auto is_wave = [](const json& one) {
      return one.value("kind", "") == "pulse" || one.value("motion", "") == "hann" ||
             !one.value("wave", json()).is_null();
    };
    for (const char* list : {"initial", "boundary", "absorbing"})
      for (const json& one : table.value(list, json::array()))
        if (is_wave(one))
          problems_.add(key,
                        fmt::format("{} is given, but {}.{} makes a wave, whose speed it "
                                    "would change.",
                                    key, participant, list),
                        "leave it out; it is for slow loading.");
  }

  /// The history of a tool has the names of its participant and its own.
  void check_history(const string& key, const string& participant, const string& tool) {
    const string name = participant.substr(participant.rfind('.') + 1) + "_" + tool;
    for (const auto& others : {participants_, couplings_})
      if (std::find(others.begin(), others.end(), name) != others.end())
        problems_.add(key + ".name",
                      fmt::format("history/{0}.csv would be of {1}.name and of {0}.", name, key),
                      "give one of them another name.");
  }

  void check_initial(const string& key, const json& initial) {
    check_components(key + ".component", json::array({initial["component"]}));
    check_components(key + ".axis", json::array({initial["axis"]}));
    check_keys_of(
        key, initial, "kind", initial["kind"],
        {{"velocity", {"velocity"}}, {"pulse", {"amplitude", "center", "length", "wave_speed"}}});
  }

  void check_couplings() {
    std::set<string> names;
    for (std::size_t k = 0; k < couplings_.size(); ++k) {
      const string key = fmt::format("couplings[{}]", k);
      const json& coupling = settings_["couplings"][k];
      check_name(key, couplings_[k], "couplings", names);
      const string first = coupling["between"][0], second = coupling["between"][1];
      const bool known = check_known(key + ".between", first, "participant", participants_) &
                         check_known(key + ".between", second, "participant", participants_);
      if (!known)
        continue;
      const string kinds = kind_of(first) + kind_of(second);
      if (kinds != "demfem" && kinds != "femdem")
        problems_.add(key + ".between",
                      fmt::format("{}.between = {} are participants of kind {} and {}.", key,
                                  value_text(coupling["between"]), kind_of(first), kind_of(second)),
                      "an overlap needs one dem and one fem participant.");
    }
  }

  void check_measures() {
    std::set<string> names;
    const Key* kind_key = keys_of("measures[]", "")[1];
    const std::vector<string>& kinds = kind_key->allowed.choices;
    for (std::size_t k = 0; k < settings_["measures"].size(); ++k) {
      const string key = fmt::format("measures[{}]", k);
      json& measure = settings_["measures"][k];
      check_name(key, measure["name"], "measures", names);
      if (measure["kind"].is_null()) {
        const string name = measure["name"], meant = nearest(name, kinds);
        if (std::find(kinds.begin(), kinds.end(), name) == kinds.end())
          problems_.add(key + ".name",
                        fmt::format("{}.name = \"{}\" is not a kind of measure, and no kind is "
                                    "given.",
                                    key, name),
                        fmt::format("{}give kind: {}.",
                                    meant.empty() ? "" : "did you mean " + meant + "? Or ",
                                    kind_key->allowed.text()));
        measure["kind"] = name;
      }
      for (const char* name : {"participant", "reference"})
        if (!measure[name].is_null())
          check_known(key + "." + name, measure[name], "participant", participants_);
      if (!measure["coupling"].is_null())
        check_known(key + ".coupling", measure["coupling"], "coupling", couplings_);
      check_expectation(key + ".expect", measure["expect"]);
      if (measure["kind"] == "coordination_number")
        check_coordination(key, measure);
      if (measure["kind"] == "reflected_energy" || measure["kind"] == "transmitted_energy")
        check_wave_energy(key, measure);
    }
  }

  /// Elements have no neighbours that count.
  void check_coordination(const string& key, const json& measure) {
    const json& participants = settings_["participants"];
    if (measure["participant"].is_null())
      return;
    const auto found = participants.find(measure["participant"].get<string>());
    if (found != participants.end() && (*found)["kind"] != "dem")
      problems_.add(key + ".participant",
                    fmt::format("{}.participant = {} has no particles.", key,
                                value_text(measure["participant"])),
                    "name a participant of kind dem.");
  }

  /// These two are taken from the last frame of a participant.
  void check_wave_energy(const string& key, const json& measure) {
    if (measure["participant"].is_null()) {
      problems_.add(key, fmt::format("{}.participant is missing.", key),
                    "name the participant whose energy is measured.");
      return;
    }
    const auto kind_of = [&](const char* who) -> string {
      const json& participants = settings_["participants"];
      const auto found = participants.find(measure[who].get<string>());
      return found == participants.end() ? "" : (*found)["kind"].get<string>();
    };
    if (!measure["reference"].is_null() &&
        (kind_of("participant") == "fem" || kind_of("reference") == "fem"))
      problems_.add(
          key + ".reference",
          fmt::format("{}.reference compares particles, but one of the two is a mesh.", key),
          "name a dem participant with the same particles, or leave reference out.");
    if (settings_["case"]["output"]["frames"] == 0)
      problems_.add(key, fmt::format("{} needs a frame, but case.output.frames = 0.", key),
                    "let case.output.frames be at least 1.");
  }

  void check_expectation(const string& key, const json& expect) {
    if (expect.is_null())
      return;
    const json &min = expect["min"], &max = expect["max"];
    if (min.is_null() && max.is_null())
      problems_.add(key, key + " has neither min nor max.", "give at least one of them.");
    else if (!min.is_null() && !max.is_null() && min > max)
      problems_.add(
          key, fmt::format("{}.min = {} is above max = {}.", key, value_text(min), value_text(max)),
          "give min below max.");
  }

  bool check_known(const string& key, const string& name, const string& what,
                   const std::vector<string>& known) {
    if (std::find(known.begin(), known.end(), name) != known.end())
      return true;
    const string meant = nearest(name, known);
    problems_.add(key, fmt::format("{} names \"{}\", which is not a {}.", key, name, what),
                  known.empty()
                      ? fmt::format("there is no {} in this case.", what)
                      : fmt::format("{}There {}: {}.",
                                    meant.empty() ? "" : "did you mean " + meant + "? ",
                                    known.size() == 1 ? "is" : "are", fmt::join(known, ", ")));
    return false;
  }

  string kind_of(const string& participant) const {
    return settings_["participants"][participant]["kind"];
  }

  json& settings_;
  const Document& document_;
  std::vector<string> participants_, couplings_;
};

} // namespace

void check_settings(json& settings, const Document& document, Problems& problems) {
  Checks(settings, document, problems).run();
  check_stages(settings, problems);
}

} // namespace kerf::config
