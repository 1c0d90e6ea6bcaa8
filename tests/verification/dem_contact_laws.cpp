// The laws of a contact against closed forms: bonds that bend and twist, rolling, constants.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include "dem_core/contact_constants.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using std::numbers::pi;

constexpr double radius = 0.5 * spacing;

/// Two bonded particles that turn against each other, and the steps of half a swing.
template <int dim> int steps_of_half_a_swing(const Rot<dim>& axis, double dt) {
  auto material = rock(dim, 0.4);
  material.bond_radius_ratio = 0.8;
  dem::Engine<dim> engine(cases::pair_model<dim>(Vec<dim>::UnitX(), material));
  auto particles = engine.particles();
  auto contacts = engine.contacts();
  const double I = particles.inertia[0];
  std::vector<dem::Aligned<Rot<dim>>> omega = {-axis, axis};
  dem::Loads<dim> loads;
  const std::vector<dem::Aligned<Vec<dim>>> rest(2);
  for (int n = 0;; ++n) {
    dem::compute_contact_forces<dim>(contacts, particles, {rest, omega, dt, dt},
                                     dem::ShearIncrement::midpoint, loads);
    for (int i = 0; i < 2; ++i)
      omega[static_cast<std::size_t>(i)] += dt / I * loads.own[static_cast<std::size_t>(i)].moment;
    if (omega[1].dot(axis) < 0.0)
      return n;
    EXPECT_NEAR((omega[0] + omega[1]).norm(), 0.0, 1e-12);
  }
}

// Closed form: opposite turns stretch neither spring, the moment k theta acts on both, so
// omega² = 2 k / I. k_b = k_n I/A, k_w = k_t J/A of the cross-section, a circle of 0.8 r (in 2D a
// strip of twice that): R²/4 and R²/2 (R²/3). A quarter of a swing, in 1000 steps.
TEST(BondWithMoments, swings_with_the_stiffness_of_its_cross_section) {
  const double R = 0.8 * radius;
  const auto expected = [](double k, double I, double dt) {
    return 0.5 * pi / std::sqrt(2.0 * k / I) / dt;
  };
  const auto inertia = [](int dim) {
    return dim == 2 ? 0.5 * 2600.0 * pi * std::pow(radius, 4)
                    : 0.4 * 2600.0 * 4.0 / 3.0 * pi * std::pow(radius, 5);
  };
  const double dt = 1e-10;
  const auto compare = [&](const std::string& what, int steps, double theory) {
    verify({"quarter of a swing of a bond that " + what, "omega² = 2 k / I, k of its cross-section",
            2e-3, "two steps of 1000"},
           steps / theory - 1.0);
  };
  compare("bends, 2D", steps_of_half_a_swing<2>(Rot<2>(1.0), dt),
          expected(1e10 * R * R / 3.0, inertia(2), dt));
  compare("bends, 3D", steps_of_half_a_swing<3>(Vec<3>::UnitY(), dt),
          expected(1e7 * R * R / 4.0, inertia(3), dt));
  compare("twists", steps_of_half_a_swing<3>(Vec<3>::UnitX(), dt),
          expected(4e6 * R * R / 2.0, inertia(3), dt));
}

// Stress at the edge of the cross-section: F_n / A + |M_b| r / I against the strength over A.
// In 2D, k_b = k_n R² / 3 and the lever is 3 / R: a relative rotation phi has the stress of the
// stretch R phi. Tolerance: rounding.
TEST(BondWithMoments, breaks_by_bending_where_the_edge_reaches_the_strength) {
  auto material = rock(2);
  material.bond_radius_ratio = 1.0;
  const double phi = 1e-4;
  material.tensile_strength = material.normal_stiffness * radius * phi;
  dem::Engine<2> engine(cases::pair_model<2>({1.0, 0.0}, material));
  const auto bonds_after = [&](double turn) {
    auto contacts = engine.contacts();
    dem::Loads<2> loads;
    const std::vector<dem::Aligned<Vec<2>>> rest(2);
    const std::vector<dem::Aligned<Rot<2>>> turns = {Rot<2>(-0.5 * turn), Rot<2>(0.5 * turn)};
    dem::compute_contact_forces<2>(contacts, engine.particles(), {rest, turns, 1.0},
                                   dem::ShearIncrement::midpoint, loads);
    return contacts.bonds();
  };
  EXPECT_EQ(bonds_after(phi * (1.0 - 1e-12)), 1u);
  EXPECT_EQ(bonds_after(phi * (1.0 + 1e-12)), 0u);
}

// The moment of a contact without bond stops at mu_r R* |F_n|, where the particles roll.
TEST(RollingResistance, is_bounded_by_the_normal_force) {
  auto material = rock(2);
  material.rolling_friction = 0.2;
  auto settings = cases::pair_model<2>({1.0, 0.0}, material);
  settings.bonds = false;
  settings.positions[1][0] *= 1.0 - 1e-4;
  dem::Engine<2> engine(settings);
  auto contacts = engine.contacts();
  dem::Loads<2> loads;
  const std::vector<dem::Aligned<Vec<2>>> rest(2);
  const double F_n = 1e-4 * spacing * material.normal_stiffness;
  const double k_b = material.tangential_stiffness * std::pow(0.5 * radius, 2);
  const double limit = 0.2 * 0.5 * radius * F_n;
  double moment = 0.0;
  for (int n = 1; n <= 40; ++n) {
    const double turn = 0.1 * limit / k_b;
    const std::vector<dem::Aligned<Rot<2>>> turns = {Rot<2>(-0.5 * turn), Rot<2>(0.5 * turn)};
    dem::compute_contact_forces<2>(contacts, engine.particles(), {rest, turns, 1.0},
                                   dem::ShearIncrement::midpoint, loads);
    moment = std::min(limit, 0.1 * n * limit);
    for (const std::size_t side : {0, 1})
      verify({"moment of rolling resistance over its limit",
              "mu_r R* F_n, doi:10.1016/j.powtec.2010.09.030", 1e-9,
              "rounding of an overlap of 1e-4"},
             loads.own[side].moment[0] / limit - (side == 0 ? moment : -moment) / limit);
  }
  EXPECT_NEAR(contacts.losses[0].friction, 30 * 0.1 * limit * limit / k_b, 1e-6 * limit);
}

// Stiffness and strength from the sizes: R* = r_i r_j / (r_i + r_j), the smaller radius counts for
// the cross-section.
TEST(Constants, follow_from_modulus_and_sizes) {
  dem::Material material;
  material.density = 2600.0;
  material.contact_modulus = 1e9;
  material.stiffness_ratio = 0.25;
  material.tensile_stress = 1e6;
  auto settings = cases::pair_model<3>(Vec<3>::UnitX(), material);
  settings.radii = {0.25 * spacing, 0.75 * spacing};
  const dem::Engine<3> engine(settings);
  const auto& c = engine.contacts();
  EXPECT_NEAR(c.normal_stiffness[0], 4e9 * 0.1875 * spacing, 1e-15 * c.normal_stiffness[0]);
  EXPECT_NEAR(c.tangential_stiffness[0], 0.25 * c.normal_stiffness[0], 1e-9);
  EXPECT_NEAR(c.tensile_strength[0], 1e6 * pi * std::pow(0.25 * spacing, 2), 1e-12);
  EXPECT_EQ(c.shear_strength[0], dem::Material::unbreakable);
}

} // namespace
} // namespace kerf
