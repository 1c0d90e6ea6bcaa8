// What a user reads whose materials and pairs cannot be.
#include "tests/config/sample_case.hpp"

namespace kerf {
namespace {

const std::string grains = R"([[participants.rock.materials]]
name = "grains"
box = [[0.0, 0.0], [1e-3, 1e-3]]
density = 1500.0
)";
const std::string glass = grains + R"(law = "hertz_mindlin"
young_modulus = 2e9
poisson_ratio = 0.25
)";
const std::string springs = "normal_stiffness = 1e9\ntangential_stiffness = 1e8\n";
const std::string rock_and_glass = R"([[participants.rock.pairs]]
between = ["default", "grains"]
)";

TEST(BrokenMaterials, good_ones_are_taken) {
  EXPECT_EQ(complaint(sample + grains + springs), "");
  EXPECT_EQ(complaint(sample + grains + springs + rock_and_glass + "friction = 0.1\n"), "");
  EXPECT_EQ(complaint(sample + glass + rock_and_glass + "law = \"linear\"\n" + springs), "");
  EXPECT_EQ(complaint(sample + glass + springs + rock_and_glass + "law = \"linear\"\n"), "");
}

TEST(BrokenMaterials, a_pair_of_an_unknown_material_is_told_with_the_nearest_one) {
  const std::string text = sample + grains + springs +
                           "[[participants.rock.pairs]]\nbetween = [\"default\", \"grain\"]\n";
  EXPECT_EQ(complaint(text),
            line_of(text, "between") +
                "participants.rock.pairs[0].between names \"grain\", which is not a material of "
                "participants.rock.\n  Fix: did you mean grains?");
}

TEST(BrokenMaterials, a_pair_that_is_given_twice_is_told) {
  const std::string text = sample + grains + springs + rock_and_glass +
                           "[[participants.rock.pairs]]\nbetween = [\"grains\", \"default\"]\n";
  EXPECT_EQ(complaint(text), line_of(text, "between") +
                                 "participants.rock.pairs[1].between = [\"grains\", "
                                 "\"default\"] is given twice.\n"
                                 "  Fix: give one table for each pair.");
}

TEST(BrokenMaterials, of_one_name_are_told) {
  std::string text = sample + grains + springs + grains + springs;
  EXPECT_NE(complaint(text).find("two materials of participants.rock are named \"grains\"."),
            std::string::npos)
      << complaint(text);
}

TEST(BrokenMaterials, two_laws_without_a_pair_that_has_one_are_told) {
  EXPECT_NE(complaint(sample + glass).find("have different laws"), std::string::npos)
      << complaint(sample + glass);
  const std::string text = sample + glass + rock_and_glass;
  EXPECT_EQ(complaint(text), line_of(text, "[[participants.rock.pairs]]") +
                                 "participants.rock.pairs[0].law is missing.\n  Fix: its materials "
                                 "have different laws: say which counts between them.");
}

TEST(BrokenMaterials, a_selection_is_one_of_box_ids_and_file) {
  const auto told = [](const std::string& more) {
    return complaint(sample + grains + springs + more);
  };
  EXPECT_NE(told("ids = [1]\n").find("materials[0] has box and ids."), std::string::npos);
  EXPECT_NE(told("number = 1\n").find("materials[0].number is given without a file."),
            std::string::npos);
}

TEST(BrokenMaterials, constants_that_need_one_another_are_told) {
  const std::string told =
      complaint(sample + grains + springs + rock_and_glass + "normal_stiffness = 1e9\n");
  EXPECT_NE(told.find("pairs[0] has only one of normal_stiffness and tangential_stiffness."),
            std::string::npos)
      << told;
  EXPECT_NE(complaint(sample + glass + "contact_modulus = 1e9\n").find("has only one of"),
            std::string::npos);
  // Of one material the constants of another law have no use.
  EXPECT_NE(complaint(sample_with("density = 2600.0", "density = 2600.0\nyoung_modulus = 1e9\n"
                                                      "poisson_ratio = 0.2"))
                .find("law = \"linear\" does not use it"),
            std::string::npos);
}

} // namespace
} // namespace kerf
