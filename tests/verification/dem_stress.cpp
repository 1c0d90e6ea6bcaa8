// Stress and strain of particles and of boxes around them.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include "dem_core/gauge.hpp"
#include "dem_core/probe.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::Matrix;
using dem::Symmetric;

/// Particles after a homogeneous deformation, and the forces of it.
template <int dim> struct Deformed {
  dem::Particles<dim> particles;
  dem::Contacts<dim> contacts;

  Deformed(const dem::Settings<dim>& settings, const Matrix<dim>& gradient) {
    const dem::Engine<dim> engine(settings);
    particles = engine.particles();
    contacts = engine.contacts();
    for (std::size_t i = 0; i < particles.size(); ++i)
      particles.displacement[i] = gradient * particles.reference[i];
    const std::vector<dem::Aligned<Rot<dim>>> no_rotation(particles.size());
    dem::Loads<dim> loads;
    dem::compute_contact_forces(contacts, particles, {particles.displacement, no_rotation, 1.0},
                                dem::ShearIncrement::midpoint, loads);
  }
};

constexpr double small = 1e-7; // strain: what is quadratic in it stays below the tolerance 1e-6
const double row = 0.5 * std::numbers::sqrt3 * spacing; // height of a row of the lattice, m

/// Six columns by six rows of a lattice, from anywhere inside: every kind of contact is in it as
/// often as in a cell of the lattice.
const Box<2> cells{{2.3 * spacing, 2.3 * row}, {8.3 * spacing, 8.3 * row}};

// Reference: C11 = sqrt(3)/4 (3 k_n + k_t), C12 = sqrt(3)/4 (k_n - k_t); see the lattice moduli.
// Solid fraction pi / (2 sqrt(3)), six contacts a particle.
TEST(Probe, reads_stress_and_strain_of_a_triangular_lattice_under_uniaxial_strain) {
  const auto material = rock(2, 0.2);
  const double k_n = material.normal_stiffness, k_t = material.tangential_stiffness;
  const double C11 = std::numbers::sqrt3 / 4.0 * (3.0 * k_n + k_t);
  const double C12 = std::numbers::sqrt3 / 4.0 * (k_n - k_t);
  const double solid_fraction = std::numbers::pi / (2.0 * std::numbers::sqrt3);
  const auto settings = cases::lattice_model<2>(dem::LatticeType::triangular, {12, 12}, material);
  for (const int axis : {0, 1}) {
    Matrix<2> gradient = Matrix<2>::Zero();
    gradient(axis, axis) = small;
    const Deformed<2> body(settings, gradient);
    const auto reading = dem::read_probe<2>(cells, {}, body.contacts, body.particles);
    Symmetric<2> expected(C12, C12, 0.0);
    expected[axis] = C11;
    verify({"stress of a probe in a triangular lattice, over C11", "its moduli", 1e-6,
            "nonlinear part at strains of 1e-7"},
           (reading.stress / small - expected).norm() / C11);
    EXPECT_LT((reading.strain - dem::symmetric_part<2>(gradient)).norm(), 1e-9 * small);
    EXPECT_EQ(reading.particles, 36u);
    EXPECT_DOUBLE_EQ(reading.coordination_number, 6.0);
    EXPECT_NEAR(reading.solid_fraction, solid_fraction, 1e-12);

    const auto each = dem::particle_stress(body.contacts, body.particles);
    for (std::size_t i = 0; i < each.size(); ++i)
      if (cells.contains(body.particles.reference[i])) {
        EXPECT_LT((each[i] * solid_fraction / small - expected).norm(), 1e-6 * C11);
      }
  }
}

// The box is one period; the contacts across its ends count once.
TEST(Probe, of_a_whole_period_misses_no_contact) {
  const auto material = rock(3, 0.2);
  auto settings = cases::lattice_model<3>(dem::LatticeType::cubic, {5, 5, 5}, material);
  settings.period.length = Vec<3>::Constant(5.0 * spacing);
  const Deformed<3> body(settings, Matrix<3>::Zero());
  const Box<3> box{Vec<3>::Constant(-0.2 * spacing), Vec<3>::Constant(4.8 * spacing)};
  for (const double shift : {0.0, 3.0 * spacing}) { // particles are never put back
    auto particles = body.particles;
    for (Vec<3>& u : particles.displacement)
      u[0] += shift;
    const auto reading = dem::read_probe(box, settings.period, body.contacts, particles);
    EXPECT_EQ(reading.particles, 125u);
    EXPECT_DOUBLE_EQ(reading.coordination_number, 6.0);
  }
}

TEST(Probe, has_no_means_of_nothing) {
  const Deformed<2> body(cases::pair_model<2>({1.0, 0.0}, rock(2)), Matrix<2>::Zero());
  const Box<2> far{{1.0, 1.0}, {2.0, 2.0}};
  const auto reading = dem::read_probe<2>(far, {}, body.contacts, body.particles);
  EXPECT_EQ(reading.particles, 0u);
  EXPECT_EQ(reading.stress.norm(), 0.0);
  EXPECT_EQ(reading.solid_fraction, 0.0);
  EXPECT_TRUE(std::isnan(reading.strain[0]));
  EXPECT_TRUE(std::isnan(reading.velocity[0]));
  EXPECT_TRUE(std::isnan(reading.coordination_number));
}

std::vector<std::uint32_t> everybody(std::size_t count) {
  std::vector<std::uint32_t> all(count);
  for (std::uint32_t i = 0; i < count; ++i)
    all[i] = i;
  return all;
}

TEST(Gauge, finds_the_gradient_of_a_homogeneous_deformation_in_an_irregular_packing) {
  Matrix<3> gradient;
  gradient << 1e-4, 2e-4, -3e-4, 0.0, 5e-5, 1e-4, 7e-5, -2e-4, -1e-4;
  const Deformed<3> body(cases::irregular_model<3>(5, rock(3), 3), gradient);
  const auto group = everybody(body.particles.size());
  EXPECT_LT((dem::displacement_gradient<3>(body.particles, group) - gradient).norm(), 1e-15);
}

// u = (R - 1) X has the symmetric part (cos - 1), half of the square of the angle.
TEST(Gauge, sees_no_strain_in_a_rigid_rotation_to_first_order) {
  for (const double angle : {1e-3, 1e-5}) {
    const Matrix<2> turn = Eigen::Rotation2Dd(angle).toRotationMatrix() - Matrix<2>::Identity();
    const Deformed<2> body(cases::irregular_model<2>(8, rock(2), 3), turn);
    const auto group = everybody(body.particles.size());
    EXPECT_LT(dem::strain<2>(body.particles, group).cwiseAbs().maxCoeff(), 0.501 * angle * angle);
  }
}

TEST(Gauge, needs_particles_that_span_the_space) {
  const Deformed<2> chain(cases::lattice_model<2>(dem::LatticeType::chain, {7, 1}, rock(2)),
                          Matrix<2>::Zero());
  const auto group = everybody(7);
  EXPECT_TRUE(std::isnan(dem::displacement_gradient<2>(chain.particles, group)(0, 0)));
}

// Reference: in equilibrium sum branch x force = sum x x f, so the mean stress is 1 / V times the
// latter. The left column stands still, the right one is displaced and then stands still as well;
// f is what holds them. Tolerance: the resultant that damping leaves, which is looked at.
TEST(Stress, of_a_body_at_rest_is_that_of_the_forces_on_its_boundary) {
  auto settings = cases::irregular_model<2>(8, rock(2, 0.5), 6);
  settings.damping = {dem::DampingKind::nonviscous, 0.7, 0.7};
  const Box<2> left{{-1.0, -1.0}, {0.6 * spacing, 1.0}}, right{{6.8 * spacing, -1.0}, {1.0, 1.0}};
  for (const Box<2>& box : {left, right})
    settings.boundary.push_back({.box = box, .components = 3});
  for (const int component : {0, 1}) {
    dem::InitialCondition<2> condition;
    condition.box = right;
    condition.pulse = dem::Pulse{.amplitude = 1e-9, .length = 1e6, .component = component};
    settings.initial.push_back(condition);
  }
  dem::Engine<2> engine(settings);
  engine.start(0.8 * 2.0 / std::sqrt(engine.step_limit().omega2));
  cases::step(engine);
  cases::step(engine);
  EXPECT_GT(engine.unbalanced_force(), 0.01);
  for (int n = 0; n < 4000; ++n)
    cases::step(engine);
  EXPECT_LT(engine.unbalanced_force(), 1e-8);
  std::vector<std::uint32_t> points;
  for (std::uint32_t i = 0; i < engine.size(); ++i)
    if (engine.boundary().of(i) != nullptr)
      points.push_back(i);
  std::vector<double> force(2 * points.size()); // of the body on what holds it, N
  engine.own_forces(points, force);
  Matrix<2> x_f = Matrix<2>::Zero(); // N m
  for (std::size_t k = 0; k < points.size(); ++k)
    x_f -=
        engine.particles().position(points[k]) * Vec<2>(force[2 * k], force[2 * k + 1]).transpose();

  const Box<2> box{Vec<2>::Constant(-2.0 * spacing), Vec<2>::Constant(12.0 * spacing)};
  const Symmetric<2> expected = dem::symmetric_part<2>(x_f) / std::pow(14.0 * spacing, 2);
  const auto reading = dem::read_probe<2>(box, {}, engine.contacts(), engine.particles());
  verify({"stress of a body at rest", "sum of x f over its boundary", 1e-6,
          "resultant that damping leaves"},
         (reading.stress - expected).norm() / expected.norm());

  Symmetric<2> sum = Symmetric<2>::Zero();
  const auto each = dem::particle_stress(engine.contacts(), engine.particles());
  for (std::size_t i = 0; i < each.size(); ++i)
    sum += each[i] * dem::volume_of_radius<2>(engine.particles().radius[i]);
  EXPECT_LT((sum - dem::symmetric_part<2>(x_f)).norm(), 1e-6 * x_f.norm());
}

} // namespace
} // namespace kerf
