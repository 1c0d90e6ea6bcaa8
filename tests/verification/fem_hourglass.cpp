// Viscous hourglass control against the model that it discretises.
#include "tests/cases/fem_bodies.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

namespace kerf::fem {
namespace {

using cases::rock;

template <class Dim> struct FemHourglass : testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
struct DimensionName {
  template <class Dim> static std::string GetName(int) { return Dim::value == 2 ? "2D" : "3D"; }
};
TYPED_TEST_SUITE(FemHourglass, Dimensions, DimensionName);

template <int dim> Settings<dim> controlled(double stiffness, double viscosity, bool finite) {
  Settings<dim> settings{.materials = cases::of<dim>(rock, Formulation::one_point, finite)};
  settings.materials[0].material.hourglass_stiffness = stiffness;
  settings.materials[0].material.hourglass_viscosity = viscosity;
  return settings;
}

/// One box of different sides.
template <int dim> Mesh<dim> brick() {
  BoxMesh<dim> box{.size = Vec<dim>::LinSpaced(dim, 2.0, 3.0) * 1e-3};
  box.count.fill(1);
  return make_box(box);
}

/// The signs of the mode with all axes: xy, or xyz.
template <int dim> double sign_of(const Mesh<dim>& mesh, std::size_t node) {
  const Vec<dim> middle = Vec<dim>::LinSpaced(dim, 1.0, 1.5) * 1e-3;
  return (mesh.position(node) - middle).prod() > 0.0 ? 1.0 : -1.0;
}

// q'' + zeta W q' + kappa W² q = 0 with W² = c_P² n b.b / (3 d): of a box with the sides l_i,
// b.b = (4 / n) sum 1 / l_i². Central differences with the velocity of half a step ago,
// v' = (1 - zeta W dt) v - kappa W² dt q, are computed along; the tolerance is the rounding of 60
// steps.
TYPED_TEST(FemHourglass, modes_decay_at_the_rate_of_the_viscosity) {
  constexpr int dim = TypeParam::value;
  const double kappa = 0.05, zeta = 0.3, nodes = 1 << dim;
  const double b2 =
      4.0 / nodes * (Vec<dim>::LinSpaced(dim, 2.0, 3.0) * 1e-3).cwiseAbs2().cwiseInverse().sum();
  const double W = std::sqrt(12e9 / 2500.0 * nodes * b2 / (3.0 * dim)); // rad/s
  for (const bool finite : {false, true}) {
    Engine<dim> engine(brick<dim>(), controlled<dim>(kappa, zeta, finite));
    const double dt = 0.9 * 2.0 / std::sqrt(engine.step_limit().omega2);
    engine.start(dt);
    std::vector<double> velocity(engine.mesh().positions.size());
    const double start = 1e-6; // m/s: even a law with a rate stays linear
    for (std::size_t a = 0; a < engine.mesh().num_nodes(); ++a)
      velocity[a * dim] = start * sign_of(engine.mesh(), a);
    engine.integrate(); // the first step knows no increment, and nothing moves yet
    engine.set_motion(std::vector<double>(velocity.size()), velocity);
    double v = start, q = 0.0, error = 0.0;
    for (int n = 0; n < 60; ++n) {
      q += v * dt; // as the stored force does
      v = (1.0 - zeta * W * dt) * v - kappa * W * W * dt * q;
      engine.integrate();
      error =
          std::max(error, std::abs(engine.velocity()[0] * sign_of(engine.mesh(), 0) - v) / start);
    }
    EXPECT_LT(std::abs(v), 0.1 * start);
    verify({"velocity of a hourglass mode under viscous control, " + std::to_string(dim) +
                (finite ? "D, objective rate" : "D"),
            "q'' + zeta W q' + kappa W² q = 0 in central differences", finite ? 1e-9 : 1e-12,
            finite ? "rotations of 1e-12 a step" : "rounding of 60 steps"},
           error);
    EXPECT_GT(engine.energies().damped, 0.0);
  }
}

// A linear field of velocities has no part in the hourglass modes.
TYPED_TEST(FemHourglass, viscosity_gives_no_force_in_a_linear_field) {
  constexpr int dim = TypeParam::value;
  for (const bool finite : {false, true}) {
    std::vector<double> forces[2];
    for (const double zeta : {0.0, 1.0}) {
      Engine<dim> engine(cases::distorted_box<dim>(), controlled<dim>(0.1, zeta, finite));
      std::vector<double> v(engine.mesh().positions.size());
      for (std::size_t k = 0; k < v.size(); ++k) {
        const Vec<dim> X = engine.mesh().position(k / dim);
        v[k] = 1e-3 * (X.sum() + static_cast<double>(k % dim + 1) * X[0]) + 1e-6;
      }
      forces[zeta > 0.0] = cases::forces(engine, v, true);
    }
    double most = 0.0, difference = 0.0;
    for (std::size_t k = 0; k < forces[0].size(); ++k) {
      most = std::max(most, std::abs(forces[0][k]));
      difference = std::max(difference, std::abs(forces[1][k] - forces[0][k]));
    }
    EXPECT_GT(most, 0.0);
    EXPECT_LE(difference, 1e-12 * most);
  }
}

// Central differences with the damping of half a step ago: 4 M - dt² K - 2 dt C has no negative
// eigenvalue at the critical step of the bound, on distorted and on blended elements. K and C are
// those of the assembled body. Tolerance: rounding of eigenvalues.
TYPED_TEST(FemHourglass, viscosity_is_allowed_for_in_the_critical_step) {
  constexpr int dim = TypeParam::value;
  for (const bool blended : {false, true})
    for (const double zeta : {0.1, 1.0}) {
      Engine<dim> stiff(cases::distorted_box<dim>(), controlled<dim>(0.1, 0.0, false));
      Engine<dim> viscous(cases::distorted_box<dim>(), controlled<dim>(0.1, zeta, false));
      if (blended)
        for (Engine<dim>* engine : {&stiff, &viscous})
          engine->set_weights(cases::ramp(engine->mesh(), 0.0, 3e-3));
      const double dt = 2.0 / std::sqrt(viscous.step_limit().omega2);
      const Eigen::MatrixXd K = cases::stiffness(stiff);
      // Forces of an increment of one second: K u + C u.
      Eigen::MatrixXd A = dt * dt * K + 2.0 * dt * (cases::stiffness(viscous, true) - K);
      const std::vector<double> mass = viscous.mass();
      for (Eigen::Index i = 0; i < A.rows(); ++i)
        for (Eigen::Index j = 0; j < A.cols(); ++j) {
          const double m =
              mass[static_cast<std::size_t>(i / dim)] * mass[static_cast<std::size_t>(j / dim)];
          A(i, j) = m > 0.0 ? A(i, j) / std::sqrt(m) : 0.0;
        }
      const double largest =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly)
              .eigenvalues()
              .maxCoeff();
      std::printf("  zeta %.1f: step %.3f of that without viscosity, 4 M used to %.3f\n", zeta,
                  dt / (2.0 / std::sqrt(stiff.step_limit().omega2)), largest / 4.0);
      EXPECT_LE(largest, 4.0 * (1.0 + 1e-9));
      EXPECT_GE(largest, 2.0); // and is no guess
    }
}

} // namespace
} // namespace kerf::fem
