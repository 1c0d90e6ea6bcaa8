// The face of the engine: interface forces, own forces, threads, what is lost.
#include "tests/cases/dem_models.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cstring>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;

// (own + interface) * inverse mass is the acceleration; v^(1/2) = v^0 + a dt / 2 in the first step.
TEST(Engine, integrates_own_and_interface_forces) {
  auto settings = cases::irregular_model<3>(3, rock(3, 0.5), 2);
  cases::shake(settings, 1e-3, 3);
  settings.damping = {.kind = dem::DampingKind::nonviscous, .translation = 0.2, .rotation = 0.1};
  dem::Engine<3> engine(settings);
  const double dt = 1e-8;
  engine.start(dt);
  const std::vector<std::uint32_t> points = {2, 5, 11};
  std::vector<double> inverse(9), own(9), x(9), v(9), x_after(9), v_after(9);
  const std::vector<double> force = {1.0, -2.0, 3.0, 0.5, 0.0, 0.0, 0.0, -7.0, 1.0};
  engine.inverse_mass(points, inverse);
  for (int n = 0; n < 5; ++n) {
    engine.motion(points, x, v);
    engine.compute_own_forces();
    engine.compute_own_forces(); // changes nothing
    engine.own_forces(points, own);
    engine.add_interface_forces(points, force);
    engine.integrate();
    engine.motion(points, x_after, v_after);
    for (std::size_t k = 0; k < 9; ++k) {
      const double a = (own[k] + force[k]) * inverse[k];
      const double expected = v[k] + (n == 0 ? 0.5 : 1.0) * a * dt;
      EXPECT_NEAR(v_after[k], expected, 1e-13 * std::abs(expected));
      EXPECT_NEAR(x_after[k], x[k] + expected * dt, 1e-18);
    }
  }
}

// Work of a constant force on a free particle: F (x - x_0) between t_0 and t_n, and no other energy
// than the kinetic one. Tolerance: rounding.
TEST(Engine, books_the_work_of_interface_forces) {
  dem::Settings<2> settings;
  settings.positions = {{0.0, 0.0}};
  settings.radii = {0.5 * spacing};
  settings.material = rock(2);
  dem::Engine<2> engine(settings);
  engine.start(1e-6);
  const std::uint32_t points[] = {0};
  const double half[] = {1.0, 0.5};
  double start = 0.0;
  for (int n = 0; n <= 10; ++n) {
    const Vec<2> u = engine.particles().displacement[0];
    engine.compute_own_forces();
    engine.add_interface_forces(points, half); // two couplings may meet in one particle
    engine.add_interface_forces(points, half);
    engine.integrate();
    const auto e = engine.energies();
    start = n == 0 ? e.kinetic : start; // -m (a dt / 2)² / 2: v^(-1/2) and v^(1/2) are opposite
    EXPECT_NEAR(e.interface_work, 2.0 * u[0] + 1.0 * u[1], 1e-13 * std::abs(e.kinetic));
    EXPECT_NEAR(e.kinetic - start, e.interface_work, 1e-13 * std::abs(e.kinetic));
  }
}

/// All numbers that a run leaves behind: bonds that break, a floor, weight, a load, damping.
/// @param in_one  every block goes through the whole step at once
std::vector<double> run_with(int threads, bool in_one = false) {
  omp_set_num_threads(threads);
  auto settings = cases::irregular_model<2>(45, rock(2, 0.5), 9);
  settings.material.friction = 0.4;
  settings.material.tensile_strength = 4e3;
  settings.material.shear_strength = 4e3;
  settings.damping.translation = 0.1;
  settings.gravity = {0.0, -9.81};
  settings.applied_forces.resize(1);
  settings.applied_forces[0].box = {Vec<2>::Constant(-1.0), Vec<2>::Constant(1.0)};
  settings.applied_forces[0].force[0] = kerf::TimeTable(10.0);
  dem::WallMaterial stiff;
  stiff.normal_stiffness = 1e10;
  settings.tools = {{"floor", dem::ToolShape<2>(dem::Plane<2>{{0.0, 0.0}, {0.0, 1.0}}), {}, stiff}};
  cases::shake(settings, 5.0, 3);
  dem::Engine<2> engine(settings);
  engine.start(0.5 * 2.0 / std::sqrt(engine.step_limit().omega2));
  for (int n = 0; n < 400; ++n) {
    if (!in_one)
      engine.compute_own_forces();
    engine.integrate();
  }
  EXPECT_LT(engine.bonds(), engine.bonds_at_start());
  EXPECT_GT(-engine.tools()[0].load().force[1], 0.0);
  EXPECT_GT(engine.renewals(), 0u);
  const auto e = engine.energies();
  std::vector<double> numbers = {e.kinetic, e.elastic, e.damping_dissipation,
                                 e.friction_dissipation, e.fracture_dissipation};
  for (std::size_t i = 0; i < engine.size(); ++i) {
    const auto& p = engine.particles();
    numbers.insert(numbers.end(), {p.displacement[i][0], p.displacement[i][1], p.velocity[i][0],
                                   p.velocity[i][1], p.angular_velocity[i][0]});
  }
  for (const dem::Crack<2>& crack : engine.cracks())
    numbers.insert(numbers.end(), {crack.place[0], crack.place[1], crack.energy});
  return numbers;
}

TEST(Engine, gives_the_same_bits_with_one_and_with_two_threads) {
  const int threads = omp_get_max_threads();
  const auto one = run_with(1);
  for (const auto& [count, in_one] : {std::pair{2, false}, {1, true}, {3, true}}) {
    const auto other = run_with(count, in_one);
    ASSERT_EQ(other.size(), one.size());
    EXPECT_EQ(std::memcmp(other.data(), one.data(), one.size() * sizeof(double)), 0)
        << count << " threads, in one call: " << in_one;
  }
  omp_set_num_threads(threads);
}

// A sphere a hundred times as large as those it falls on: the step chosen before they touch holds,
// nothing is lost. Reference: momentum, and the energy but for what closing contacts miss.
TEST(Engine, collides_particles_with_a_radius_ratio_of_100) {
  using cases::spacing;
  auto settings =
      cases::lattice_model<3>(dem::LatticeType::cubic, {12, 12, 1}, cases::rock(3, 0.2));
  for (double& radius : settings.radii)
    radius *= 0.98;
  settings.positions.emplace_back(5.5 * spacing, 5.5 * spacing, 50.49 * spacing);
  settings.radii.push_back(50.0 * spacing);
  settings.bonds = false;
  settings.initial.resize(1);
  settings.initial[0].box = Box<3>{{-1.0, -1.0, 40.0 * spacing}, {1.0, 1.0, 1.0}};
  settings.initial[0].velocity = {0.0, 0.0, -0.05};
  dem::Engine<3> engine(settings);
  engine.start(0.8 * 2.0 / std::sqrt(engine.step_limit_to_come().omega2));
  cases::step(engine);
  const Vec<3> momentum = engine.momentum();
  const double energy = engine.energies().kinetic;
  double most_elastic = 0.0;
  for (int n = 0; n < 4000; ++n) {
    cases::step(engine);
    most_elastic = std::max(most_elastic, engine.energies().elastic);
  }
  const dem::Energies e = engine.energies();
  double fastest = 0.0; // of the small ones; an elastic push gives twice the velocity
  for (std::size_t i = 0; i + 1 < engine.size(); ++i)
    fastest = std::max(fastest, engine.particles().velocity[i].norm());
  EXPECT_GT(most_elastic, 0.0);
  EXPECT_GT(fastest, 0.05);
  EXPECT_LT((engine.momentum() - momentum).norm(), 1e-10 * momentum.norm());
  EXPECT_NEAR(e.kinetic + e.elastic + e.friction_dissipation, energy, 1e-4 * energy);
}

// A grain far from everything falls beside a bonded body and hinders nobody.
TEST(Engine, lets_an_isolated_particle_fall) {
  auto settings = cases::lattice_model<2>(dem::LatticeType::square, {4, 4}, cases::rock(2, 0.2));
  settings.positions.emplace_back(1.0, 1.0);
  settings.radii.push_back(0.1 * cases::spacing);
  settings.gravity = {0.0, -9.81};
  dem::Engine<2> engine(settings);
  const double dt = 0.8 * 2.0 / std::sqrt(engine.step_limit_to_come().omega2), t = 1000 * dt;
  EXPECT_LT(dt, 2.0 / std::sqrt(engine.step_limit().omega2)); // it is the lightest
  engine.start(dt);
  for (int n = 0; n < 1000; ++n)
    cases::step(engine);
  EXPECT_NEAR(engine.particles().displacement.back()[1], -0.5 * 9.81 * t * t, 1e-12 * t * t);
  EXPECT_EQ(engine.first_not_finite(), std::nullopt);
}

TEST(Engine, survives_a_number_that_is_lost_and_says_where) {
  auto settings = cases::lattice_model<2>(dem::LatticeType::triangular, {6, 6}, rock(2));
  dem::Engine<2> engine(settings);
  engine.start(1e-7);
  const std::uint32_t points[] = {8};
  const double force[] = {std::nan(""), 0.0};
  EXPECT_EQ(engine.first_not_finite(), std::nullopt);
  engine.compute_own_forces();
  engine.add_interface_forces(points, force);
  engine.integrate();
  EXPECT_EQ(engine.first_not_finite(), 8u);
  for (int n = 0; n < 50; ++n)
    cases::step(engine);
}

TEST(Engine, blown_up_by_a_step_far_too_large_ends) {
  auto settings = cases::lattice_model<2>(dem::LatticeType::triangular, {6, 6}, rock(2));
  cases::shake(settings, 1.0, 2);
  dem::Engine<2> engine(settings);
  engine.start(100.0 / std::sqrt(engine.step_limit().omega2));
  for (int n = 0; n < 500; ++n)
    cases::step(engine);
  EXPECT_NE(engine.first_not_finite(), std::nullopt);
}

TEST(Engine, refuses_weights_that_are_negative_or_do_not_fit) {
  dem::Engine<2> engine(cases::pair_model<2>({1.0, 0.0}, rock(2)));
  const double negative[] = {1.0, -0.1}, one[] = {1.0};
  EXPECT_THROW(engine.set_weights(negative), std::invalid_argument);
  EXPECT_THROW(engine.set_weights(one), std::invalid_argument);
}

} // namespace
} // namespace kerf
