// What acts on elements, and their stages: keys that need or exclude one another are told.
#include "tests/config/sample_case.hpp"

namespace kerf {
namespace {

/// The sample without its coupling, with more keys of its elements, and more tables.
std::string with(const std::string& keys, const std::string& tables = "") {
  const std::string kind = "[participants.far]\nkind = \"fem\"\n";
  std::string text = sample_with(kind, kind + keys + "\n");
  const std::size_t begin = text.find("[[couplings]]"), end = text.find("[[measures]]");
  return text.replace(begin, end - begin, tables + "\n");
}

void expect_told(const std::string& text, const std::string& sentence) {
  const std::string all = complaint(text);
  EXPECT_NE(all.find(sentence), std::string::npos) << all;
}

std::string boundary(const std::string& keys) {
  return with("", "[[participants.far.boundary]]\n" + keys);
}

TEST(BrokenElements, are_not_those_with_every_kind_of_action) {
  EXPECT_EQ(complaint(with(R"(
gravity = [0.0, -9.81]
in_situ_stress = { K0 = 0.5, surface = 1.0 }
loads = [{ tag = "top", pressure = 1e6 }, { box = [[0.0, 0.0], [1.0, 1.0]], force = [1.0, 0.0] },
         { tag = "left", tractions = [[0.0, 0.0, 0.0], [1.0, 1e6, 0.0]] }]
absorbing = [{ tag = "bottom", wave = { direction = [0.0, 1.0], velocity = 1.0, duration = 1.0 } },
             { tag = "left" }]
walls = [{ name = "anvil", tag = "left", point = [0.0, 0.0], normal = [1.0, 0.0] }]
probes = [{ name = "tip", point = [0.0, 0.0] }])",
                           R"(
[[participants.far.boundary]]
tag = "top"
motion = "symmetry"
[[participants.far.boundary]]
tag = "left"
motion = "displacement"
displacements = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]]
[[participants.far.boundary]]
tag = "bottom"
motion = "velocity"
velocities = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]]
[[stages]]
name = "dig"
duration = 1.0
[[stages.stop]]
name = "down"
participant = "far"
quantity = "displacement"
probe = "tip"
component = "y"
below = -1.0
[[stages.changes]]
participant = "far"
remove = ["excavation"]
damping = { mass = 1.0 }
loads = [{ tag = "top", pressure = 1e6 }]
boundary = [{ tag = "left", motion = "symmetry" }]
[[stages.changes]]
participant = "rock"
damping = { translation = 0.5 }
boundary = [{ box = [[0.0, 0.0], [1.0, 1.0]], motion = "fixed" }]
)")),
            "");
}

TEST(BrokenElements, a_motion_of_nodes_needs_its_own_keys_and_no_others) {
  expect_told(boundary("tag = \"top\"\nmotion = \"displacement\""),
              "participants.far.boundary[1].displacements is missing.\n"
              "  Fix: motion = \"displacement\" needs displacements.");
  expect_told(boundary("tag = \"top\"\nmotion = \"velocity\"\nvelocity = [1.0, 0.0]\n"
                       "velocities = [[0.0, 0.0, 0.0]]"),
              "participants.far.boundary[1] has both velocity and velocities.\n"
              "  Fix: give velocity for one value, or velocities for a table of times.");
  expect_told(boundary("box = [[0.0, 0.0], [1.0, 1.0]]\nmotion = \"symmetry\""),
              "participants.far.boundary[1].tag is missing.\n"
              "  Fix: give the tag of faces in a plane across an axis");
  expect_told(boundary("tag = \"top\"\ncomponents = [\"x\"]\nmotion = \"symmetry\""),
              "participants.far.boundary[1].components is given, but motion = \"symmetry\" holds "
              "the normal.");
}

TEST(BrokenElements, a_load_is_one_value_on_one_place) {
  expect_told(with("loads = [{ tag = \"top\" }]"),
              "participants.far.loads[0] has neither a force nor a traction nor a pressure.");
  expect_told(with("loads = [{ tag = \"top\", force = [1.0, 0.0], pressures = [[0.0, 1.0]] }]"),
              "participants.far.loads[0] has force and pressures.");
  expect_told(with("loads = [{ force = [1.0, 0.0] }]"),
              "participants.far.loads[0] has neither tag nor box.");
  expect_told(with("loads = [{ box = [[0.0, 0.0], [1.0, 1.0]], pressure = 1.0 }]"),
              "participants.far.loads[0].tag is missing, which pressure needs.");
}

TEST(BrokenElements, an_incoming_wave_is_a_pulse_or_a_table) {
  const auto wave = [](const std::string& keys) {
    return with("absorbing = [{ tag = \"top\", wave = { direction = [0.0, 1.0]" + keys + " } }]");
  };
  expect_told(wave(""), "participants.far.absorbing[0].wave has neither velocity nor velocities.");
  expect_told(wave(", velocity = 1.0"), "participants.far.absorbing[0].wave.duration is missing.");
  expect_told(wave(", duration = 1.0, velocities = [[0.0, 1.0]]"),
              "participants.far.absorbing[0].wave.duration is given without velocity.");
}

TEST(BrokenElements, stress_at_the_start_is_one_that_the_body_can_have) {
  const auto stress = [](const std::string& keys, const std::string& more = "") {
    return with("in_situ_stress = { " + keys + " }\n" + more);
  };
  expect_told(stress("stress = [1.0, 1.0, 1.0]"), "  Fix: give xx yy zz xy.");
  expect_told(stress("K0 = 0.5"), "participants.far.in_situ_stress.surface is missing.");
  expect_told(stress("K0 = 0.5, surface = 0.0"), "K0 is given, but there is no gravity.");
  expect_told(stress("K0 = 0.5, surface = 0.0", "gravity = [1.0, 1.0]"),
              "participants.far.gravity is not along an axis");
  expect_told(stress("stress = [1.0, 1.0, 1.0, 0.0]", "plane = \"stress\""),
              "participants.far.in_situ_stress has a component zz, but plane = \"stress\".");
  expect_told(sample_with("[participants.far]\nkind = \"fem\"\n",
                          "[participants.far]\nkind = \"fem\"\n"
                          "in_situ_stress.stress = [1.0, 1.0, 1.0, 0.0]\n"),
              "in_situ_stress is given, but coupled bodies begin without stress.");
}

TEST(BrokenElements, series_of_one_body_have_different_names) {
  expect_told(with("probes = [{ name = \"loads\", point = [0.0, 0.0] }]"),
              "two time series of participants.far are named \"loads\".");
  expect_told(with("probes = [{ name = \"a\", point = [0.0, 0.0] }]\nwalls = [{ name = \"a\", "
                   "tag = \"left\", point = [0.0, 0.0], normal = [1.0, 0.0] }]"),
              "two time series of participants.far are named \"a\".");
}

TEST(BrokenElements, a_stage_changes_what_the_participant_has) {
  const auto change = [](const std::string& keys) {
    return with("", "[[stages]]\nname = \"a\"\nduration = 1.0\n[[stages.changes]]\n" + keys);
  };
  expect_told(change("participant = \"far\"\nfriction = 0.5"),
              "stages[0].changes[0].friction is not a key of a change.");
  expect_told(change("participant = \"rock\"\nremove = [\"a\"]"),
              "stages[0].changes[0].remove is not a key of a change.");
  expect_told(change("participant = \"far\"\ndamping = { translation = 0.5 }"),
              "stages[0].changes[0].damping.translation is not a key of an FEM damping.");
  expect_told(change("participant = \"far\"\nloads = [{ tag = \"top\" }]"),
              "stages[0].changes[0].loads[0] has neither a force nor a traction nor a pressure.");
  expect_told(change("participant = \"far\"\nboundary = [{ tag = \"top\", motion = \"hann\" }]"),
              "stages[0].changes[0].boundary[0].amplitude is missing.");
}

TEST(BrokenElements, a_condition_is_of_what_elements_have) {
  const auto stop = [](const std::string& keys) {
    return with("", "[[case.stop]]\nname = \"a\"\nparticipant = \"far\"\nabove = 1.0\n" + keys);
  };
  expect_told(stop("quantity = \"cracks\""),
              "case.stop[0].quantity = \"cracks\" is not one of elements.\n"
              "  Fix: give one of unbalanced_force, kinetic_ratio, stress, displacement, force.");
  expect_told(stop("quantity = \"force\"\ncomponent = \"x\""), "case.stop[0].wall is missing.");
  expect_told(stop("quantity = \"stress\"\nprobe = \"p\"\ncomponent = \"xx\""),
              "case.stop[0].probe = \"p\" is not a probe of the participant.");
  expect_told(stop("quantity = \"kinetic_ratio\"\ntool = \"t\""), "case.stop[0].tool is given.");
}

} // namespace
} // namespace kerf
