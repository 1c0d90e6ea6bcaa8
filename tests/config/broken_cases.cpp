// Every fault of a case is told with file, line, key, the value found and what to write instead.
#include "tests/config/sample_case.hpp"

namespace kerf {
namespace {

TEST(BrokenCase, the_sample_itself_is_not_broken) {
  EXPECT_EQ(complaint(sample), "");
}

TEST(BrokenCase, a_missing_key_names_the_line_of_its_table) {
  EXPECT_EQ(complaint(sample_with("density = 2600.0\n", "")),
            line_of(sample, "[participants.rock.material]") +
                "participants.rock.material.density is missing.\n"
                "  Fix: give the density of the solid particles, for example 2600.0.");
}

TEST(BrokenCase, a_missing_table_names_the_line_of_its_participant) {
  const std::string text = sample_with("[participants.rock.material]\ndensity = 2600.0\n"
                                       "normal_stiffness = 1e10\ntangential_stiffness = 2e9\n",
                                       "");
  const std::string told = complaint(text);
  EXPECT_TRUE(told.starts_with(line_of(text, "[participants.rock]") +
                               "participants.rock.material.density is missing."))
      << told;
}

TEST(BrokenCase, a_contact_law_wants_its_own_constants_and_no_others) {
  const std::string told =
      complaint(sample_with("density = 2600.0", "density = 2600.0\nlaw = \"linear_by_size\""));
  EXPECT_NE(told.find("contact_modulus"), std::string::npos) << told;
  EXPECT_NE(told.find("normal_stiffness"), std::string::npos) << told;
}

TEST(BrokenCase, a_value_of_the_wrong_type_is_told_with_the_type_it_has) {
  const std::string text = sample_with("2600.0", "\"heavy\"");
  EXPECT_EQ(complaint(text),
            line_of(text, "density = \"heavy") +
                "participants.rock.material.density = \"heavy\" is text; it must be a number.\n"
                "  Fix: give the density of the solid particles, for example 2600.0.");
}

TEST(BrokenCase, an_unknown_key_is_told_with_the_nearest_one) {
  const std::string text = sample_with("density", "densty");
  const std::string told = complaint(text);
  EXPECT_NE(told.find(line_of(text, "densty") +
                      "participants.rock.material.densty is not a key of a DEM material.\n"
                      "  Fix: did you mean density? Allowed: density, law, normal_stiffness, "),
            std::string::npos)
      << told;
}

TEST(BrokenCase, a_key_of_the_other_kind_of_participant_is_unknown) {
  const std::string told = complaint(sample + "[participants.far.bonds]\ngap_tolerance = 0.1\n");
  EXPECT_NE(told.find("participants.far.bonds is not a key of an FEM participant."),
            std::string::npos)
      << told;
}

TEST(BrokenCase, an_unknown_table_at_the_top_is_told) {
  const std::string told = complaint(sample + "[[coupling]]\nname = \"a\"\n");
  EXPECT_NE(told.find("coupling is not a key of a case.\n  Fix: did you mean couplings?"),
            std::string::npos)
      << told;
}

TEST(BrokenCase, a_negative_radius_is_told_with_what_is_allowed) {
  const std::string text =
      sample_with("[participants.rock.material]", "[participants.rock.particles]\nradius = -1e-3\n"
                                                  "[participants.rock.material]");
  EXPECT_EQ(complaint(text), line_of(text, "radius") +
                                 "participants.rock.particles.radius = -0.001 must be greater than "
                                 "0.\n  Fix: give the radius of lattice particles; half of the "
                                 "spacing when not given, for example 0.5e-3.");
}

TEST(BrokenCase, a_value_out_of_range_is_told_with_the_range) {
  const std::string text = sample_with("translation = 0.2", "translation = 1.4");
  EXPECT_EQ(complaint(text),
            line_of(text, "translation") +
                "participants.rock.damping.translation = 1.4 must be from 0 to 1.\n"
                "  Fix: give the share of the resultant force that opposes the motion, "
                "for example 0.2.");
  EXPECT_NE(complaint(sample_with("poisson_ratio = 0.2", "poisson_ratio = 0.5")), "");
  EXPECT_NE(complaint(sample_with("end_time = 1e-4", "end_time = inf")), "");
  EXPECT_NE(complaint(sample_with("end_time = 1e-4", "end_time = nan")), "");
  EXPECT_NE(complaint(sample_with("end_time = 1e-4", "end_time = 1e-4\ntime_step = 0.0")), "");
}

TEST(BrokenCase, a_missing_file_is_told_with_the_path_that_was_tried) {
  const std::string text =
      sample_with("[participants.rock.particles.lattice]\ntype = \"square\"\nspacing = 1e-3\n"
                  "origin = [0.0, 0.0]\ncount = [10, 4]\n",
                  "[participants.rock.particles]\nfile = \"nowhere/packing.txt\"\n");
  const std::string told = complaint(text);
  EXPECT_TRUE(told.starts_with(line_of(text, "file = ") +
                               "participants.rock.particles.file = \"nowhere/packing.txt\": there "
                               "is no file /"))
      << told;
}

TEST(BrokenCase, two_participants_of_one_name_are_told) {
  const std::string text = sample + "[participants.rock]\nkind = \"dem\"\n";
  const std::string told = complaint(text);
  EXPECT_TRUE(told.starts_with(line_of(text, "[participants.rock]") +
                               "two participants are named \"rock\".\n  Fix: "))
      << told;
}

TEST(BrokenCase, a_key_that_is_given_twice_is_told) {
  const std::string told = complaint(sample_with("dimension = 2", "dimension = 2\ndimension = 2"));
  EXPECT_TRUE(told.starts_with("case.toml:4: dimension is given twice.")) << told;
}

TEST(BrokenCase, a_coupling_to_an_unknown_participant_is_told_with_the_nearest_one) {
  const std::string text = sample_with("between = [\"rock\",", "between = [\"rok\",");
  EXPECT_EQ(complaint(text), line_of(text, "between") +
                                 "couplings[0].between names \"rok\", which is not a participant.\n"
                                 "  Fix: did you mean rock? There are: far, rock.");
}

TEST(BrokenCase, an_overlap_needs_one_participant_of_each_kind) {
  const std::string told = complaint(sample_with("[\"rock\", \"far\"]", "[\"rock\", \"rock\"]"));
  EXPECT_NE(told.find("are participants of kind dem and dem.\n  Fix: an overlap needs one dem and "
                      "one fem participant."),
            std::string::npos)
      << told;
}

TEST(BrokenCase, two_couplings_or_measures_of_one_name_are_told) {
  const std::string couplings = sample +
                                "[[couplings]]\nname = \"joint\"\nbetween = [\"rock\", \"far\"]\n"
                                "boundary = \"right\"\nwidth = 1e-3\n";
  EXPECT_TRUE(complaint(couplings).starts_with(line_of(couplings, "name = ") +
                                               "two couplings are named \"joint\"."))
      << complaint(couplings);
  const std::string measures = sample + "[[measures]]\nname = \"energy_drift\"\n";
  EXPECT_TRUE(
      complaint(measures).starts_with(line_of(measures, "name = ") + "two measures are named "))
      << complaint(measures);
}

TEST(BrokenCase, a_vector_of_the_wrong_length_is_told_with_the_right_one) {
  const std::string text = sample_with("count = [10, 4]", "count = [10, 4, 2]");
  EXPECT_EQ(complaint(text), line_of(text, "count = [10") +
                                 "participants.rock.particles.lattice.count = [10, 4, 2] is an "
                                 "array of 3; it must be an array of 2 integers, one for each "
                                 "dimension.\n  Fix: give the number of particles along each axis; "
                                 "of fcc, of cells with 4 particles, for example [80, 8].");
}

TEST(BrokenCase, a_choice_that_is_none_is_told_with_the_choices) {
  const std::string told =
      complaint(sample_with("width = 4e-3", "width = 4e-3\nmethod = \"langrange\""));
  EXPECT_NE(told.find("couplings[0].method = \"langrange\" must be lagrange or penalty.\n"
                      "  Fix: did you mean lagrange?"),
            std::string::npos)
      << told;
}

TEST(BrokenCase, elastic_constants_are_one_pair_exactly) {
  EXPECT_NE(complaint(sample_with("poisson_ratio = 0.2\n", "")), "");
  EXPECT_NE(complaint(sample_with("poisson_ratio = 0.2\n", "C12 = 3e9\n")), "");
  EXPECT_NE(complaint(sample_with("poisson_ratio = 0.2\n", "poisson_ratio = 0.2\nC11 = 1e10\n")),
            "");
  EXPECT_EQ(complaint(sample_with("young_modulus = 1.2e10\npoisson_ratio = 0.2\n",
                                  "C11 = 1.4e10\nC12 = 3e9\n")),
            "");
}

TEST(BrokenCase, particles_come_from_exactly_one_source) {
  const std::string told =
      complaint(sample_with("[participants.rock.particles.lattice]\ntype = \"square\"\n"
                            "spacing = 1e-3\norigin = [0.0, 0.0]\ncount = [10, 4]\n",
                            ""));
  EXPECT_NE(told.find("participants.rock.particles has neither lattice nor file nor packing."),
            std::string::npos)
      << told;
  EXPECT_NE(complaint(sample, {"participants.rock.particles.packing={porosity=0.2}"})
                .find("participants.rock.particles has lattice and packing."),
            std::string::npos);
}

TEST(BrokenCase, a_motion_needs_its_own_keys_and_no_others) {
  const std::string no_duration =
      complaint(sample_with("motion = \"fixed\"", "motion = \"hann\"\namplitude = [1e-6, 0.0]"));
  EXPECT_NE(no_duration.find("participants.far.boundary[0].duration is missing."),
            std::string::npos)
      << no_duration;
  const std::string superfluous =
      complaint(sample_with("motion = \"fixed\"", "motion = \"fixed\"\nduration = 1.0"));
  EXPECT_NE(superfluous.find("duration is given, but motion = \"fixed\" does not use it."),
            std::string::npos)
      << superfluous;
}

TEST(BrokenCase, what_is_not_TOML_is_told_with_its_line) {
  const std::string text = sample_with("dimension = 2", "dimension == 2");
  const std::string told = complaint(text);
  EXPECT_TRUE(told.starts_with(line_of(text, "dimension") + "this is not TOML: ")) << told;
}

TEST(BrokenCase, several_faults_are_told_at_once_in_the_order_of_the_file) {
  std::string text = sample_with("density = 2600.0", "density = -1");
  text.replace(text.find("size = [0.02"), 4, "sise");
  const std::string told = complaint(text);
  const std::size_t density = told.find("density = -1"), sise = told.find("mesh.sise is not");
  ASSERT_NE(density, std::string::npos) << told;
  ASSERT_NE(sise, std::string::npos) << told;
  EXPECT_LT(density, sise);
}

TEST(BrokenCase, an_axis_that_a_plane_does_not_have_is_told) {
  EXPECT_NE(complaint(sample_with("motion = \"fixed\"", "motion = \"fixed\"\ncomponents = [\"z\"]"))
                .find("has \"z\", but case.dimension = 2."),
            std::string::npos);
  EXPECT_NE(complaint(sample, {"case.periodic.z=[0.0, 1.0]"}), "");
  EXPECT_NE(complaint(sample_with("\"square\"", "\"fcc\"")), "");
}

TEST(BrokenCase, names_that_cannot_be_part_of_a_file_name_are_told) {
  EXPECT_NE(complaint(sample_with("name = \"sample\"", "name = \"../sample\"")), "");
  EXPECT_NE(complaint(sample + "[participants.\"a/b\"]\nkind = \"dem\"\n"), "");
}

TEST(BrokenCase, a_case_without_participants_is_told) {
  EXPECT_NE(complaint("[case]\nname = \"a\"\ndimension = 2\nend_time = 1.0\n")
                .find("participants is missing."),
            std::string::npos);
  EXPECT_NE(complaint(""), "");
  EXPECT_NE(complaint("participants = 3\n[case]\nname = \"a\"\ndimension = 2\nend_time = 1.0\n"),
            "");
}

TEST(BrokenCase, a_measure_of_an_unknown_kind_or_participant_is_told) {
  EXPECT_NE(complaint(sample_with("name = \"energy_drift\"", "name = \"energy_drfit\""))
                .find("did you mean energy_drift?"),
            std::string::npos);
  EXPECT_NE(complaint(sample, {"measures[0].participant=rick"}).find("did you mean rock?"),
            std::string::npos);
  EXPECT_NE(complaint(sample, {"measures[0].coupling=join"}).find("did you mean joint?"),
            std::string::npos);
}

} // namespace
} // namespace kerf
