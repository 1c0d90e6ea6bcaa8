// The laws of a contact against closed forms: impacts, dashpots, bonds that bend and twist.
#include "tests/cases/dem_models.hpp"

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

/// Two equal spheres that are about to touch along x; the second one moves.
template <int dim>
dem::Settings<dim> collision(const dem::Material& material, const Vec<dim>& velocity) {
  auto settings = cases::pair_model<dim>(Vec<dim>::UnitX(), material);
  settings.bonds = false;
  dem::InitialCondition<dim> condition;
  condition.box = Box<dim>{settings.positions[1], settings.positions[1]};
  condition.velocity = velocity;
  settings.initial = {condition};
  return settings;
}

/// What a collision was like.
template <int dim> struct Impact {
  double duration = 0.0, overlap = 0.0, force = 0.0; // s, m, N
  Vec<dim> velocity;                                 // of the second less the first, after it
  Rot<dim> spin;                                     // of the second, after it
};
template <int dim> Impact<dim> collide(const dem::Settings<dim>& settings, double dt) {
  dem::Engine<dim> engine(settings);
  engine.start(dt);
  Impact<dim> impact;
  bool touched = false;
  for (int n = 0; n < 10000000; ++n) {
    cases::step(engine);
    const double force = -engine.contacts().normal_force[0];
    if (force > 0.0) {
      touched = true;
      impact.duration += dt;
      impact.force = std::max(impact.force, force);
      const auto& p = engine.particles();
      impact.overlap = std::max(impact.overlap, -(p.displacement[1][0] - p.displacement[0][0]));
    } else if (touched) {
      break;
    }
  }
  const auto& p = engine.particles();
  impact.velocity = p.velocity[1] - p.velocity[0];
  impact.spin = p.angular_velocity[1];
  return impact;
}

dem::Material glass() {
  dem::Material material;
  material.density = 2500.0;
  material.law = dem::NormalLaw::hertz_mindlin;
  material.young_modulus = 70e9;
  material.poisson_ratio = 0.23;
  return material;
}

// Reference: H. Hertz (1881): with E*, R* = r/2 and m* = m/2, the largest overlap is
// (15 m* v² / (16 sqrt(R*) E*))^(2/5), and the impact takes 2 delta / v times the integral of
// 1/sqrt(1 - x^(5/2)) from 0 to 1, which is 1.4716. Tolerance: 3000 steps an impact, first order at
// its two ends.
TEST(Hertz, impact_has_the_overlap_force_and_duration_of_the_closed_form) {
  const dem::Material material = glass();
  const double m = material.density * 4.0 / 3.0 * pi * std::pow(radius, 3);
  const double E = material.young_modulus / (2.0 * (1.0 - std::pow(material.poisson_ratio, 2)));
  const double integral = std::sqrt(pi) * std::tgamma(0.4) / (2.5 * std::tgamma(0.9));
  for (const double v : {0.1, 5.0}) {
    const double overlap =
        std::pow(15.0 * 0.5 * m * v * v / (16.0 * std::sqrt(0.5 * radius) * E), 0.4);
    const double force = 4.0 / 3.0 * E * std::sqrt(0.5 * radius) * std::pow(overlap, 1.5);
    const double duration = 2.0 * integral * overlap / v;
    const auto impact = collide<3>(collision<3>(material, {-v, 0.0, 0.0}), duration / 3000.0);
    EXPECT_NEAR(impact.overlap, overlap, 1e-5 * overlap);
    EXPECT_NEAR(impact.force, force, 1e-5 * force);
    EXPECT_NEAR(impact.duration, duration, 1e-3 * duration);
    EXPECT_NEAR(impact.velocity[0], v, 1e-5 * v);
  }
}

// Reference: a spring and dashpot end with e times the velocity they began with; for spheres of
// Hertz T. Antypov & J.A. Elliott (2011), whatever the velocity. Tolerance: the velocity of the
// dashpot is half a step old, and the last step leaves the contact; both fall with the step.
TEST(Dashpots, give_the_coefficient_of_restitution_at_any_velocity) {
  for (const double e : {0.9, 0.5}) {
    dem::Material linear = rock(3);
    linear.restitution = e;
    const double m = linear.density * 4.0 / 3.0 * pi * std::pow(radius, 3);
    const double time = pi * std::sqrt(0.5 * m / linear.normal_stiffness);
    for (const double v : {0.01, 1.0}) {
      const auto impact = collide<3>(collision<3>(linear, {-v, 0.0, 0.0}), time / 2000.0);
      EXPECT_NEAR(impact.velocity[0], e * v, 3e-3 * v) << "linear, e = " << e;
    }
    dem::Material hertz = glass();
    hertz.restitution = e;
    for (const double v : {0.1, 5.0}) {
      const auto impact = collide<3>(collision<3>(hertz, {-v, 0.0, 0.0}), 1e-9);
      EXPECT_NEAR(impact.velocity[0], e * v, 6e-3 * v) << "Hertz, e = " << e;
    }
  }
}

// Reference: N. Maw, J.R. Barber & J.N. Fawcett, Wear 38 (1976) 101,
// doi:10.1016/0043-1648(76)90201-2 in its linear form: a contact that sticks swings in shear at
// omega_t² = k_t / m* (1 + m r² / I) while it swings once at omega_n² = k_n / m*, so its tangential
// velocity at the end is cos(pi omega_t / omega_n) of that at the start. Tolerance: 1000 steps an
// impact; the contact turns by 1e-4.
template <int dim> void sticks(double inertia_factor) {
  dem::Material material = rock(dim, 0.3);
  material.friction = 1e6;
  const double v = 1e-3;
  Vec<dim> velocity = Vec<dim>::Zero();
  velocity[0] = -v;
  velocity[1] = 0.5 * v;
  const auto settings = collision<dim>(material, velocity);
  const double m = dem::Engine<dim>(settings).particles().mass[0];
  const double omega_n = std::sqrt(material.normal_stiffness / (0.5 * m));
  const double omega_t =
      std::sqrt(material.tangential_stiffness / (0.5 * m) * (1.0 + 1.0 / inertia_factor));
  const auto impact = collide<dim>(settings, pi / omega_n / 1000.0);
  // Both spheres turn alike: the surfaces move by r (omega_i + omega_j) against their centres.
  const double after = impact.velocity[1] - 2.0 * radius * impact.spin[rotations<dim> - 1];
  EXPECT_NEAR(after, 0.5 * v * std::cos(pi * omega_t / omega_n), 5e-3 * v);
}
TEST(ObliqueImpact, that_sticks_swings_in_shear_in_2D) {
  sticks<2>(0.5);
}
TEST(ObliqueImpact, that_sticks_swings_in_shear_in_3D) {
  sticks<3>(0.4);
}

// Reference: the same paper: an impact that slides all the time loses 2 mu (1 + m r² / I) v_n of
// its tangential velocity, and gains spin 2 mu m v_n r / I on either side with v_n half the
// approach.
TEST(ObliqueImpact, that_slides_loses_what_friction_takes) {
  dem::Material material = glass();
  material.friction = 0.1;
  const double v = 0.1;
  const auto impact = collide<3>(collision<3>(material, {-v, 2.0 * v, 0.0}), 2e-10);
  EXPECT_NEAR(impact.velocity[1], 2.0 * v - 2.0 * material.friction * v, 2e-3 * v);
  EXPECT_NEAR(std::abs(impact.spin[2]) * radius, material.friction * v / 0.4, 2e-3 * v);
}

/// Two bonded particles that turn against each other, and the steps of half a swing.
template <int dim> int steps_of_half_a_swing(const Rot<dim>& axis, double dt) {
  auto material = rock(dim, 0.4);
  material.bond_radius_ratio = 0.8;
  dem::Engine<dim> engine(cases::pair_model<dim>(Vec<dim>::UnitX(), material));
  auto particles = engine.particles();
  auto contacts = engine.contacts();
  const double I = particles.inertia[0];
  std::vector<Rot<dim>> omega = {-axis, axis};
  dem::Loads<dim> loads;
  const std::vector<Vec<dim>> rest(2, Vec<dim>::Zero());
  for (int n = 0;; ++n) {
    dem::compute_contact_forces<dim>(contacts, particles, {rest, omega, dt, dt},
                                     dem::ShearIncrement::midpoint, 0.0, loads);
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
  EXPECT_NEAR(steps_of_half_a_swing<2>(Rot<2>(1.0), dt),
              expected(1e10 * R * R / 3.0, inertia(2), dt), 2.0);
  EXPECT_NEAR(steps_of_half_a_swing<3>(Vec<3>::UnitY(), dt),
              expected(1e7 * R * R / 4.0, inertia(3), dt), 2.0);
  EXPECT_NEAR(steps_of_half_a_swing<3>(Vec<3>::UnitX(), dt),
              expected(4e6 * R * R / 2.0, inertia(3), dt), 2.0);
}

// Reference: a Timoshenko beam of n bonds with EI = k_b d and G A_s = k_t d under a force at its
// tip. Its joints are discrete: u = P (n / k_t + d² n (4 n² - 1) / (12 k_b)), which tends to
// P L³ / (3 EI) + P L / (G A_s). The tip is moved to and fro once in some 60 swings of the
// beam; tolerance: the square of that, 3e-4.
template <int dim> void bends() {
  constexpr int bonds = 8, steps = 200000;
  std::array<int, dim> count;
  count.fill(1);
  count[0] = bonds + 1;
  auto material = rock(dim, 0.4);
  material.bond_radius_ratio = 1.0;
  auto settings = cases::lattice_model<dim>(dem::LatticeType::chain, count, material);
  const double deflection = 1e-4 * bonds * spacing;
  auto clamp = cases::prescribe_at<dim>(settings.positions.front(), dem::Motion::fixed);
  clamp.components |= 1u << dim;
  auto tip = cases::prescribe_at<dim>(settings.positions.back(), dem::Motion::hann);
  tip.components = 1u << 1;
  tip.amplitude[1] = deflection;
  settings.boundary = {clamp, tip};
  settings.damping = {.kind = dem::DampingKind::nonviscous, .translation = 0.3, .rotation = 0.3};
  dem::Engine<dim> engine(settings);
  const double dt = 0.8 * 2.0 / std::sqrt(engine.step_limit().omega2);
  settings.boundary[1].duration = steps * dt;
  engine = dem::Engine<dim>(settings);
  engine.start(dt);
  for (int n = 0; n < steps / 2; ++n)
    cases::step(engine);
  engine.compute_own_forces();
  const double k_b = material.normal_stiffness * radius * radius / (dim == 2 ? 3.0 : 4.0);
  const double compliance = bonds / material.tangential_stiffness +
                            spacing * spacing * bonds * (4.0 * bonds * bonds - 1.0) / (12.0 * k_b);
  for (const std::size_t k : {0, 4, 7}) {
    const double P = dem::contact_force(engine.contacts(), engine.particles(), k)[1];
    EXPECT_NEAR(P * compliance / deflection, 1.0, 3e-4) << "bond " << k;
  }
}
TEST(BondWithMoments, chain_bends_like_a_timoshenko_beam_in_2D) {
  bends<2>();
}
TEST(BondWithMoments, chain_bends_like_a_timoshenko_beam_in_3D) {
  bends<3>();
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
    const std::vector<Vec<2>> rest(2, Vec<2>::Zero());
    const std::vector<Rot<2>> turns = {Rot<2>(-0.5 * turn), Rot<2>(0.5 * turn)};
    dem::compute_contact_forces<2>(contacts, engine.particles(), {rest, turns, 1.0},
                                   dem::ShearIncrement::midpoint, 0.0, loads);
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
  const std::vector<Vec<2>> rest(2, Vec<2>::Zero());
  const double F_n = 1e-4 * spacing * material.normal_stiffness;
  const double k_b = material.tangential_stiffness * std::pow(0.5 * radius, 2);
  const double limit = 0.2 * 0.5 * radius * F_n;
  double moment = 0.0;
  for (int n = 1; n <= 40; ++n) {
    const double turn = 0.1 * limit / k_b;
    const std::vector<Rot<2>> turns = {Rot<2>(-0.5 * turn), Rot<2>(0.5 * turn)};
    dem::compute_contact_forces<2>(contacts, engine.particles(), {rest, turns, 1.0},
                                   dem::ShearIncrement::midpoint, 1e6, loads);
    moment = std::min(limit, 0.1 * n * limit);
    EXPECT_NEAR(loads.own[0].moment[0], moment, 1e-9 * limit) << n;
    EXPECT_NEAR(loads.own[1].moment[0], -moment, 1e-9 * limit) << n;
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
