// What is said of parameters that no material can have.
#include "fem_core/input_error.hpp"
#include "fem_core/laws/neo_hookean.hpp"
#include "fem_core/laws/transversely_isotropic.hpp"
#include "tests/cases/law_point.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace kerf {
namespace {

using fem::DruckerPrager;
using fem::Hardening;
using fem::IsotropicDamage;
using fem::IsotropicElastic;
using fem::TransverselyIsotropic;

void expect_refused(const std::function<void()>& make, const std::string& key,
                    const std::string& text) {
  try {
    make();
    ADD_FAILURE() << key << " is accepted";
  } catch (const fem::InputError& error) {
    EXPECT_EQ(error.key(), "material." + key);
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

TEST(LawParameters, of_elastic_materials_are_checked) {
  expect_refused([] { IsotropicElastic::from_young(0.0, 1e9, 0.2); }, "density", "0 kg/m³");
  expect_refused([] { IsotropicElastic::from_young(1.0, -1e9, 0.2); }, "young_modulus",
                 "-1000000000 Pa must be positive");
  expect_refused([] { IsotropicElastic::from_young(1.0, 1e9, 0.5); }, "poisson_ratio",
                 "0.5 must lie between -1 and 0.5");
  expect_refused([] { IsotropicElastic::from_moduli(1.0, 1e9, 2e9, 3); }, "C12", "C11");
  expect_refused([] { fem::NeoHookean::from(IsotropicElastic::from_young(1.0, 1e9, -0.1)); },
                 "poisson_ratio", "must not be negative");
}

TEST(LawParameters, of_a_layered_material_must_store_energy_in_every_strain) {
  const TransverselyIsotropic::Parameters good{.density = 2700.0,
                                               .young_in_plane = 60e9,
                                               .young_normal = 30e9,
                                               .poisson_in_plane = 0.0,
                                               .poisson_normal = 0.99,
                                               .shear_normal = 12e9,
                                               .axis = {0.0, 1.0, 1.0}};
  EXPECT_NO_THROW(TransverselyIsotropic::from(good, 3)); // nu_pn² < E_p / (2 E_n) = 1
  expect_refused([&] { TransverselyIsotropic::from(good, 2); }, "axis", "in the plane");
  auto bad = good;
  bad.poisson_normal = 1.01;
  expect_refused([&] { TransverselyIsotropic::from(bad, 3); }, "poisson_normal",
                 "between -1 and 1");
  bad = good;
  bad.axis = {0.0, 0.0, 0.0};
  expect_refused([&] { TransverselyIsotropic::from(bad, 3); }, "axis", "direction");
  bad = good;
  bad.shear_normal = 0.0;
  expect_refused([&] { TransverselyIsotropic::from(bad, 3); }, "shear_normal", "positive");
  bad = good;
  bad.poisson_in_plane = 1.0;
  expect_refused([&] { TransverselyIsotropic::from(bad, 3); }, "poisson_in_plane", "1 must lie");
}

TEST(LawParameters, of_hardening_and_rates_are_checked) {
  using Values = std::vector<double>;
  expect_refused([] { Hardening::linear(0.0, 1e9); }, "yield_stress", "positive");
  expect_refused([] { Hardening::linear(1e6, -1e9); }, "hardening_modulus", "negative");
  expect_refused([] { Hardening::voce(1e6, 1e6, 0.0); }, "saturation_exponent", "positive");
  expect_refused([] { Hardening::voce(1e6, -1e6, 1.0); }, "saturation_stress", "negative");
  expect_refused(
      [] {
        Hardening::table(Values{0.0, 0.1}, Values{1e6});
      },
      "hardening_table", "2 plastic strains and 1 yield stresses");
  expect_refused([] { Hardening::table(Values(33), Values(33)); }, "hardening_table", "1 to 32");
  expect_refused([] { Hardening::table(Values{0.1}, Values{1e6}); }, "hardening_table",
                 "0.1 of the first point must be 0");
  expect_refused(
      [] {
        Hardening::table(Values{0.0, 0.0}, Values{1e6, 2e6});
      },
      "hardening_table", "plastic strain 0 of point 2 must be above 0");
  expect_refused(
      [] {
        Hardening::table(Values{0.0, 1.0}, Values{2e6, 1e6});
      },
      "hardening_table", "yield stress 1000000 Pa of point 2 must not be below 2000000 Pa");
  expect_refused([] { fem::RateDependence::cowper_symonds(0.0, 5.0); }, "reference_rate",
                 "positive");
  expect_refused([] { fem::RateDependence::cowper_symonds(1.0, 0.5); }, "rate_exponent",
                 "0.5 must be at least 1");
}

TEST(LawParameters, of_drucker_prager_are_checked) {
  const auto refused = [](auto change, const std::string& key, const std::string& text) {
    auto parameters = cases::sandstone();
    change(parameters);
    expect_refused([&] { DruckerPrager::from(cases::rock(), parameters); }, key, text);
  };
  refused([](auto& p) { p.cohesion = -1.0; }, "cohesion", "negative");
  refused([](auto& p) { p.friction_angle = 1.6; }, "friction_angle", "1.6 rad");
  refused([](auto& p) { p.dilation_angle = 0.6; }, "dilation_angle", "0.6 rad");
  refused([](auto& p) { p.cohesion = p.friction_angle = p.dilation_angle = 0.0; }, "cohesion",
          "must be positive where friction_angle is 0");
  refused([](auto& p) { p.tension_cutoff = 18e6; }, "tension_cutoff", "apex of the cone");
}

TEST(LawParameters, of_damage_are_checked_with_the_size_of_the_element) {
  expect_refused(
      [] {
        IsotropicDamage::from(cases::rock(), {0.0, 10.0, 50.0});
      },
      "tensile_strength", "positive");
  expect_refused(
      [] {
        IsotropicDamage::from(cases::rock(), {5e6, 0.5, 50.0});
      },
      "strength_ratio", "at least 1");
  expect_refused(
      [] {
        IsotropicDamage::from(cases::rock(), {5e6, 10.0, -1.0});
      },
      "fracture_energy", "positive");
  EXPECT_NEAR(cases::brittle_rock().most_length(), 0.12, 1e-12); // 2 E G_f / f_t², m
  expect_refused([] { cases::brittle_rock().initial_history(0.13); }, "fracture_energy", "0.13 m");
}

} // namespace
} // namespace kerf
