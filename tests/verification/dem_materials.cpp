// Contacts between two materials, against the closed forms of both, and a body of rock and grains.
#include "tests/cases/mixed_body.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kerf {
namespace {

using cases::glass;
using cases::rock;
using cases::spacing;
using std::numbers::pi;

/// Two particles along x whose surfaces overlap, of two materials.
template <int dim>
dem::Settings<dim> two(const dem::Material& a, const dem::Material& b, double r_a, double r_b,
                       double overlap) {
  dem::Settings<dim> settings;
  settings.positions = {Vec<dim>::Zero(), (r_a + r_b - overlap) * Vec<dim>::UnitX()};
  settings.radii = {r_a, r_b};
  settings.material = a;
  settings.other_materials = {b};
  settings.material_of = {0, 1};
  settings.bonds = false;
  return settings;
}

/// Force on the first at the start, N.
template <int dim> double normal_force(const dem::Settings<dim>& settings) {
  dem::Engine<dim> engine(settings);
  engine.start(1e-9);
  engine.compute_own_forces();
  return engine.contacts().normal_force[0];
}

// Reference: H. Hertz (1881), F = 4/3 E* sqrt(R*) delta^(3/2), 1/E* = sum of (1 - nu²)/E.
// Tolerance: the overlap is 1e-3 of the distance and known to 1e-13 of itself.
TEST(Materials, two_spheres_press_one_another_by_the_moduli_of_both) {
  dem::Material steel = glass();
  steel.young_modulus = 2e11;
  steel.poisson_ratio = 0.3;
  const double r_a = 1e-3, r_b = 3e-3, overlap = 2e-6;
  const double compliance = (1.0 - 0.25 * 0.25) / 2e9 + (1.0 - 0.3 * 0.3) / 2e11; // 1/E*, 1/Pa
  const double F =
      4.0 / 3.0 / compliance * std::sqrt(r_a * r_b / (r_a + r_b)) * std::pow(overlap, 1.5);
  verify({"force between spheres of two materials", "H. Hertz (1881)", 1e-9, "rounding"},
         normal_force(two<3>(glass(), steel, r_a, r_b, overlap)) / -F - 1.0);
  verify({"force between spheres of two materials", "H. Hertz (1881)", 1e-9, "rounding"},
         normal_force(two<3>(steel, glass(), r_b, r_a, overlap)) / -F - 1.0);
}

// Reference: R.D. Mindlin (1949), k_t = 8 G* sqrt(R* delta), 1/G* = sum of (2 - nu)/G.
TEST(Materials, two_spheres_shear_one_another_by_the_moduli_of_both) {
  dem::Material steel = glass();
  steel.young_modulus = 2e11;
  steel.poisson_ratio = 0.3;
  steel.friction = 0.9;
  auto settings = two<3>(glass(), steel, 1e-3, 3e-3, 2e-6);
  settings.material.friction = 0.9;
  dem::Engine<3> engine(settings);
  auto particles = engine.particles();
  auto contacts = engine.contacts();
  const double slip = 1e-9;
  const std::vector<dem::Aligned<Vec<3>>> moved = {Vec<3>::Zero(), slip * Vec<3>::UnitY()};
  const std::vector<dem::Aligned<Rot<3>>> turned(2);
  particles.displacement[1] += moved[1];
  dem::Loads<3> loads;
  dem::compute_contact_forces(contacts, particles, {moved, turned, 1.0},
                              dem::ShearIncrement::midpoint, loads);
  const double compliance = (2.0 - 0.25) * 2.0 * 1.25 / 2e9 + (2.0 - 0.3) * 2.0 * 1.3 / 2e11;
  const double k_t = 8.0 / compliance * std::sqrt(0.75e-3 * 2e-6);
  verify({"tangential stiffness between spheres of two materials", "R.D. Mindlin (1949)", 1e-9,
          "square of the slip over the distance"},
         contacts.shear_force[0].norm() / (k_t * slip) - 1.0);
}

// Reference: springs in series. A particle has half of the compliance of a contact with its like.
TEST(Materials, linear_particles_are_springs_in_series) {
  dem::Material hard = rock(3, 0.2), soft = rock(3, 0.5);
  soft.normal_stiffness = 3e6;
  soft.tangential_stiffness = 1e6;
  const auto contact = [](const dem::Settings<3>& settings) {
    return dem::Engine<3>(settings).contacts();
  };
  const auto check = [](const char* what, double stiffness, double wanted) {
    verify({what, "compliances of both add up", 1e-15, "rounding"}, stiffness / wanted - 1.0);
  };
  const auto given = contact(two<3>(hard, soft, 1e-3, 2e-3, 0.0));
  check("stiffness between two linear materials", given.normal_stiffness[0],
        2.0 / (1.0 / 1e7 + 1.0 / 3e6));
  check("stiffness between two linear materials", given.tangential_stiffness[0],
        2.0 / (1.0 / 2e6 + 1.0 / 1e6));

  dem::Material by_size;
  by_size.density = 2600.0;
  by_size.contact_modulus = 5e9;
  by_size.stiffness_ratio = 0.4;
  dem::Material weak = by_size;
  weak.contact_modulus = 1e9;
  weak.stiffness_ratio = 0.1;
  const auto sized = contact(two<3>(by_size, weak, 1e-3, 2e-3, 0.0));
  check("stiffness between two materials by size", sized.normal_stiffness[0],
        1.0 / (1.0 / (4.0 * 5e9 * 1e-3) + 1.0 / (4.0 * 1e9 * 2e-3)));
  check("stiffness between two materials by size", sized.tangential_stiffness[0],
        1.0 / (1.0 / (0.4 * 4.0 * 5e9 * 1e-3) + 1.0 / (0.1 * 4.0 * 1e9 * 2e-3)));

  const auto both = contact(two<3>(hard, weak, 1e-3, 2e-3, 0.0));
  check("stiffness between a linear material and one by size", both.normal_stiffness[0],
        1.0 / (1.0 / 2e7 + 1.0 / (4.0 * 1e9 * 2e-3)));
}

// Closed form: half a swing of the reduced mass, with the density of each. Tolerance: a step at
// either end, of 20000; the frequency of central differences, (omega dt)²/24.
TEST(Materials, a_collision_takes_half_a_swing_of_both_masses) {
  dem::Material heavy = rock(3, 0.0), light = rock(3, 0.0);
  heavy.density = 7800.0;
  light.density = 800.0;
  const double r = 1e-3, k = heavy.normal_stiffness;
  auto settings = two<3>(heavy, light, r, r, 0.0);
  dem::InitialCondition<3> condition;
  condition.box = Box<3>{settings.positions[1], settings.positions[1]};
  condition.velocity = {-0.1, 0.0, 0.0};
  settings.initial = {condition};
  const double volume = 4.0 / 3.0 * pi * r * r * r;
  const double reduced = volume / (1.0 / 7800.0 + 1.0 / 800.0);
  const double duration = pi * std::sqrt(reduced / k), dt = duration / 20000.0;
  dem::Engine<3> engine(settings);
  engine.start(dt);
  int steps = 0;
  do
    cases::step(engine);
  while (++steps < 30000 &&
         engine.particles().displacement[1][0] < engine.particles().displacement[0][0]);
  verify({"duration of a collision of two densities", "half a swing", 2e-4, "steps of 1/20000"},
         steps * dt / duration - 1.0);
}

/// Energy that the books miss, over that at the start, and momentum likewise, while grains fall on
/// rock.
struct Missed {
  double energy = 0.0, momentum = 0.0;
  std::size_t cracks = 0, hertzian = 0, bonds = 0;
};
Missed missed(double share_of_limit) {
  auto settings = cases::rock_and_grains({5, 5, 6}, 0.3, 1.0);
  // Of spheres that stick while they are pressed more the tangential energy is not that of a spring.
  settings.other_materials[0].friction = settings.pairs[0].of_second.friction = 0.0;
  dem::Engine<3> engine(settings);
  const double dt = share_of_limit * 2.0 / std::sqrt(engine.step_limit().omega2);
  engine.start(dt);
  cases::step(engine);
  const auto total = [&] {
    const dem::Energies e = engine.energies();
    return e.kinetic + e.elastic + e.friction_dissipation + e.fracture_dissipation;
  };
  const double start = total();
  const Vec<3> momentum = engine.momentum();
  Missed result;
  for (double t = 0.0; t < 4e-5; t += dt) {
    cases::step(engine);
    result.energy = std::max(result.energy, std::abs(total() / start - 1.0));
    result.momentum =
        std::max(result.momentum, (engine.momentum() - momentum).norm() / momentum.norm());
  }
  const auto& c = engine.contacts();
  result.cracks = engine.cracks().size();
  result.bonds = engine.bonds();
  for (std::size_t k = 0; k < c.size(); ++k)
    result.hertzian += c.is_hertzian(k) && c.normal_force[k] < 0.0;
  return result;
}

// Contacts close and open, which the trapezoidal rule misses by a part that falls with the step.
TEST(Materials, rock_that_grains_run_into_keeps_energy_and_momentum) {
  const Missed coarse = missed(0.1), fine = missed(0.02);
  std::printf("energy missed %.1e, %.1e; %zu cracks, %zu bonds, %zu Hertzian contacts\n",
              coarse.energy, fine.energy, fine.cracks, fine.bonds, fine.hertzian);
  EXPECT_GT(fine.cracks, 5u);
  EXPECT_GT(fine.bonds, 20u);
  EXPECT_GT(fine.hertzian, 10u);
  verify({"momentum of rock and grains", "Newton's third law", 1e-12, "rounding"}, fine.momentum);
  verify({"energy of rock and grains", "work and losses", 1e-5,
          "contacts that open and close within a step"},
         fine.energy);
  EXPECT_LT(fine.energy, 0.5 * coarse.energy);
}

} // namespace
} // namespace kerf
