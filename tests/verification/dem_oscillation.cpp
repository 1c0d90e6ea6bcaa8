// One bond: its vibration, and its critical time step.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;

/// A pair along x whose particles leave with -v and +v.
template <int dim> dem::Settings<dim> parting_pair(double speed) {
  auto settings = cases::pair_model<dim>(Vec<dim>::UnitX(), rock(dim));
  for (const int side : {0, 1}) {
    dem::InitialCondition<dim> condition;
    const Vec<dim> x = settings.positions[static_cast<std::size_t>(side)];
    condition.box = Box<dim>{x, x};
    condition.velocity[0] = side == 0 ? -speed : speed;
    settings.initial.push_back(condition);
  }
  return settings;
}

// Reference: the difference equation d'' = -Omega² d, Omega² = 2 k_n / m, with d_0 = 0 and
// d_1 = 2 v dt has the solution d_n = 2 v dt sin(n phi) / sin(phi), sin(phi / 2) = Omega dt / 2.
// Tolerance: the phase collects one rounding error a step, 1000 * 2e-16, and the solution's own
// evaluation as much again.
template <int dim> void pair_follows_the_difference_solution() {
  const double speed = 1e-3; // m/s
  dem::Engine<dim> engine(parting_pair<dim>(speed));
  const double omega = std::sqrt(2.0 * 1e7 * (dim == 2 ? 1e3 : 1.0) / engine.particles().mass[0]);
  const double dt = 0.4 / omega;
  const double phi = 2.0 * std::asin(0.5 * omega * dt);
  const double largest = 2.0 * speed * dt / std::sin(phi);
  engine.start(dt);
  double worst = 0.0;
  for (int n = 1; n <= 1000; ++n) {
    cases::step(engine);
    const auto& u = engine.particles().displacement;
    worst = std::max(worst, std::abs((u[1][0] - u[0][0]) / largest - std::sin(n * phi)));
    ASSERT_EQ(u[1][1] - u[0][1], 0.0);
  }
  verify({"swing of a bonded pair over 1000 steps, " + std::to_string(dim) + "D",
          "solution of the difference equation, d_n ~ sin n phi", 1e-12, "rounding of 1000 phases"},
         worst);
}
TEST(BondedPair, follows_the_exact_solution_of_the_difference_equation_in_2D) {
  pair_follows_the_difference_solution<2>();
}
TEST(BondedPair, follows_the_exact_solution_of_the_difference_equation_in_3D) {
  pair_follows_the_difference_solution<3>();
}

// Reference: as above with shear; relative motion s = u_j - u_i - r (theta_i + theta_j) across the
// bond has Omega² = k_t (2 / m + 2 r² / I), which is 6 k_t / m for discs, 7 k_t / m for spheres.
// Tolerance: the branch turns by v t / d = 1e-9, which the linear solution leaves out.
template <int dim> void shear_vibrates_with_both_inertias(double factor) {
  auto settings = cases::pair_model<dim>(Vec<dim>::UnitX(), rock(dim, 0.82));
  const double speed = 1e-9 * spacing; // per second of unit frequency below
  dem::Engine<dim> probe(settings);
  const double omega =
      std::sqrt(factor * settings.material.tangential_stiffness / probe.particles().mass[0]);
  for (const int side : {0, 1}) {
    dem::InitialCondition<dim> condition;
    const Vec<dim> x = settings.positions[static_cast<std::size_t>(side)];
    condition.box = Box<dim>{x, x};
    condition.velocity[1] = (side == 0 ? -1.0 : 1.0) * speed * omega;
    settings.initial.push_back(condition);
  }
  dem::Engine<dim> engine(settings);
  const double dt = 0.4 / omega;
  const double phi = 2.0 * std::asin(0.2);
  const double largest = 2.0 * speed * omega * dt / std::sin(phi); // of the slip, m
  engine.start(dt);
  double worst = 0.0;
  for (int n = 0; n < 300; ++n) {
    cases::step(engine);
    const double force = dem::shear_force(engine.contacts(), engine.particles(), 0)[1];
    worst = std::max(worst, std::abs(force / (settings.material.tangential_stiffness * largest) -
                                     std::sin(n * phi)));
  }
  verify({"shear force of a bonded pair that slides, " + std::to_string(dim) + "D",
          "difference equation with omega² = k_t (2 / m + 2 r² / I)", 1e-6,
          "the branch turns by 1e-9"},
         worst);
}
TEST(BondedPair, slides_with_six_times_the_tangential_stiffness_over_mass_in_2D) {
  shear_vibrates_with_both_inertias<2>(6.0);
}
TEST(BondedPair, slides_with_seven_times_the_tangential_stiffness_over_mass_in_3D) {
  shear_vibrates_with_both_inertias<3>(7.0);
}

// Reference: Rojek (2008) eq. 10, dt_cr = 2 / omega_max. Below it central differences stretch the
// bond to at most v dt_total..., from the solution above |d_n| <= 2 v dt / sin(phi); above it the
// solution grows by at least exp(2 acosh(1.01)) = 1.33 a step. Tolerance: rounding.
TEST(BondedPair, swings_below_the_critical_step_and_flies_apart_above_it) {
  const double speed = 1e-6;
  for (const double factor : {0.99, 1.01}) {
    dem::Engine<2> engine(parting_pair<2>(speed));
    const double omega = std::sqrt(2e10 / engine.particles().mass[0]);
    const double dt = factor * 2.0 / omega;
    engine.start(dt);
    double largest = 0.0;
    for (int n = 0; n < (factor < 1.0 ? 2000 : 40); ++n) {
      cases::step(engine);
      const auto& u = engine.particles().displacement;
      largest = std::max(largest, std::abs(u[1][0] - u[0][0]));
    }
    const double bound = 2.0 * speed * dt / std::sin(2.0 * std::asin(0.99));
    if (factor < 1.0)
      EXPECT_LE(largest, 1.001 * bound);
    else
      EXPECT_GT(largest, 1e3 * bound);
  }
}

} // namespace
} // namespace kerf
