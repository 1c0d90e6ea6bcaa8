#include "coupler/commands/solids.hpp"

#include "coupler/commands/pack_program.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <fstream>
#include <numbers>

namespace kerf::commands {
namespace {

using nlohmann::json;
using std::string;

struct Solid {
  double C11, C12;       // Pa
  double solid_fraction; // bulk density over that of the particles
};

struct Lattice {
  Solid solid;
  double next_neighbours; // their distance over that of the nearest
};

/// Born's energy of the bonds: under a homogeneous strain every particle is in equilibrium and none
/// turns. Of fcc, which is not isotropic, the moduli along the cube.
Lattice of_lattice(const json& particles, double k_n, double k_t) {
  const json& lattice = particles["lattice"];
  const double d = lattice["spacing"];
  const double r = particles["radius"].is_null() ? d / 2.0 : particles["radius"].get<double>();
  const double ratio = r / d;
  using std::numbers::pi, std::numbers::sqrt2, std::numbers::sqrt3;
  if (lattice["type"] == "triangular")
    return {.solid = {.C11 = sqrt3 / 4.0 * (3.0 * k_n + k_t),
                      .C12 = sqrt3 / 4.0 * (k_n - k_t),
                      .solid_fraction = 2.0 / sqrt3 * pi * ratio * ratio},
            .next_neighbours = sqrt3};
  return {.solid = {.C11 = sqrt2 * (k_n + k_t) / d,
                    .C12 = (k_n - k_t) / (sqrt2 * d),
                    .solid_fraction = 4.0 * sqrt2 / 3.0 * pi * ratio * ratio * ratio},
          .next_neighbours = sqrt2};
}

/// Whether the bonds of a lattice are those of nearest neighbours and no others.
bool bonds_nearest_only(const json& participant, double next_neighbours) {
  const json& particles = participant["particles"];
  const json& tolerance = participant["bonds"]["gap_tolerance"];
  if (tolerance.is_null()) // from a coordination number
    return false;
  const double d = particles["lattice"]["spacing"];
  const double reach =
      (particles["radius"].is_null() ? d : 2.0 * particles["radius"].get<double>()) *
      (1.0 + tolerance.get<double>());
  return d <= reach * (1.0 + 1e-9) && next_neighbours * d > reach;
}

class Solids {
public:
  Solids(const CaseFile& case_file, const json& settings, const std::filesystem::path& run_folder)
      : case_file_(case_file), settings_(settings), run_folder_(run_folder) {}

  /// @param key  of the material
  Solid solid_of(const string& name, const string& key) const {
    const json& rock = settings_["participants"][name];
    const json& material = rock["material"];
    const double k_n = material["normal_stiffness"], k_t = material["tangential_stiffness"];
    if (rock["particles"]["lattice"].is_null())
      return measured(name, rock, k_n, k_t, key);
    const Lattice lattice = of_lattice(rock["particles"], k_n, k_t);
    if (!bonds_nearest_only(rock, lattice.next_neighbours))
      throw case_file_.error(
          key + ".participant",
          fmt::format("the lattice of {} is not bonded between nearest neighbours only.", name),
          fmt::format("give participants.{}.bonds.gap_tolerance = 0.001, or C11 and C12 here.",
                      name));
    return lattice.solid;
  }

private:
  Solid measured(const string& name, const json& rock, double k_n, double k_t,
                 const string& key) const {
    const auto file = run_folder_ / "packings" / (name + "_moduli.json");
    std::filesystem::create_directories(file.parent_path());
    const json& bonds = rock["bonds"];
    const bool by_gap = bonds["coordination_number"].is_null();
    const auto complaint = run_pack(
        {"--from", rock["particles"]["file"].get<string>(), "--dimension",
         settings_["case"]["dimension"].dump(), "--moduli-file", file.string(),
         "--normal-stiffness", fmt::format("{}", k_n), "--tangential-stiffness",
         fmt::format("{}", k_t), by_gap ? "--gap-tolerance" : "--coordination-number",
         fmt::format("{}", bonds[by_gap ? "gap_tolerance" : "coordination_number"].get<double>())},
        run_folder_ / "logs" / (name + "_moduli.log"));
    if (complaint)
      throw case_file_.error(
          key + ".participant",
          fmt::format("the moduli of {} cannot be measured: {}", name, *complaint),
          "bond its particles, or give C11 and C12 here.");
    const json moduli = json::parse(std::ifstream(file));
    return {.C11 = moduli["C11"],
            .C12 = moduli["C12"],
            .solid_fraction = moduli["bulk_density_factor"]};
  }

  const CaseFile& case_file_;
  const json& settings_;
  const std::filesystem::path& run_folder_;
};

} // namespace

json with_solids(const CaseFile& case_file, json settings,
                 const std::filesystem::path& run_folder) {
  const json before = settings;
  const Solids solids(case_file, before, run_folder);
  const auto resolve = [&](json& material, const string& key) {
    if (material.is_null() || material["model"] != "from_packing")
      return;
    const string name = material["participant"];
    const Solid solid = solids.solid_of(name, key);
    const double density =
        solid.solid_fraction * before["participants"][name]["material"]["density"].get<double>();
    spdlog::info("{}: C11 = {} Pa, C12 = {} Pa, density = {} kg/m³, from the packing of {}.", key,
                 solid.C11, solid.C12, density, name);
    material["model"] = "linear_elastic";
    material["participant"] = nullptr;
    material["C11"] = solid.C11;
    material["C12"] = solid.C12;
    material["density"] = density;
  };
  for (auto& [name, participant] : settings["participants"].items()) {
    if (participant["kind"] != "fem")
      continue;
    const string key = "participants." + name;
    resolve(participant["material"], key + ".material");
    for (std::size_t k = 0; k < participant["materials"].size(); ++k)
      resolve(participant["materials"][k], fmt::format("{}.materials[{}]", key, k));
  }
  return settings;
}

} // namespace kerf::commands
