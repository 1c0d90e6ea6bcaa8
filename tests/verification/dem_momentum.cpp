// Momentum of free bodies, and rigid motion, which must cost nothing.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;

template <int dim> Rot<dim> angular_momentum(const dem::Particles<dim>& p) {
  Rot<dim> sum = Rot<dim>::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) // v^(n+1/2) with x^n and x^(n+1) gives the same
    sum += p.mass[i] * moment<dim>(p.position(i), p.velocity[i]) +
           p.inertia[i] * p.angular_velocity[i];
  return sum;
}

/// A free, shaken, blended body whose bonds break.
template <int dim> void momentum_is_kept(dem::Settings<dim> settings) {
  settings.material.friction = 0.5;
  settings.material.tensile_strength = settings.material.normal_stiffness * 1e-3 * spacing;
  settings.material.shear_strength = settings.material.tensile_strength;
  const double omega = std::sqrt(dem::Engine<dim>(settings).step_limit().omega2);
  const double speed = 5e-4 * spacing * omega;
  cases::shake(settings, speed, 5);
  dem::Engine<dim> engine(settings);
  std::vector<double> weight(engine.size());
  for (std::size_t i = 0; i < weight.size(); ++i)
    weight[i] = 0.1 + 0.8 * static_cast<double>(i) / static_cast<double>(weight.size());
  engine.set_weights(weight);
  engine.start(0.1 * 2.0 / omega);
  cases::step(engine);
  double mass = 0.0;
  for (const double m : engine.particles().mass)
    mass += m;
  double size = 0.0;
  for (const Vec<dim>& x : settings.positions)
    size = std::max(size, x.norm());
  const Vec<dim> linear = engine.momentum();
  const Rot<dim> angular = angular_momentum(engine.particles());
  for (int n = 0; n < 1000; ++n)
    cases::step(engine);
  EXPECT_LT(engine.bonds(), engine.bonds_at_start()) << "nothing broke: too easy";
  EXPECT_GT(engine.bonds(), 0u);
  // Tolerance: rounding of 1000 steps.
  const std::string body = " of a breaking blended body, " + std::to_string(dim) + "D";
  verify({"momentum" + body, "Newton's third law", 1e-12, "rounding of 1000 steps"},
         (engine.momentum() - linear).norm() / (mass * speed));
  verify({"angular momentum" + body, "Newton's third law", 1e-12, "rounding of 1000 steps"},
         (angular_momentum(engine.particles()) - angular).norm() / (mass * speed * size));
}
TEST(Momentum, linear_and_angular_of_a_breaking_blended_body_are_kept_in_2D) {
  momentum_is_kept(cases::irregular_model<2>(6, rock(2, 0.5), 11));
}
TEST(Momentum, linear_and_angular_of_a_breaking_blended_body_are_kept_in_3D) {
  momentum_is_kept(cases::irregular_model<3>(4, rock(3, 0.5), 12));
}

// Reference: forces depend on relative motion only. Tolerance: one rounding of the displacement,
// 2e-16 times 1 m, against k_n.
TEST(RigidMotion, translation_causes_no_force) {
  auto settings = cases::irregular_model<3>(4, rock(3, 0.5), 1);
  settings.initial.resize(1);
  settings.initial[0].velocity = {1.0, -2.0, 0.5};
  dem::Engine<3> engine(settings);
  engine.start(1e-7);
  for (int n = 0; n < 100; ++n)
    cases::step(engine);
  engine.compute_own_forces();
  const auto& c = engine.contacts();
  double largest = 0.0;
  for (std::size_t k = 0; k < c.size(); ++k)
    largest = std::max(largest, dem::contact_force(c, engine.particles(), k).norm());
  verify({"force in a body that translates, N", "forces depend on relative motion", 1e-11,
          "rounding of displacements of 2e-5 m times k_n"},
         largest);
}

/// Turns a body about an axis in equal steps, each contact carrying a start force with it.
template <int dim> void rigid_rotation_carries_forces_along(const Rot<dim>& axis) {
  dem::Engine<dim> engine(cases::irregular_model<dim>(dim == 2 ? 6 : 4, rock(dim, 0.5), 1));
  auto p = engine.particles();
  auto c = engine.contacts();
  dem::Loads<dim> loads;
  const std::size_t n = p.size();

  // A start state with shear in every contact.
  std::vector<dem::Aligned<Vec<dim>>> move(n);
  std::vector<dem::Aligned<Rot<dim>>> turn(n);
  for (std::size_t i = 0; i < n; ++i)
    for (int a = 0; a < dim; ++a)
      move[i][a] = 1e-3 * spacing * std::sin(static_cast<double>(7 * i) + 3.0 * a);
  p.displacement = move;
  dem::compute_contact_forces(c, p, {move, turn, 1.0}, dem::ShearIncrement::midpoint, loads);
  const auto start = c;
  const auto from = p;

  constexpr int steps = 1000;
  const double step = 1.0 / steps; // rad
  for (int k = 1; k <= steps; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      const Vec<dim> before = p.displacement[i];
      const Vec<dim> x = from.position(i);
      Vec<dim> rotated;
      if constexpr (dim == 2)
        rotated = Eigen::Rotation2Dd(k * step) * x;
      else
        rotated = Eigen::AngleAxisd(k * step, axis) * x;
      p.displacement[i] = rotated - p.reference[i];
      move[i] = p.displacement[i] - before;
      turn[i] = step * axis;
    }
    dem::compute_contact_forces(c, p, {move, turn, 1.0}, dem::ShearIncrement::midpoint, loads);
  }
  double worst = 0.0; // over what it may be
  for (std::size_t k = 0; k < c.size(); ++k) {
    if (!c.bonded[k])
      continue;
    const Vec<dim> start_shear = dem::shear_force(start, from, k);
    Vec<dim> shear;
    if constexpr (dim == 2)
      shear = Eigen::Rotation2Dd(1.0) * start_shear;
    else
      shear = Eigen::AngleAxisd(1.0, axis) * start_shear;
    // Chord for arc: every step slips by at most step³ / 12 of the distance, and turns as much.
    const double slip = 1.0 * step * step / 12.0;
    const double tolerance =
        slip * (c.tangential_stiffness[k] * c.reference_branch[k].norm() + start_shear.norm());
    worst = std::max(worst, (dem::shear_force(c, p, k) - shear).norm() / tolerance);
    // The normal force comes from positions: their rounding over k_n.
    EXPECT_NEAR(c.normal_force[k], start.normal_force[k], 1e-17 * c.normal_stiffness[k]);
  }
  verify({"change of shear forces that turn by 1 rad, over that of chords for arcs, " +
              std::to_string(dim) + "D",
          "a rigid rotation slips by step³ / 12", 1.1, "one, and rounding"},
         worst);
}
TEST(RigidMotion, rotation_carries_forces_along_and_slips_nowhere_in_2D) {
  rigid_rotation_carries_forces_along<2>(Rot<2>(1.0));
}
TEST(RigidMotion, rotation_carries_forces_along_and_slips_nowhere_in_3D) {
  rigid_rotation_carries_forces_along<3>(Vec<3>(1.0, 2.0, -0.7).normalized());
}

} // namespace
} // namespace kerf
