// The settings of a finite element participant: from JSON to mesh and engine, and what is refused.
#include "fem_core/program/read_settings.hpp"

#include "fem_core/input_error.hpp"
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

/// Reads all of a participant; gives "key: sentence" of what is refused.
std::string refusal(const std::function<void(json&)>& change, const Period<2>& period = {}) {
  json table = participant();
  change(table);
  try {
    const Table settings(table, "");
    const Mesh<2> mesh = read_mesh(settings, period);
    read_settings(settings, mesh);
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
