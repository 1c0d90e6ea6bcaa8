// Each law of a body of elements wants its own keys and no others.
#include "tests/config/sample_case.hpp"

namespace kerf {
namespace {

const std::string moduli = "density = 2600.0\nyoung_modulus = 4e10\npoisson_ratio = 0.2\n";

/// The sample with another material of its elements.
std::string with_material(const std::string& keys) {
  return sample_with("density = 2358.0\nyoung_modulus = 1.2e10\npoisson_ratio = 0.2\n", keys);
}

/// "problem\n  Fix: fix" of the only fault; empty when there is none.
std::string told(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const std::string all = complaint(text, overrides);
  const std::size_t at = all.find("participants.far");
  return at == std::string::npos ? all : all.substr(at);
}

TEST(BrokenSolid, every_model_is_taken_with_its_keys) {
  for (const std::string& keys :
       {std::string("density = 2600.0\nC11 = 4e10\nC12 = 1e10\nfinite_strain = true\n"),
        std::string("model = \"transversely_isotropic\"\ndensity = 2600.0\nyoung_in_plane = 4e10\n"
                    "young_normal = 2e10\npoisson_in_plane = 0.2\npoisson_normal = 0.15\n"
                    "shear_normal = 1e10\naxis = [0.0, 1.0, 0.0]\n"),
        "model = \"neo_hookean\"\n" + moduli,
        "model = \"j2_plastic\"\nyield_stress = 4e8\n" + moduli,
        "model = \"j2_plastic\"\nyield_stress = 4e8\nhardening_modulus = 1e8\n"
        "saturation_stress = 1e8\nsaturation_exponent = 10.0\nreference_rate = 40.0\n"
        "rate_exponent = 5.0\n" +
            moduli,
        "model = \"j2_plastic\"\nhardening_table = [[0.0, 4e8], [0.1, 5e8]]\n" + moduli,
        "model = \"drucker_prager\"\ncohesion = 5e6\nfriction_angle = 40.0\n"
        "dilation_angle = 10.0\nfit = \"inner\"\ntension_cutoff = 1e6\n" +
            moduli,
        "model = \"isotropic_damage\"\ntensile_strength = 1e7\nfracture_energy = 100.0\n"
        "strength_ratio = 8.0\n" +
            moduli,
        "formulation = \"one_point\"\nhourglass_stiffness = 0.05\nhourglass_viscosity = 0.2\n"
        "linear_viscosity = 0.06\nquadratic_viscosity = 1.2\n" +
            moduli})
    EXPECT_EQ(told(with_material(keys)), "") << keys;
}

TEST(BrokenSolid, a_missing_key_is_told_with_all_that_the_model_needs) {
  EXPECT_EQ(told(with_material("model = \"drucker_prager\"\ncohesion = 5e6\n" + moduli)),
            "participants.far.material.friction_angle is missing.\n"
            "  Fix: model = \"drucker_prager\" needs density, cohesion, friction_angle.");
  EXPECT_EQ(told(with_material("model = \"j2_plastic\"\n" + moduli)),
            "participants.far.material has neither yield_stress nor hardening_table.\n"
            "  Fix: give one of them: where flow begins, or rows of plastic strain and stress.");
  EXPECT_EQ(told(with_material("model = \"j2_plastic\"\nyield_stress = 4e8\n"
                               "saturation_stress = 1e8\n" +
                               moduli)),
            "participants.far.material has only one of saturation_stress and saturation_exponent.\n"
            "  Fix: give both.");
}

TEST(BrokenSolid, a_key_of_another_model_is_told_with_the_models_that_use_it_and_the_nearest) {
  EXPECT_EQ(told(with_material("cohesion = 5e6\n" + moduli)),
            "participants.far.material.cohesion is given, but model = \"linear_elastic\" does not "
            "use it.\n"
            "  Fix: leave it out; it is for drucker_prager.");
  EXPECT_EQ(told(with_material("model = \"isotropic_damage\"\ntensile_strength = 1e7\n"
                               "fracture_energy = 100.0\nfriction_angle = 40.0\n" +
                               moduli)),
            "participants.far.material.friction_angle is given, but model = \"isotropic_damage\" "
            "does not use it.\n"
            "  Fix: leave it out; it is for drucker_prager.");
  EXPECT_EQ(told(with_material("model = \"neo_hookean\"\nfinite_strain = true\n" + moduli)),
            "participants.far.material.finite_strain is given, but model = \"neo_hookean\" does "
            "not use it.\n"
            "  Fix: leave it out; it is for linear_elastic, j2_plastic, drucker_prager, "
            "isotropic_damage, from_packing.");
  const std::string misspelt = told(with_material("cohesoin = 5e6\n" + moduli));
  EXPECT_EQ(misspelt.find("participants.far.material.cohesoin is not a key of an FEM material.\n"
                          "  Fix: did you mean cohesion? Allowed: "),
            0u)
      << misspelt;
}

TEST(BrokenSolid, values_that_no_solid_has_are_told) {
  EXPECT_EQ(told(with_material("model = \"drucker_prager\"\ncohesion = 5e6\nfriction_angle = 30.0\n"
                               "dilation_angle = 35.0\n" +
                               moduli)),
            "participants.far.material.dilation_angle = 35.0 is above friction_angle = 30.0.\n"
            "  Fix: give at most the angle of friction.");
  EXPECT_EQ(told(with_material(
                "model = \"drucker_prager\"\ncohesion = 5e6\nfriction_angle = 90.0\n" + moduli)),
            "participants.far.material.friction_angle = 90.0 must be at least 0 and less than 90.\n"
            "  Fix: give the angle of friction; of drucker_prager, for example 40.0.");
  EXPECT_EQ(
      told(with_material("model = \"j2_plastic\"\nhardening_table = [[0.1, 4e8], [0.1, 5e8]]\n" +
                         moduli)),
      "participants.far.material.hardening_table = [[0.1, 4e8], [0.1, 5e8]] is an array of "
      "2; it must be rows of two numbers, the first ascending.\n"
      "  Fix: give rows of plastic strain, from 0, and yield stress, instead of yield_stress; of "
      "j2_plastic, for example [[0.0, 4e8], [0.1, 5e8]].");
  EXPECT_EQ(told(with_material("density = 2600.0\nC11 = 1e10\nC12 = -6e9\n"),
                 {"participants.far.plane=stress"}),
            "participants.far.material.C12 = -6e9 with C11 = 1e10 is not a stable material.\n"
            "  Fix: give C12 between -C11 / 2 and C11.");
  EXPECT_EQ(told(with_material("density = 2600.0\nC11 = 1e10\nC12 = -6e9\n")), "");
  EXPECT_EQ(told(with_material("hourglass_stiffness = 0.1\n" + moduli)),
            "participants.far.material.hourglass_stiffness is given, but formulation = \"full\" "
            "does not use it.\n"
            "  Fix: leave it out, or give formulation = \"one_point\".");
}

TEST(BrokenSolid, several_materials_say_which_elements_are_of_them) {
  const std::string other = "\n[[participants.far.materials]]\n";
  EXPECT_EQ(told(with_material(moduli + other + "region = \"vein\"\n" + moduli)), "");
  EXPECT_EQ(told(with_material(moduli + other + "box = [[0.0, 0.0], [1.0, 1.0]]\n" + moduli)), "");
  EXPECT_EQ(told(with_material(moduli + other + moduli)),
            "participants.far.materials[0] has neither region nor box.\n"
            "  Fix: give one of them: it says which elements are of it; that of all others is "
            "[participants.far.material].");
  const std::string text =
      sample_with("[participants.far.material]\ndensity = 2358.0\nyoung_modulus = 1.2e10\n"
                  "poisson_ratio = 0.2\n",
                  "");
  EXPECT_EQ(told(text), "participants.far has no material.\n"
                        "  Fix: begin a table [participants.far.material], or tables "
                        "[[participants.far.materials]] with a region or a box each.");
}

TEST(BrokenSolid, axisymmetry_goes_with_neither_discs_nor_a_period_of_the_radius) {
  std::string text = sample_with("kind = \"fem\"\n", "kind = \"fem\"\nplane = \"axisymmetric\"\n");
  EXPECT_EQ(told(text),
            "participants.far.plane = \"axisymmetric\", but particles in 2D are discs.\n"
            "  Fix: give \"strain\" or \"stress\", or leave out the coupling.");
  text.erase(text.find("[[couplings]]"), text.find("[[measures]]") - text.find("[[couplings]]"));
  EXPECT_EQ(told(text), "");
  EXPECT_EQ(told(text, {"case.periodic.x=[0.005, 0.025]"}),
            "participants.far.plane = \"axisymmetric\", but case.periodic.x is given.\n"
            "  Fix: leave one of them out: x is the radius.");
}

TEST(BrokenSolid, a_packing_whose_moduli_are_not_known_is_told) {
  const std::string from = "model = \"from_packing\"\nparticipant = \"rock\"\n";
  EXPECT_EQ(
      told(with_material(from)),
      "participants.far.material.participant = \"rock\": the moduli are not known, its lattice "
      "is neither triangular nor fcc.\n"
      "  Fix: give model = \"linear_elastic\" with density, C11 and C12.");
  EXPECT_EQ(told(with_material(from), {"participants.rock.particles.lattice.type=triangular"}), "");
  EXPECT_NE(told(with_material(from), {"participants.rock.particles.lattice.type=triangular",
                                       "participants.rock.bonds.kind=none"})
                .find("its particles are not bonded"),
            std::string::npos);
  EXPECT_EQ(told(with_material("model = \"from_packing\"\nparticipant = \"rocks\"\n")),
            "participants.far.material.participant = \"rocks\" has no particles.\n"
            "  Fix: did you mean rock?");
  EXPECT_EQ(told(with_material(from + "density = 2600.0\n"),
                 {"participants.rock.particles.lattice.type=triangular"}),
            "participants.far.material.density is given, but model = \"from_packing\" does not use "
            "it.\n"
            "  Fix: leave it out; it is for linear_elastic, transversely_isotropic, neo_hookean, "
            "j2_plastic, drucker_prager, isotropic_damage.");
}

TEST(BrokenSolid, what_2d_means_is_written_with_the_case) {
  EXPECT_EQ(parse(sample).settings()["participants"]["far"]["plane"], "strain");
}

} // namespace
} // namespace kerf
