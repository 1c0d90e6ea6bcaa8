// What a case becomes: defaults, overrides, places, and the file that is written with a run.
#include "tests/config/sample_case.hpp"

#include "common/config/case_reader.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace kerf {
namespace {

using nlohmann::json;

TEST(Settings, every_default_is_filled_in) {
  const json settings = parse(sample).settings();
  const json& run = settings["case"];
  EXPECT_EQ(run["time_step"], "auto");
  EXPECT_EQ(run["time_step_factor"], 0.8);
  EXPECT_EQ(run["seed"], 1);
  EXPECT_EQ(run["periodic"], (json{{"x", nullptr}, {"y", nullptr}, {"z", nullptr}}));
  EXPECT_EQ(run["output"],
            (json{{"frames", 20}, {"history", 200}, {"checkpoints", 0}, {"keep_checkpoints", 2}}));
  const json& rock = settings["participants"]["rock"];
  EXPECT_EQ(rock["solver"], "kerf-dem");
  EXPECT_EQ(rock["bonds"]["gap_tolerance"], 1e-3);
  EXPECT_TRUE(rock["material"]["tensile_strength"].is_null());
  EXPECT_EQ(rock["boundary"], json::array());
  EXPECT_EQ(settings["couplings"][0]["method"], "lagrange");
  EXPECT_EQ(settings["measures"][0]["kind"], "energy_drift");
  EXPECT_TRUE(settings["measures"][0]["expect"]["min"].is_null());
}

TEST(Settings, numbers_are_floating_point_also_when_they_were_written_as_integers) {
  const json settings = parse(sample_with("density = 2600.0", "density = 2600")).settings();
  EXPECT_TRUE(settings["participants"]["rock"]["material"]["density"].is_number_float());
}

TEST(Settings, a_command_takes_the_place_of_the_solver) {
  const json settings =
      parse(sample, {R"(participants.rock.command=["python3", "mine.py"])"}).settings();
  EXPECT_TRUE(settings["participants"]["rock"]["solver"].is_null());
  EXPECT_NE(complaint(sample,
                      {R"(participants.rock.command=["a"])", "participants.rock.solver=kerf-dem"}),
            "");
}

TEST(Settings, paths_become_full_and_start_at_the_folder_of_the_case) {
  const auto folder = std::filesystem::temp_directory_path() / "kerf_settings_paths";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "packing.txt") << "0 0 1\n";
  std::ofstream(folder / "a.toml")
      << sample_with("[participants.rock.particles.lattice]\ntype = \"square\"\nspacing = 1e-3\n"
                     "origin = [0.0, 0.0]\ncount = [10, 4]\n",
                     "[participants.rock.particles]\nfile = \"./packing.txt\"\n");
  const CaseFile run = CaseFile::read(folder / "a.toml");
  EXPECT_EQ(run.settings()["participants"]["rock"]["particles"]["file"],
            (folder / "packing.txt").string());
  EXPECT_EQ(CaseFile::parse(run.to_toml(), "copy", "/").settings(), run.settings());
  std::filesystem::remove_all(folder);
}

TEST(Overrides, replace_values_by_dotted_key_by_index_and_by_name) {
  const json settings = parse(sample, {"case.seed=7", "couplings[0].method=penalty",
                                       "couplings.joint.stiffness_ratio=3", "case.output.frames=0",
                                       "participants.rock.particles.lattice.count=[3, 2]"})
                            .settings();
  EXPECT_EQ(settings["case"]["seed"], 7);
  EXPECT_EQ(settings["case"]["output"]["frames"], 0);
  EXPECT_EQ(settings["couplings"][0]["method"], "penalty");
  EXPECT_EQ(settings["couplings"][0]["stiffness_ratio"], 3.0);
  EXPECT_EQ(settings["participants"]["rock"]["particles"]["lattice"]["count"], (json{3, 2}));
}

TEST(Overrides, are_named_when_they_are_wrong) {
  EXPECT_TRUE(complaint(sample, {"participants.rock.material.densty=1"})
                  .starts_with("--set participants.rock.material.densty=1: "
                               "participants.rock.material.densty is not a key of a DEM material."))
      << complaint(sample, {"participants.rock.material.densty=1"});
  EXPECT_TRUE(
      complaint(sample, {"case.outputs.frames=1"}).starts_with("--set case.outputs.frames=1"))
      << complaint(sample, {"case.outputs.frames=1"});
  EXPECT_TRUE(
      complaint(sample, {"case.seed=-1"}).starts_with("--set case.seed=-1: case.seed = -1 "))
      << complaint(sample, {"case.seed=-1"});
  EXPECT_NE(complaint(sample, {"couplings.jont.width=1"}).find("did you mean joint?"),
            std::string::npos);
  for (const char* wrong : {"case.seed", "=1", "couplings[4].width=1", "couplings[0]x.width=1",
                            "case.name.x=1", "case..seed=1", "[0]=1", "couplings[]=1", "case.=1"})
    EXPECT_TRUE(complaint(sample, {wrong}).starts_with(std::string("--set ") + wrong)) << wrong;
}

TEST(Places, are_lines_of_keys_or_of_the_table_around_them) {
  const CaseFile run = parse(sample, {"case.seed=2"});
  const auto line = [&](const char* key) { return run.place_of(key).text() + ": "; };
  EXPECT_EQ(line("participants.far.boundary[0].tag"), line_of(sample, "tag = "));
  EXPECT_EQ(line("participants.far.mesh.type"), line_of(sample, "[participants.far.mesh]"));
  EXPECT_EQ(line("couplings.joint.width"), line_of(sample, "width = "));
  EXPECT_EQ(line("couplings[0].blending"), line_of(sample, "[[couplings]]"));
  EXPECT_EQ(line("case.seed"), "--set case.seed=2: ");
  EXPECT_EQ(run.place_of("nonsense").text(), "case.toml");
  EXPECT_EQ(
      std::string(run.error("couplings.joint.width", "The zone is too wide.", "less.").what()),
      line_of(sample, "width = ") + "The zone is too wide.\n  Fix: less.");
}

TEST(CaseAsRun, reads_back_to_the_same_settings) {
  for (const std::vector<std::string>& overrides :
       {std::vector<std::string>{},
        {"case.end_time=0.1234567890123456"},
        {"participants.rock.threads=2", "case.time_step=1e-9"},
        {R"(participants.rock.command=["a \"b\" \\ c", "tab	x", "ü"])"},
        {"case.periodic.y=[-1e-300, 1e300]", "case.seed=9223372036854775807"}}) {
    const CaseFile run = parse(sample, overrides);
    EXPECT_EQ(parse(run.to_toml()).settings(), run.settings());
    EXPECT_EQ(parse(run.to_toml()).to_toml(), run.to_toml());
  }
}

TEST(Reference, is_the_file_in_configs_and_loads) {
  const std::filesystem::path path = KERF_REFERENCE_CASE;
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, config::reference_toml()) << "write it anew from reference_toml()";
  const CaseFile run = CaseFile::read(path);
  EXPECT_EQ(run.settings()["case"]["name"], "reference");
  EXPECT_EQ(parse(run.to_toml()).settings(), run.settings());
}

} // namespace
} // namespace kerf
