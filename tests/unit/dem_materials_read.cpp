// Materials and pairs as kerf-dem reads them from its table of the case.
#include "coupler/participant/participant.hpp"
#include "dem_core/program/read_settings.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace kerf {
namespace {

using nlohmann::json;

json table() {
  return json::parse(R"({
    "particles": {"lattice": {"type": "square", "spacing": 1e-3, "origin": [0.0, 0.0],
                              "count": [4, 3]}},
    "material": {"name": "rock", "density": 2600.0, "law": "linear", "normal_stiffness": 1e10,
                 "tangential_stiffness": 2e9, "friction": 0.5},
    "materials": [{"name": "left", "box": [[-1.0, -1.0], [1.5e-3, 1.0]], "density": 1000.0,
                   "law": "linear_by_size", "contact_modulus": 1e9, "stiffness_ratio": 0.2},
                  {"name": "some", "ids": [0, 11], "density": 8000.0, "law": "hertz_mindlin",
                   "young_modulus": 2e11, "poisson_ratio": 0.3}],
    "pairs": [{"between": ["some", "rock"], "law": "linear", "normal_stiffness": 3e9,
               "tangential_stiffness": 1e9, "friction": 0.1},
              {"between": ["left", "some"], "law": "hertz_mindlin", "young_modulus": 1e9,
               "poisson_ratio": 0.1, "bonds": false}]})");
}

std::string blamed_key(const json& broken) {
  try {
    dem::read_settings<2>(broken, json::object());
  } catch (const coupler::SettingsError& error) {
    return error.key();
  }
  return "nothing";
}

TEST(DemMaterials, are_of_the_particles_that_they_select_and_the_later_one_counts) {
  const auto s = dem::read_settings<2>(table(), json::object());
  EXPECT_EQ(s.other_materials.size(), 2u);
  EXPECT_EQ(s.other_materials[0].contact_modulus, 1e9);
  EXPECT_EQ(s.other_materials[1].density, 8000.0);
  ASSERT_EQ(s.material_of.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_EQ(s.material_of[i], i == 0 || i == 11 ? 2 : s.positions[i][0] < 1.5e-3 ? 1 : 0) << i;
}

TEST(DemMaterials, of_a_pair_are_both_with_what_the_pair_says) {
  const auto s = dem::read_settings<2>(table(), json::object());
  ASSERT_EQ(s.pairs.size(), 2u);
  EXPECT_EQ(s.pairs[0].first, 2);
  EXPECT_EQ(s.pairs[0].second, 0);
  EXPECT_EQ(s.pairs[0].of_first.law, dem::NormalLaw::linear);
  EXPECT_EQ(s.pairs[0].of_first.normal_stiffness, 3e9);
  EXPECT_EQ(s.pairs[0].of_second.normal_stiffness, 3e9);
  EXPECT_EQ(s.pairs[0].of_second.friction, 0.1);
  EXPECT_TRUE(s.pairs[0].bonds);
  EXPECT_EQ(s.pairs[1].of_second.young_modulus, 1e9);
  EXPECT_EQ(s.pairs[1].of_first.contact_modulus, 1e9); // of its bonds
  EXPECT_FALSE(s.pairs[1].bonds);
  EXPECT_NO_THROW(dem::Materials(s.material, s.other_materials, s.pairs));
}

TEST(DemMaterials, come_by_the_numbers_of_a_file) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("kerf_phases_" + std::to_string(::getpid()) + ".txt");
  std::ofstream file(path);
  for (int i = 0; i < 12; ++i)
    file << "0 0 " << i % 3 << '\n';
  file.close();
  auto t = table();
  t["materials"][1].erase("ids");
  t["materials"][1]["file"] = path.string();
  t["materials"][1]["number"] = 2;
  const auto s = dem::read_settings<2>(t, json::object());
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_EQ(s.material_of[i] == 2, i % 3 == 2) << i;
  t["materials"][1]["number"] = 7;
  EXPECT_EQ(blamed_key(t), "materials[1]");
  std::filesystem::remove(path);
}

TEST(DemMaterials, that_cannot_be_are_blamed_on_their_key) {
  auto t = table();
  t["materials"][0]["box"] = {{5.0, 5.0}, {6.0, 6.0}};
  EXPECT_EQ(blamed_key(t), "materials[0]"); // nobody is in it
  t = table();
  t["materials"][1]["ids"] = {3, 12};
  EXPECT_EQ(blamed_key(t), "materials[1].ids[1]");
  t = table();
  t["materials"][1].erase("young_modulus");
  EXPECT_EQ(blamed_key(t), "materials[1].young_modulus");
  t = table();
  t["pairs"][0]["between"] = {"some", "stone"};
  EXPECT_EQ(blamed_key(t), "pairs[0].between[1]");
  t = table();
  t["pairs"][1].erase("young_modulus"); // "left" has none
  EXPECT_EQ(blamed_key(t), "pairs[1].young_modulus");
  t = table();
  t["bonds"]["coordination_number"] = 4.0;
  EXPECT_EQ(blamed_key(t), "bonds.coordination_number");
}

} // namespace
} // namespace kerf
