// Tables of motion, applied forces and the reactions that hold particles.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::LatticeType;
using kerf::TimeTable;

template <int dim> Box<dim> around(const Vec<dim>& x, double reach = 1e-6) {
  return {x - Vec<dim>::Constant(reach), x + Vec<dim>::Constant(reach)};
}

/// Sum of m v^(n+1/2), N s.
template <int dim> Vec<dim> momentum_ahead(const dem::Engine<dim>& engine) {
  Vec<dim> sum = Vec<dim>::Zero();
  for (std::size_t i = 0; i < engine.size(); ++i)
    sum += engine.particles().mass[i] * engine.particles().velocity[i];
  return sum;
}

// Reference: the integral of a polygon. Tolerance: the rounding of 400 sums of steps, whose ends do
// not fall on the corners.
TEST(Tables, of_velocity_and_rotation_have_exact_positions) {
  auto settings = cases::lattice_model<3>(LatticeType::chain, {3, 1, 1}, rock(3));
  auto driven = cases::prescribe_at<3>(Vec<3>::Zero(), dem::Motion::table);
  const std::vector<double> times = {0.0, 1.03e-5, 2.57e-5};
  driven.velocities = {TimeTable(times, {0.0, 1e-3, -2e-3}), TimeTable(5e-4),
                       TimeTable(times, {1e-3, 1e-3, 0.0})};
  driven.components = 1 | 2 | 4 | 8;
  driven.axis = {0.0, 3.0, 4.0};
  driven.rotation_rate = TimeTable(times, {0.0, 10.0, 0.0});
  settings.boundary = {driven};
  dem::Engine<3> engine(settings);
  const double dt = 1e-7;
  engine.start(dt);
  Vec<3> turned = Vec<3>::Zero();
  for (int n = 0; n <= 400; ++n) {
    const double t = n * dt;
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(engine.particles().displacement[0][static_cast<int>(a)],
                  driven.velocities[a].integral(t), 1e-21)
          << n;
    EXPECT_LT((turned - driven.rotation_rate.integral(t) * Vec<3>(0.0, 0.6, 0.8)).norm(), 1e-17);
    cases::step(engine);
    turned += dt * engine.particles().angular_velocity[0];
  }
}

// Reference: a bond between two equal discs, one of which is held and the other one turned by
// theta, slips by r theta; its force k_t r theta has the arm r.
TEST(Reactions, of_a_disc_that_is_turned_are_those_of_the_tangential_spring) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2, 0.5));
  auto held = cases::prescribe_at<2>({0.0, 0.0}, dem::Motion::fixed);
  auto turned = cases::prescribe_at<2>({spacing, 0.0}, dem::Motion::fixed);
  held.components = turned.components = 1 | 2 | 4;
  turned.rotation_rate = TimeTable(2.0); // rad/s
  settings.boundary = {held, turned};
  dem::Engine<2> engine(settings);
  const double dt = 1e-7, r = 0.5 * spacing, k_t = settings.material.tangential_stiffness;
  engine.start(dt);
  for (int n = 0; n < 20; ++n) {
    cases::step(engine);
    const double theta = 2.0 * n * dt, force = k_t * r * theta; // of t_n
    EXPECT_NEAR(engine.reaction(1).moment[0], r * force, 1e-9 * k_t * r * r * 4e-6);
    EXPECT_NEAR(engine.reaction(0).moment[0], r * force, 1e-9 * k_t * r * r * 4e-6);
    EXPECT_NEAR(std::abs(engine.reaction(0).force[1]), force, 1e-9 * k_t * r * 4e-6);
    EXPECT_LT((engine.reaction(0).force + engine.reaction(1).force).norm(), 1e-9 * k_t * r * 4e-6);
    EXPECT_NEAR(engine.energies().external_work, 0.5 * k_t * r * r * theta * theta,
                1e-9 * k_t * r * r * 1e-11);
    EXPECT_EQ(engine.reactions().work_of(0).work(), 0.0);
  }
}

// Newton's second law for the whole body, in every step: nothing else acts than the two forces and
// what holds the two sets. The sets overlap; each component is held once.
template <int dim> void expect_reactions_and_loads_to_change_the_momentum() {
  auto settings = cases::irregular_model<dim>(4, rock(dim), 3);
  cases::shake(settings, 1e-2, 5);
  const auto half = [](double from, double to) {
    Vec<dim> lower = Vec<dim>::Constant(-1.0), upper = Vec<dim>::Constant(1.0);
    lower[0] = from * spacing;
    upper[0] = to * spacing;
    return Box<dim>{lower, upper};
  };
  settings.boundary.resize(3);
  settings.boundary[0].box = half(-1.0, 1.3);
  settings.boundary[0].components = 3;
  settings.boundary[1].box = half(-1.0, 0.6);
  settings.boundary[1].components = 2;
  settings.boundary[1].motion = dem::Motion::velocity;
  settings.boundary[1].velocity[1] = 3e-3;
  settings.boundary[2].box = half(-1.0, 0.8);
  settings.boundary[2].components = 1 << dim;
  settings.applied_forces.resize(2);
  settings.applied_forces[0].box = half(0.4, 9.0);
  settings.applied_forces[0].force[0] = TimeTable({0.0, 2e-6}, {0.0, 4.0});
  settings.applied_forces[1].box = half(0.4, 9.0);
  settings.applied_forces[1].force[1] = TimeTable(50.0);
  settings.applied_forces[1].is_total = true;
  dem::Engine<dim> engine(settings);
  const double dt = 0.2 * 2.0 / std::sqrt(engine.step_limit().omega2);
  engine.start(dt);
  cases::step(engine);
  double largest = 0.0;
  for (int n = 1; n < 100; ++n) {
    const Vec<dim> before = momentum_ahead(engine);
    cases::step(engine);
    Vec<dim> force =
        engine.applied_forces().total(0, n * dt) + engine.applied_forces().total(1, n * dt);
    for (std::size_t k = 0; k < 3; ++k)
      force += engine.reaction(k).force;
    largest = std::max(largest, force.norm());
    verify({"change of the momentum of a held and loaded body",
            "Newton's second law with reactions", 1e-10, "rounding of the sum over all particles"},
           (momentum_ahead(engine) - before - dt * force).norm() / (dt * largest));
  }
  EXPECT_GT(engine.reaction(1).force.norm(), 0.0);
}
TEST(Reactions, and_loads_are_all_that_changes_the_momentum_2d) {
  expect_reactions_and_loads_to_change_the_momentum<2>();
}
TEST(Reactions, and_loads_are_all_that_changes_the_momentum_3d) {
  expect_reactions_and_loads_to_change_the_momentum<3>();
}

// Reference: u = 1/2 F/m t² holds exactly at t_n in central differences; the work is F u.
TEST(Loads, accelerate_each_particle_or_all_alike) {
  dem::Settings<2> settings;
  settings.positions = {{0.0, 0.0}, {10.0 * spacing, 0.0}};
  settings.radii = {0.5 * spacing, spacing};
  settings.material = rock(2);
  const double F = 3.0; // N
  for (const bool is_total : {false, true}) {
    settings.applied_forces = {
        {.box = {{-1.0, -1.0}, {1.0, 1.0}}, .force = {}, .is_total = is_total}};
    settings.applied_forces[0].force[1] = TimeTable(F);
    dem::Engine<2> engine(settings);
    const auto& p = engine.particles();
    const double dt = 1e-6;
    engine.start(dt);
    for (int n = 0; n < 100; ++n)
      cases::step(engine);
    const double t = 100 * dt, before = 99 * dt, both = p.mass[0] + p.mass[1];
    double work = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const double a = is_total ? F / both : F / p.mass[i];
      const double force = is_total ? F * p.mass[i] / both : F;
      verify({"way of particles under an applied force", "1/2 F/m t²", 1e-12,
              "exact in central differences, to round-off"},
             p.displacement[i][1] / (0.5 * a * t * t) - 1.0);
      work += force * 0.5 * a * before * before; // until t_99
    }
    EXPECT_NEAR(engine.energies().external_work, work, 1e-12 * work);
    EXPECT_NEAR(engine.energies().kinetic, work, 1e-3 * work); // differs by (F dt)² / 8 m
    EXPECT_NEAR(engine.applied_forces().total(0, 0.0)[1], is_total ? F : 2.0 * F, 1e-12);
  }
}

// The identity of central differences in a linear system: kinetic + elastic = work, to round-off.
TEST(Loads, of_a_table_close_the_energy_books_of_a_chain) {
  auto settings = cases::lattice_model<2>(LatticeType::chain, {12, 1}, rock(2));
  settings.boundary = {cases::prescribe_at<2>({0.0, 0.0}, dem::Motion::table)};
  settings.boundary[0].velocities[0] = TimeTable({0.0, 3e-6, 5e-6}, {0.0, 0.1, -0.2});
  settings.applied_forces = {{.box = around<2>({11.0 * spacing, 0.0}), .force = {}}};
  settings.applied_forces[0].force[0] = TimeTable({0.0, 2e-6, 7e-6}, {0.0, 5e3, -1e3});
  dem::Engine<2> engine(settings);
  const double dt = 0.9 * 2.0 / std::sqrt(engine.step_limit().omega2);
  engine.start(dt);
  cases::step(engine);
  const double at_start = engine.energies().kinetic; // of the particle that the table moves
  for (int n = 1; n < 500; ++n) {
    cases::step(engine);
    const dem::Energies e = engine.energies();
    verify({"energy of a chain under tables of load and motion", "the work of both", 1e-11,
            "an identity of central differences, to round-off"},
           (e.kinetic + e.elastic - at_start - e.external_work) / (e.kinetic + e.elastic + 1e-9));
  }
}

// Reference: at rest the wall carries what is applied, on one side, with damping that ends all
// motion.
TEST(Reactions, carry_the_loads_at_rest) {
  auto settings = cases::lattice_model<3>(LatticeType::cubic, {6, 2, 2}, rock(3, 0.8));
  settings.damping = {.translation = 0.7, .rotation = 0.7};
  settings.boundary.resize(1);
  settings.boundary[0].box = {Vec<3>::Constant(-1e-4), {1e-4, 1.0, 1.0}};
  settings.boundary[0].components = 15;
  settings.applied_forces = {{.box = {{4.9e-3, -1.0, -1.0}, {1.0, 1.0, 1.0}}, .force = {}}};
  settings.applied_forces[0].force = {TimeTable(2.0), TimeTable(0.0), TimeTable(0.25)};
  dem::Engine<3> engine(settings);
  engine.start(0.8 * 2.0 / std::sqrt(engine.step_limit().omega2));
  for (int n = 0; n < 4000; ++n)
    cases::step(engine);
  const dem::Reaction<3> wall = engine.reaction(0);
  verify({"force of a wall that holds a loaded body at rest", "equilibrium", 1e-6,
          "what is left of the motion after 4000 steps"},
         (wall.force + Vec<3>(8.0, 0.0, 1.0)).norm() / Vec<3>(8.0, 0.0, 1.0).norm());
  Vec<3> moment = Vec<3>::Zero(); // of the loads about the middle of the wall, as it bends
  for (const std::uint32_t i : engine.applied_forces().particles(0))
    moment += (engine.particles().position(i) - Vec<3>(0.0, 0.5 * spacing, 0.5 * spacing))
                  .cross(Vec<3>(2.0, 0.0, 0.25));
  EXPECT_NEAR(moment[1], -5e-3, 1e-4);
  EXPECT_LT((wall.moment + moment).norm(), 1e-8);
  EXPECT_THROW(
      dem::AppliedForces<3>({{.box = around<3>({1.0, 1.0, 1.0}), .force = {}}}, engine.particles()),
      std::invalid_argument);
}

} // namespace
} // namespace kerf
