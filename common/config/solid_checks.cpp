// What can be wrong with the materials of a body of elements beyond the types of their values.
#include "common/config/case_reader.hpp"
#include "common/config/value_types.hpp"
#include "common/nearest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace kerf::config {
namespace {

using nlohmann::json;
using std::string;
using Words = std::vector<string>;

bool has(const Words& words, const string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

struct Model {
  string name;
  Words needed, optional;
};

const Words elastic = {"young_modulus", "poisson_ratio", "C11", "C12"};
const Words of_all = {"model",
                      "region",
                      "box",
                      "formulation",
                      "hourglass_stiffness",
                      "hourglass_viscosity",
                      "linear_viscosity",
                      "quadratic_viscosity"};

const std::vector<Model>& models() {
  static const std::vector<Model> all = {
      {"linear_elastic", {"density"}, joined(elastic, {"finite_strain"})},
      {"transversely_isotropic", // its axis does not turn with the material
       {"density", "young_in_plane", "young_normal", "poisson_in_plane", "poisson_normal",
        "shear_normal"},
       {"axis"}},
      {"neo_hookean", {"density"}, elastic},
      {"j2_plastic",
       {"density"},
       joined(elastic,
              {"finite_strain", "yield_stress", "hardening_modulus", "saturation_stress",
               "saturation_exponent", "hardening_table", "reference_rate", "rate_exponent"})},
      {"drucker_prager",
       {"density", "cohesion", "friction_angle"},
       joined(elastic, {"finite_strain", "dilation_angle", "fit", "tension_cutoff"})},
      {"isotropic_damage",
       {"density", "tensile_strength", "fracture_energy"},
       joined(elastic, {"finite_strain", "strength_ratio"})},
      {"from_packing", {"participant"}, {"finite_strain"}}};
  return all;
}

class SolidChecks {
public:
  SolidChecks(const string& participant, const json& settings, Problems& problems)
      : participant_(participant), settings_(settings), problems_(problems),
        is_plane_(settings["case"]["dimension"] == 2) {}

  void run(json& table) {
    check_plane(table["plane"]);
    is_plane_strain_ = table["plane"] == "strain";
    const json &material = table["material"], &others = table["materials"];
    if (material.is_null() && others.empty())
      problems_.add(
          participant_, participant_ + " has no material.",
          fmt::format("begin a table [{0}.material], or tables [[{0}.materials]] with a region or "
                      "a box each.",
                      participant_));
    if (!material.is_null())
      check_material(participant_ + ".material", material);
    for (std::size_t k = 0; k < others.size(); ++k) {
      const string key = fmt::format("{}.materials[{}]", participant_, k);
      check_material(key, others[k]);
      if (others[k]["region"].is_null() && others[k]["box"].is_null())
        problems_.add(key, key + " has neither region nor box.",
                      fmt::format("give one of them: it says which elements are of it; that of "
                                  "all others is [{}.material].",
                                  participant_));
    }
  }

private:
  void check_plane(json& plane) {
    const string key = participant_ + ".plane";
    if (!is_plane_) {
      if (!plane.is_null())
        problems_.add(key, key + " is given, but case.dimension = 3.", "leave it out.");
      return;
    }
    if (plane.is_null())
      plane = "strain";
    if (plane != "axisymmetric")
      return;
    if (!settings_["case"]["periodic"]["x"].is_null())
      problems_.add(key, key + " = \"axisymmetric\", but case.periodic.x is given.",
                    "leave one of them out: x is the radius.");
    const string name = participant_.substr(participant_.rfind('.') + 1);
    for (const json& coupling : settings_["couplings"])
      if (has(coupling["between"], name))
        problems_.add(key, key + " = \"axisymmetric\", but particles in 2D are discs.",
                      "give \"strain\" or \"stress\", or leave out the coupling.");
  }

  void check_material(const string& key, const json& material) {
    const Model& own = *std::find_if(models().begin(), models().end(), [&](const Model& model) {
      return model.name == material["model"];
    });
    for (const string& name : own.needed)
      if (material[name].is_null())
        problems_.add(
            key + "." + name, fmt::format("{}.{} is missing.", key, name),
            fmt::format("model = \"{}\" needs {}.", own.name, fmt::join(own.needed, ", ")));
    for (const auto& [name, value] : material.items())
      if (!value.is_null() && !has(of_all, name) && !has(own.needed, name) &&
          !has(own.optional, name))
        refuse(key, name, own);
    if (has(own.optional, "C11"))
      check_elastic(key, material);
    if (own.name == "from_packing" && !material["participant"].is_null())
      check_packing(key + ".participant", material["participant"]);
    if (own.name == "j2_plastic")
      check_hardening(key, material);
    if (own.name == "drucker_prager" && material["dilation_angle"].is_number() &&
        material["dilation_angle"] > material["friction_angle"])
      problems_.add(key + ".dilation_angle",
                    fmt::format("{}.dilation_angle = {} is above friction_angle = {}.", key,
                                shown(material["dilation_angle"]),
                                shown(material["friction_angle"])),
                    "give at most the angle of friction.");
    if (!material["axis"].is_null() && material["axis"].size() != 3)
      problems_.add(key + ".axis",
                    fmt::format("{}.axis = {} has {} numbers.", key, shown(material["axis"]),
                                material["axis"].size()),
                    "give x, y and z, also in 2D.");
    for (const char* const name : {"hourglass_stiffness", "hourglass_viscosity"})
      if (!material[name].is_null() && material["formulation"] != "one_point")
        problems_.add(fmt::format("{}.{}", key, name),
                      fmt::format("{}.{} is given, but formulation = {} does not use it.", key,
                                  name, shown(material["formulation"])),
                      "leave it out, or give formulation = \"one_point\".");
  }

  void refuse(const string& key, const string& name, const Model& own) {
    Words users;
    for (const Model& model : models())
      if (has(model.needed, name) || has(model.optional, name))
        users.push_back(model.name);
    const string meant = nearest(name, joined(own.needed, own.optional));
    problems_.add(
        key + "." + name,
        fmt::format("{}.{} is given, but model = \"{}\" does not use it.", key, name, own.name),
        fmt::format("{}leave it out; it is for {}.",
                    meant.empty() ? "" : "did you mean " + meant + "? Or ",
                    fmt::join(users, ", ")));
  }

  void check_elastic(const string& key, const json& material) {
    Words given;
    for (const string& name : elastic)
      if (!material[name].is_null())
        given.push_back(name);
    if (given != Words{"young_modulus", "poisson_ratio"} && given != Words{"C11", "C12"}) {
      problems_.add(
          key,
          fmt::format("{} has {} for its elastic constants.", key,
                      given.empty() ? "nothing" : fmt::format("{}", fmt::join(given, ", "))),
          "give exactly one pair: young_modulus with poisson_ratio, or C11 with C12.");
    } else if (given[0] == "C11") {
      const double C11 = material["C11"], C12 = material["C12"];
      // Some solids that are stable in the plane are not when they are strained across it.
      const bool in_plane = is_plane_strain_ && material["model"] == "linear_elastic";
      if (C12 >= C11 || (in_plane ? C12 : 2.0 * C12) <= -C11) // shear and bulk stiffness
        problems_.add(key + ".C12",
                      fmt::format("{}.C12 = {} with C11 = {} is not a stable material.", key,
                                  value_text(C12), value_text(C11)),
                      in_plane ? "give C12 between -C11 and C11."
                               : "give C12 between -C11 / 2 and C11.");
    }
  }

  /// The moduli of a packing are those of equal springs between bonded neighbours.
  void check_packing(const string& key, const string& name) {
    Words known;
    for (const auto& [other, table] : settings_["participants"].items())
      if (table["kind"] == "dem")
        known.push_back(other);
    if (!has(known, name)) {
      const string meant = nearest(name, known);
      problems_.add(key, fmt::format("{} = \"{}\" has no particles.", key, name),
                    known.empty()   ? "this case has no participant of kind dem."
                    : meant.empty() ? fmt::format("name one of {}.", fmt::join(known, ", "))
                                    : "did you mean " + meant + "?");
      return;
    }
    const json& rock = settings_["participants"][name];
    const json &lattice = rock["particles"]["lattice"], &material = rock["material"];
    string reason;
    if (rock["bonds"]["kind"] == "none")
      reason = "its particles are not bonded";
    else if (material["law"] != "linear" || material["normal_stiffness"].is_null())
      reason = "its material has no normal_stiffness of law = \"linear\"";
    else if (!rock["materials"].empty() || !rock["pairs"].empty())
      reason = "it has several materials";
    else if (!lattice.is_null() && lattice["type"] != "triangular" && lattice["type"] != "fcc")
      reason = "its lattice is neither triangular nor fcc";
    else if (lattice.is_null() && material["bond_radius_ratio"] > 0.0)
      reason = "its bonds bend";
    if (!reason.empty())
      problems_.add(key,
                    fmt::format("{} = \"{}\": the moduli are not known, {}.", key, name, reason),
                    "give model = \"linear_elastic\" with density, C11 and C12.");
  }

  void check_hardening(const string& key, const json& material) {
    const bool has_table = !material["hardening_table"].is_null();
    if (has_table == !material["yield_stress"].is_null())
      problems_.add(key,
                    fmt::format("{} has {}.", key,
                                has_table ? "both yield_stress and hardening_table"
                                          : "neither yield_stress nor hardening_table"),
                    "give one of them: where flow begins, or rows of plastic strain and stress.");
    for (const char* name : {"hardening_modulus", "saturation_stress", "saturation_exponent"})
      if (has_table && !material[name].is_null())
        problems_.add(key + "." + name,
                      fmt::format("{0}.{1} is given, but so is {0}.hardening_table.", key, name),
                      "leave one of them out.");
    check_both(key, material, "saturation_stress", "saturation_exponent");
    check_both(key, material, "reference_rate", "rate_exponent");
  }

  void check_both(const string& key, const json& material, const string& first,
                  const string& second) {
    if (material[first].is_null() != material[second].is_null())
      problems_.add(key, fmt::format("{} has only one of {} and {}.", key, first, second),
                    "give both.");
  }

  const string& participant_;
  const json& settings_;
  Problems& problems_;
  bool is_plane_, is_plane_strain_ = false;
};

} // namespace

void check_solids(const string& participant, json& settings, Problems& problems) {
  const string name = participant.substr(participant.rfind('.') + 1);
  SolidChecks(participant, settings, problems).run(settings["participants"][name]);
}

} // namespace kerf::config
