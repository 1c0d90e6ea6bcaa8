// What kerf-dem reads: its table of the case, and packing files.
#include "common/packing_file.hpp"
#include "coupler/participant/participant.hpp"
#include "dem_core/program/read_settings.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>

namespace kerf {
namespace {

using nlohmann::json;

json table() {
  return json::parse(R"({
    "kind": "dem", "solver": "kerf-dem", "command": null, "threads": "auto",
    "particles": {"lattice": {"type": "triangular", "spacing": 1e-3, "origin": [0.0, 0.5],
                              "count": [4, 3]}, "file": null, "radius": null},
    "material": {"density": 2600.0, "normal_stiffness": 1e10, "tangential_stiffness": 2e9,
                 "tensile_strength": null, "shear_strength": 3e4, "friction": 0.0},
    "bonds": {"gap_tolerance": 1e-3},
    "damping": {"kind": "componentwise", "translation": 0.2, "rotation": 0.1},
    "boundary": [{"box": [[0, 0], [1, 1]], "components": ["y", "rotation"], "motion": "hann",
                  "velocity": null, "amplitude": [1e-6, 0], "duration": 1e-5}],
    "initial": [{"box": null, "kind": "pulse", "velocity": null, "amplitude": 1e-6, "center": 0.1,
                 "length": 0.032, "wave_speed": -2000, "spacing": 1e-3, "component": "y",
                 "axis": "x"}]})");
}

json case_table() {
  return json::parse(R"({"dimension": 2, "periodic": {"x": null, "y": [0.0, 0.0069], "z": null}})");
}

/// The key that a broken table is blamed on.
std::string blamed_key(const json& broken) {
  try {
    dem::read_settings<2>(broken, case_table());
  } catch (const coupler::SettingsError& error) {
    return error.key();
  }
  return "nothing";
}

TEST(DemSettings, are_read_from_the_table_of_the_case) {
  const auto s = dem::read_settings<2>(table(), case_table());
  EXPECT_EQ(s.positions.size(), 12u);
  EXPECT_EQ(s.positions[0], (Vec<2>(0.0, 0.5)));
  EXPECT_EQ(s.radii[0], 0.5e-3);
  EXPECT_TRUE(std::isinf(s.material.tensile_strength));
  EXPECT_EQ(s.material.shear_strength, 3e4);
  EXPECT_EQ(s.damping.kind, dem::DampingKind::componentwise);
  EXPECT_EQ(s.boundary[0].components, 2 | 4);
  EXPECT_EQ(s.boundary[0].motion, dem::Motion::hann);
  EXPECT_EQ(s.initial[0].pulse->component, 1);
  EXPECT_EQ(s.initial[0].pulse->wave_speed, -2000.0);
  EXPECT_EQ(s.period.length, (Vec<2>(0.0, 0.0069)));
  EXPECT_EQ(dem::read_threads(table()), std::nullopt);
}

TEST(DemSettings, that_cannot_be_used_are_blamed_on_their_key) {
  auto t = table();
  t["material"]["density"] = -1.0;
  EXPECT_EQ(blamed_key(t), "material.density");
  t["material"]["density"] = 0.0;
  EXPECT_EQ(blamed_key(t), "material.density");
  t = table();
  t["particles"]["lattice"]["type"] = "fcc";
  EXPECT_EQ(blamed_key(t), "particles.lattice");
  t = table();
  t["particles"]["radius"] = 0.0;
  EXPECT_EQ(blamed_key(t), "particles.radius");
  t = table();
  t["boundary"][0]["components"] = {"z"};
  EXPECT_EQ(blamed_key(t), "boundary[0].components[0]");
  t = table();
  t["initial"][0]["length"] = nullptr;
  EXPECT_EQ(blamed_key(t), "initial[0].length");
  t = table();
  t["particles"]["lattice"] = nullptr;
  EXPECT_EQ(blamed_key(t), "particles");
  t["particles"]["file"] = "/nowhere/at/all.txt";
  EXPECT_EQ(blamed_key(t), "particles.file");
}

class PackingFile : public testing::Test {
protected:
  void write(const std::string& text) { std::ofstream(path_) << text; }
  std::string error_of(const std::string& text, int dim = 2) {
    write(text);
    try {
      read_packing(path_, dim);
    } catch (const PackingError& error) {
      return std::string(error.what()).substr(path_.string().size());
    }
    return "no error";
  }
  void TearDown() override { std::filesystem::remove(path_); }

  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) /
      ("kerf_packing_" +
       std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(PackingFile, gives_positions_and_radii) {
  write("# a packing\n\n0 1e-3 5e-4  # the first\r\n\t+2e-3 0.0 2.5e-4");
  const Packing packing = read_packing(path_, 2);
  EXPECT_EQ(packing.positions, (std::vector<double>{0.0, 1e-3, 2e-3, 0.0}));
  EXPECT_EQ(packing.radii, (std::vector<double>{5e-4, 2.5e-4}));
}

TEST_F(PackingFile, faults_are_told_with_their_line) {
  EXPECT_EQ(error_of("0 0 1\n0 0\n"), ":2: a line must hold 3 values, x y r, but this one holds 2");
  EXPECT_EQ(error_of("0 0 1\n", 3), ":1: a line must hold 4 values, x y z r, but this one holds 3");
  EXPECT_EQ(error_of("0 0 1\n\n0 0 -1\n"), ":3: the radius -1 m must be positive");
  EXPECT_EQ(error_of("0 0 0\n"), ":1: the radius 0 m must be positive");
  EXPECT_EQ(error_of("0 zero 1\n"), ":1: \"zero\" is not a finite number");
  EXPECT_EQ(error_of("0 nan 1\n"), ":1: \"nan\" is not a finite number");
  EXPECT_EQ(error_of("# nothing\n"), " holds no particle");
}

json tool_table() {
  return json::parse(R"([{
    "name": "mill", "shape": "box", "point": null, "normal": null, "file": null, "tag": null,
    "scale": 1.0, "box": [[0.0, 1.0], [0.2, 2.0]], "normal_stiffness": 5e10,
    "tangential_stiffness": 1e10, "friction": 0.3, "seated": true, "reference": null,
    "velocity": null, "velocities": [[0.0, 0.0, 1.0], [2.0, 0.0, 5.0]],
    "rotation": {"axis": null, "rate": 2.0, "rates": null},
    "servo": {"direction": [1.0, 0.0], "force": null, "forces": [[0.0, 0.0], [1.0, 8.0]],
              "max_velocity": 0.1},
    "free": null, "free_rotation": {"inertia": 0.5, "moment": 0.25}}])");
}

TEST(DemSettings, of_tools_are_read_with_their_tables_of_times) {
  auto t = table();
  t["tools"] = tool_table();
  t["gravity"] = {0.0, -9.81};
  const auto s = dem::read_settings<2>(t, case_table());
  EXPECT_EQ(s.gravity, (Vec<2>(0.0, -9.81)));
  ASSERT_EQ(s.tools.size(), 1u);
  const auto& tool = s.tools[0];
  EXPECT_EQ(tool.name, "mill");
  EXPECT_EQ(tool.material.normal_stiffness, 5e10);
  EXPECT_TRUE(tool.material.seated);
  EXPECT_DOUBLE_EQ(enclosed_volume(*tool.shape.surface()), 0.2);
  EXPECT_EQ(tool.motion.reference, (Vec<2>(0.1, 1.5)));
  EXPECT_EQ(tool.motion.velocity[1].value(1.0), 3.0);
  EXPECT_EQ(tool.motion.rotation_rate.value(7.0), 2.0);
  EXPECT_EQ(tool.motion.servo->force.value(0.5), 4.0);
  EXPECT_EQ(tool.motion.free_rotation->moment, 0.25);
  EXPECT_FALSE(tool.motion.free_translation);
}

TEST(DemSettings, of_tools_that_cannot_be_are_blamed_on_their_key) {
  const auto blamed = [](const char* key, const json& value) {
    auto t = table();
    t["tools"] = tool_table();
    t["tools"][0][key] = value;
    return blamed_key(t);
  };
  EXPECT_EQ(blamed("box", {{0.0, 0.0}, {0.0, 1.0}}), "tools[0].box");
  EXPECT_EQ(blamed("shape", "ball"), "tools[0].shape");
  EXPECT_EQ(blamed("velocities", {{0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}}), "tools[0].velocities");
  EXPECT_EQ(blamed("normal_stiffness", 0.0), "tools[0].normal_stiffness");
  EXPECT_EQ(blamed("free", {{"axes", {"x"}}, {"mass", 1.0}, {"force", nullptr}}), "tools[0]");
}

} // namespace
} // namespace kerf
