// The settings of a finite element participant: from JSON to mesh and engine, and what is refused.
#include "fem_core/program/read_settings.hpp"

#include "fem_core/engine.hpp"
#include "fem_core/input_error.hpp"
#include "fem_core/program/read_materials.hpp"
#include "fem_core/program/read_mesh.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <functional>

namespace kerf::fem {
namespace {

using nlohmann::json;

json participant() {
  return json::parse(R"({
    "kind": "fem", "solver": "kerf-fem", "command": null, "threads": "auto",
    "mesh": {"type": "box", "origin": [0.01, 0.0], "size": [0.08, 0.007], "count": [80, 7]},
    "material": {"model": "linear_elastic", "density": 2358.0, "young_modulus": null,
                 "poisson_ratio": null, "C11": 1.2e10, "C12": 4e9},
    "boundary": [{"tag": "right", "box": null, "components": null, "motion": "fixed",
                  "velocity": null, "amplitude": null, "duration": null},
                 {"tag": null, "box": [[0.01, 0.0], [0.01, 0.007]], "components": ["y"],
                  "motion": "hann", "velocity": null, "amplitude": [0.0, 1e-8],
                  "duration": 1e-5}],
    "initial": [{"box": null, "kind": "pulse", "velocity": null, "amplitude": 1e-8,
                 "center": 0.02, "length": 0.016, "wave_speed": 2424.0, "spacing": 1e-3,
                 "component": "y", "axis": "x"},
                {"box": [[0.0, 0.0], [0.05, 0.007]], "kind": "velocity", "velocity": [0.5, 0.0],
                 "amplitude": null, "center": null, "length": null, "wave_speed": null,
                 "spacing": 0.0, "component": "x", "axis": "x"}]})");
}

/// Reads all of a participant and builds its engine; gives "key: sentence" of what is refused.
std::string refusal(const std::function<void(json&)>& change, const Period<2>& period = {}) {
  json table = participant();
  change(table);
  try {
    const Table settings(table, "");
    const Mesh<2> mesh = read_mesh(settings, period);
    try {
      Engine<2>(mesh, read_settings(settings, mesh));
    } catch (const InputError& error) { // as in run_fem()
      throw coupler::SettingsError(case_key(settings, error.key()), error.what());
    }
    read_threads(settings);
  } catch (const coupler::SettingsError& error) {
    return error.key() + ": " + error.what();
  } catch (const InputError& error) { // a SettingsError with the same key and text to the user
    return error.key() + ": " + error.what();
  }
  return "nothing was refused";
}

TEST(FemSettings, are_read_as_they_are_written) {
  const json table = participant();
  const Table settings(table, "");
  const Mesh<2> mesh = read_mesh(settings, Period<2>{});
  const Settings<2> read = read_settings(settings, mesh);
  EXPECT_EQ(mesh.num_elements(), 560u);
  EXPECT_EQ(mesh.position(0), Vec<2>(0.01, 0.0));
  ASSERT_EQ(read.materials.size(), 1u);
  const auto& law = std::get<IsotropicElastic>(read.materials[0].material.law);
  EXPECT_EQ(law.density, 2358.0);
  EXPECT_EQ(law.moduli.lambda, 4e9);
  EXPECT_EQ(law.moduli.mu, 4e9);
  ASSERT_EQ(read.boundary.size(), 2u);
  EXPECT_EQ(read.boundary[0].tag, "right");
  EXPECT_EQ(read.boundary[0].components, (std::array{true, true}));
  EXPECT_EQ(read.boundary[1].components, (std::array{false, true}));
  EXPECT_EQ(read.boundary[1].motion, Motion::hann);
  EXPECT_EQ(read.boundary[1].amplitude, Vec<2>(0.0, 1e-8));
  EXPECT_EQ(read.boundary[1].box->upper, Vec<2>(0.01, 0.007));
  ASSERT_EQ(read.initial.size(), 2u);
  EXPECT_EQ(read.initial[0].pulse->component, 1);
  EXPECT_EQ(read.initial[0].pulse->spacing, 1e-3);
  EXPECT_EQ(read.initial[1].velocity->velocity, Vec<2>(0.5, 0.0));
  EXPECT_FALSE(read_threads(settings));
}

/// The material that JSON says, of a body in plane strain.
template <class LawType> std::pair<LawType, Material> law_of(const std::string& material) {
  json table = participant();
  table["material"] = json::parse(material);
  const Table settings(table, "");
  const Mesh<2> mesh = read_mesh(settings, Period<2>{});
  const Material read = read_materials(settings, mesh).at(0).material;
  return {std::get<LawType>(read.law), read};
}

TEST(FemSettings, give_every_law_its_parameters) {
  const auto [layered, small] = law_of<TransverselyIsotropic>(
      R"({"model": "transversely_isotropic", "density": 2600, "young_in_plane": 4e10,
          "young_normal": 2e10, "poisson_in_plane": 0.2, "poisson_normal": 0.15,
          "shear_normal": 1e10, "axis": [3.0, 4.0, 0.0], "formulation": "one_point",
          "hourglass_stiffness": 0.05, "hourglass_viscosity": 0.2, "linear_viscosity": 0.06,
          "quadratic_viscosity": 1.2})");
  EXPECT_DOUBLE_EQ(layered.n[1], 0.8);
  EXPECT_EQ(layered.mu_n, 1e10);
  EXPECT_EQ(small.density(), 2600.0);
  EXPECT_FALSE(small.finite_strain);
  EXPECT_EQ(small.formulation, Formulation::one_point);
  EXPECT_EQ(small.hourglass_stiffness, 0.05);
  EXPECT_EQ(small.hourglass_viscosity, 0.2);
  EXPECT_EQ(small.linear_viscosity, 0.06);
  EXPECT_EQ(small.quadratic_viscosity, 1.2);

  const auto [metal, large] = law_of<J2Plastic>(
      R"({"model": "j2_plastic", "density": 8930, "young_modulus": 1.17e11, "poisson_ratio": 0.35,
          "yield_stress": 4e8, "hardening_modulus": 1e8, "saturation_stress": 2e8,
          "saturation_exponent": 10, "reference_rate": 40, "rate_exponent": 5,
          "finite_strain": true, "formulation": "mean_dilatation"})");
  EXPECT_EQ(metal.hardening.initial, 4e8);
  EXPECT_EQ(metal.hardening.modulus, 1e8);
  EXPECT_EQ(metal.hardening.saturation, 2e8);
  EXPECT_EQ(metal.hardening.exponent, 10.0);
  EXPECT_EQ(metal.rate.reference, 40.0);
  EXPECT_EQ(metal.rate.exponent, 5.0);
  EXPECT_TRUE(large.finite_strain);
  EXPECT_EQ(large.formulation, Formulation::mean_dilatation);

  const auto [tabled, of_table] = law_of<J2Plastic>(
      R"({"model": "j2_plastic", "density": 8930, "young_modulus": 1.17e11, "poisson_ratio": 0.35,
          "hardening_table": [[0.0, 4e8], [0.1, 5e8]]})");
  EXPECT_EQ(tabled.hardening.points, 2);
  EXPECT_DOUBLE_EQ(tabled.hardening.slope[0], 1e9);
  EXPECT_EQ(of_table.hourglass_stiffness, Material{}.hourglass_stiffness);

  const auto [damaged, of_damage] = law_of<IsotropicDamage>(
      R"({"model": "isotropic_damage", "density": 2600, "young_modulus": 4e10,
          "poisson_ratio": 0.2, "tensile_strength": 1e7, "fracture_energy": 100})");
  EXPECT_EQ(damaged.tensile_strength, 1e7);
  EXPECT_EQ(damaged.fracture_energy, 100.0);
  EXPECT_EQ(damaged.strength_ratio, 10.0);
}

// Where the cone meets the axis, p = c cot(phi), whatever it is fitted to; outer is the larger.
TEST(FemSettings, take_angles_in_degrees) {
  const std::string rock = R"({"model": "drucker_prager", "density": 2600, "young_modulus": 4e10,
                               "poisson_ratio": 0.2, "cohesion": 5e6, "friction_angle": 45)";
  const DruckerPrager outer = law_of<DruckerPrager>(rock + "}").first;
  EXPECT_NEAR(outer.cutoff, 5e6, 1e-6);
  EXPECT_EQ(outer.flow_eta, 0.0);
  const DruckerPrager inner =
      law_of<DruckerPrager>(rock + R"(, "fit": "inner", "dilation_angle": 45,
                                        "tension_cutoff": 1e6})")
          .first;
  EXPECT_LT(inner.eta, outer.eta);
  EXPECT_EQ(inner.flow_eta, inner.eta);
  EXPECT_EQ(inner.cutoff, 1e6);
}

TEST(FemSettings, give_regions_and_boxes_materials_of_their_own) {
  json table = participant();
  table["mesh"] = {{"type", "tunnel"}, {"origin", {0.0, 0.0}}, {"size", {8.0, 8.0}},
                   {"radius", 1.0},    {"count", {4, 8}},      {"excavation", true}};
  table["boundary"] = json::array();
  json soft = table["material"];
  soft["density"] = 1000.0;
  soft["region"] = "excavation";
  json corner = table["material"];
  corner["density"] = 3000.0;
  corner["box"] = {{0.0, 0.0}, {4.0, 8.0}};
  table["materials"] = {soft, corner};
  table["plane"] = "axisymmetric";
  table["gravity"] = {0.0, -9.81};
  table["damping"] = {{"mass", 100.0}, {"local", 0.2}, {"kinetic", true}};
  table["mass_scaling"] = {{"critical_step", 1e-3}, {"factor", nullptr}};
  const Table settings(table, "");
  const Mesh<2> mesh = read_mesh(settings, Period<2>{});
  const Settings<2> read = read_settings(settings, mesh);
  ASSERT_EQ(read.materials.size(), 3u);
  EXPECT_EQ(read.materials[0].material.density(), 2358.0);
  EXPECT_EQ(read.materials[1].material.density(), 1000.0);
  EXPECT_EQ(read.materials[1].region, "excavation");
  EXPECT_EQ(read.materials[2].box->upper, Vec<2>(4.0, 8.0));
  EXPECT_EQ(read.plane, Plane::axisymmetric);
  EXPECT_EQ(read.gravity, Vec<2>(0.0, -9.81));
  EXPECT_EQ(read.mass_damping, 100.0);
  EXPECT_EQ(read.local_damping, 0.2);
  EXPECT_TRUE(read.kinetic_damping);
  ASSERT_TRUE(read.mass_scaling);
  EXPECT_EQ(read.mass_scaling->critical_step, 1e-3);
  EXPECT_EQ(read.mass_scaling->factor, 1.0);
}

TEST(FemSettings, of_materials_are_refused_with_the_key_that_the_case_has) {
  const auto add = [](json& t, const char* key, const json& value) {
    t["materials"] = json::array({t["material"]});
    t["materials"][0][key] = value;
  };
  EXPECT_EQ(refusal([](json& t) { t["material"]["formulation"] = "nodal_pressure"; }),
            "material.formulation: nodal_pressure is of tri3 and tet4; quad4 has full, "
            "mean_dilatation or one_point");
  const json outside = {{9.0, 9.0}, {10.0, 10.0}};
  EXPECT_EQ(refusal([&](json& t) { add(t, "box", outside); }),
            "materials[0].box: no element of the mesh has its centre in the box");
  EXPECT_EQ(refusal([&](json& t) {
              add(t, "box", outside);
              t["material"] = nullptr;
            }),
            "materials[0].box: no element of the mesh has its centre in the box");
  EXPECT_EQ(refusal([&](json& t) {
              add(t, "box", json{{0.01, 0.0}, {0.05, 0.007}});
              t["material"] = nullptr;
            }),
            "materials: element 40 has no material");
  EXPECT_EQ(refusal([&](json& t) { add(t, "region", "vein"); }),
            "materials[0].region: the mesh has no region \"vein\", and no other\ngive a mesh "
            "with regions");
  EXPECT_EQ(refusal([](json& t) {
              t["mesh"] = {{"type", "tunnel"}, {"origin", {0.0, 0.0}}, {"size", {8.0, 8.0}},
                           {"radius", 1.0},    {"count", {4, 8}},      {"excavation", true}};
              t["materials"] = json::array({t["material"]});
              t["materials"][0]["region"] = "excavatoin";
            }),
            "materials[0].region: the mesh has no region \"excavatoin\"; did you mean "
            "\"excavation\"? Its regions are excavation, rock");
  EXPECT_EQ(refusal([](json& t) { t["material"]["density"] = -1.0; }),
            "material.density: -1 kg/m³ must be positive");
  EXPECT_EQ(refusal([](json& t) { t["material"]["model"] = "linear"; }),
            "material.model: \"linear\" must be one of linear_elastic, transversely_isotropic, "
            "neo_hookean, j2_plastic, drucker_prager, isotropic_damage");
  EXPECT_EQ(refusal([](json& t) {
              t["material"] = {{"model", "isotropic_damage"}, {"density", 2600.0},
                               {"young_modulus", 4e10},       {"poisson_ratio", 0.2},
                               {"tensile_strength", 1e7},     {"fracture_energy", 1e-3}};
            }).substr(0, 60),
            "material.fracture_energy: 0.001 J/m² is too little for an e");
  EXPECT_EQ(refusal([](json& t) { t["material"] = nullptr; }),
            "material: it is missing; give a table");
}

TEST(FemSettings, take_the_period_from_the_case) {
  const json table = json::parse(R"({"periodic": {"x": null, "y": [0.001, 0.008], "z": null}})");
  const Period<2> period = read_period<2>(Table(table, ""));
  EXPECT_EQ(period.length[0], 0.0);
  EXPECT_DOUBLE_EQ(period.length[1], 0.007);
}

TEST(FemSettings, that_cannot_be_used_are_refused_with_their_key_and_a_sentence) {
  EXPECT_EQ(refusal([](json& t) { t["boundary"][0]["tag"] = "rigth"; }),
            "boundary[0].tag: the mesh has no tag \"rigth\"; did you mean \"right\"? Its tags are "
            "all, bottom, left, right, top");
  EXPECT_EQ(refusal([](json& t) { t["boundary"][0]["motion"] = "velocity"; }),
            "boundary[0].velocity: it is missing; give a list of numbers");
  EXPECT_EQ(refusal([](json& t) { t["boundary"][1]["components"] = {"z"}; }),
            "boundary[1].components: \"z\" must be x or y");
  EXPECT_EQ(refusal([](json& t) {
              t["boundary"][1]["box"] = {{1.0, 1.0}, {2.0}};
            }),
            "boundary[1].box: it must be a lower and an upper corner of 2 numbers each");
  EXPECT_EQ(refusal([](json& t) { t["material"]["young_modulus"] = 1e10; }),
            "material: give exactly one pair: young_modulus and poisson_ratio, or C11 and C12");
  EXPECT_EQ(refusal([](json& t) { t["material"]["C12"] = nullptr; }),
            "material.C12: it is missing; give a number");
  EXPECT_EQ(refusal([](json& t) { t["material"]["density"] = "heavy"; }),
            "material.density: it is \"heavy\"; it must be a number");
  EXPECT_EQ(refusal([](json& t) {
              t["mesh"]["count"] = {80, 0};
            }),
            "mesh.count: 0 must be a positive integer");
  EXPECT_EQ(refusal([](json&) {}, Period<2>{.length = {0.0, 0.0069}}),
            "mesh.size: the size along the periodic axis y is 0.007 m; it must be the period, "
            "0.0069 m");
  EXPECT_EQ(refusal([](json& t) { t["initial"][0]["axis"] = "z"; }),
            "initial[0].axis: \"z\" must be x or y");
  EXPECT_EQ(refusal([](json& t) { t["initial"][0]["length"] = nullptr; }),
            "initial[0].length: it is missing; give a number");
  EXPECT_EQ(refusal([](json& t) { t["threads"] = 0; }),
            "threads: it is 0; it must be a positive integer");
}

} // namespace
} // namespace kerf::fem
