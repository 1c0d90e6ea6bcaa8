// A bonded chain against the theory of S.P. Timoshenko's beam: how it bends and how it swings.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;

constexpr double radius = 0.5 * spacing;
const std::string beam = "S.P. Timoshenko, Phil. Mag. 41 (1921) 744, doi:10.1080/14786442108636264";

/// A chain along x whose first particle is clamped; bonds as thick as the particles.
template <int dim> dem::Settings<dim> clamped_chain(int bonds) {
  std::array<int, dim> count;
  count.fill(1);
  count[0] = bonds + 1;
  auto material = rock(dim, 0.4);
  material.bond_radius_ratio = 1.0;
  auto settings = cases::lattice_model<dim>(dem::LatticeType::chain, count, material);
  auto clamp = cases::prescribe_at<dim>(settings.positions.front(), dem::Motion::fixed);
  clamp.components |= 1u << dim;
  settings.boundary = {clamp};
  return settings;
}

/// k_b of its bonds: k_n I / A of a strip or a circle of the radius of a particle, N m.
double bending_stiffness(int dim, const dem::Material& material) {
  return material.normal_stiffness * radius * radius / (dim == 2 ? 3.0 : 4.0);
}

// Reference: a Timoshenko beam of n bonds with EI = k_b d and G A_s = k_t d under a force at its
// tip. Its joints are discrete: u = P (n / k_t + d² n (4 n² - 1) / (12 k_b)), which tends to
// P L³ / (3 EI) + P L / (G A_s). The tip is moved to and fro once in some 60 swings of the
// beam; tolerance: the square of that, 3e-4.
template <int dim> void bends() {
  constexpr int bonds = 8, steps = 200000;
  auto settings = clamped_chain<dim>(bonds);
  const double deflection = 1e-4 * bonds * spacing;
  auto tip = cases::prescribe_at<dim>(settings.positions.back(), dem::Motion::hann);
  tip.components = 1u << 1;
  tip.amplitude[1] = deflection;
  settings.boundary.push_back(tip);
  settings.damping = {.kind = dem::DampingKind::nonviscous, .translation = 0.3, .rotation = 0.3};
  dem::Engine<dim> engine(settings);
  const double dt = 0.8 * 2.0 / std::sqrt(engine.step_limit().omega2);
  settings.boundary[1].duration = steps * dt;
  engine = dem::Engine<dim>(settings);
  engine.start(dt);
  for (int n = 0; n < steps / 2; ++n)
    cases::step(engine);
  engine.compute_own_forces();
  const double k_b = bending_stiffness(dim, settings.material);
  const double compliance = bonds / settings.material.tangential_stiffness +
                            spacing * spacing * bonds * (4.0 * bonds * bonds - 1.0) / (12.0 * k_b);
  for (const std::size_t k : {0, 4, 7}) {
    const double P = dem::contact_force(engine.contacts(), engine.particles(), k)[1];
    verify({"force that bends a clamped chain of 8 bonds, " + std::to_string(dim) + "D",
            beam + ", with discrete joints", 3e-4, "square of the share of a swing in the load"},
           P * compliance / deflection - 1.0);
  }
}
TEST(BondedBeam, bends_like_that_of_timoshenko_in_2D) {
  bends<2>();
}
TEST(BondedBeam, bends_like_that_of_timoshenko_in_3D) {
  bends<3>();
}

/// A cantilever of constant cross-section; state (w, phi, M, V) with w' = phi + V / GA_s,
/// phi' = M / EI, M' = -V - rho I omega² phi, V' = -rho A omega² w.
struct Timoshenko {
  double length, EI, GA, rho_A, rho_I; // m, N m², N, kg/m, kg m

  /// Zero at the natural frequencies: clamped at 0, and no M and V at the end.
  double determinant(double omega) const {
    Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
    A(0, 1) = 1.0;
    A(0, 3) = 1.0 / GA;
    A(1, 2) = 1.0 / EI;
    A(2, 1) = -rho_I * omega * omega;
    A(2, 3) = -1.0;
    A(3, 0) = -rho_A * omega * omega;
    // exp(A L) by Taylor over one of many pieces, then by squaring.
    constexpr int halvings = 12;
    A *= length / std::exp2(halvings);
    Eigen::Matrix4d transfer = Eigen::Matrix4d::Identity(), term = transfer;
    for (int k = 1; k <= 8; ++k)
      transfer += term = (term * A / k).eval();
    for (int k = 0; k < halvings; ++k)
      transfer = (transfer * transfer).eval();
    return transfer.bottomRightCorner<2, 2>().determinant();
  }
  /// By bisection below that of Euler and Bernoulli, 1.8751² sqrt(EI / rho A) / L², rad/s.
  double lowest_frequency() const {
    double high = std::pow(1.8751041, 2) * std::sqrt(EI / rho_A) / (length * length);
    double low = 0.5 * high;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (determinant(middle) * determinant(low) > 0.0 ? low : high) = middle;
    }
    return low;
  }
};

/// Frequency at which a chain swings in its lowest mode, from the motion of the engine. The mode
/// (of the eigenvalue problem) only filters the velocities; all of a linear system are in them.
template <int dim> double swinging_frequency(int bonds) {
  auto settings = clamped_chain<dim>(bonds);
  const double omega_max = std::sqrt(dem::Engine<dim>(settings).step_limit().omega2);
  for (const Vec<dim>& x : settings.positions) {
    dem::InitialCondition<dim> condition;
    condition.box = {x - Vec<dim>::Constant(1e-6), x + Vec<dim>::Constant(1e-6)};
    condition.velocity[1] = 1e-9 * omega_max * x[0] * x[0] / settings.positions.back()[0];
    settings.initial.push_back(condition);
  }
  dem::Engine<dim> engine(settings);

  // What moves in the plane of x and y.
  constexpr int dofs = dim + rotations<dim>, rotation = dofs - 1;
  const Eigen::MatrixXd all = cases::scaled_stiffness(engine);
  std::vector<Eigen::Index> plane;
  for (Eigen::Index i = 1; i <= bonds; ++i)
    for (const int a : {0, 1, rotation})
      plane.push_back(i * dofs + a);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(all(plane, plane).eval());
  const Eigen::VectorXd mode = solver.eigenvectors().col(0);
  const auto rate = [&] {
    const auto& p = engine.particles();
    double sum = 0.0;
    for (std::size_t i = 1; i < p.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(3 * (i - 1));
      const double root = std::sqrt(p.mass[i]);
      sum += root * (mode[row] * p.velocity[i][0] + mode[row + 1] * p.velocity[i][1]) +
             std::sqrt(p.inertia[i]) * mode[row + 2] * p.angular_velocity[i][rotation - dim];
    }
    return sum;
  };

  const double dt = 0.5 * 2.0 / omega_max;
  engine.start(dt);
  cases::step(engine);
  double before = rate(), first = 0.0, last = 0.0;
  constexpr int crossings = 5; // two periods
  for (int n = 1, found = 0; found < crossings; ++n) {
    cases::step(engine);
    const double now = rate();
    if (before * now < 0.0) {
      last = (n - now / (now - before)) * dt;
      first = ++found == 1 ? last : first;
    }
    before = now;
  }
  return std::numbers::pi * (crossings - 1) / (last - first);
}

// Reference: a cantilever of n d and half a cell of the last particle, which has the mass and
// moment of inertia of the particles spread along it. Tolerance: a chain is the beam by the
// midpoint rule; its error falls with the square of d / L, and the factor 2 leaves room for its
// constant.
template <int dim> void swings() {
  double coarse = 0.0, fine = 0.0;
  for (const int bonds : {8, 16, 32}) {
    const auto settings = clamped_chain<dim>(bonds);
    const dem::Engine<dim> engine(settings);
    const Timoshenko theory{.length = (bonds + 0.5) * spacing,
                            .EI = bending_stiffness(dim, settings.material) * spacing,
                            .GA = settings.material.tangential_stiffness * spacing,
                            .rho_A = engine.particles().mass[0] / spacing,
                            .rho_I = engine.particles().inertia[0] / spacing};
    const double error = swinging_frequency<dim>(bonds) / theory.lowest_frequency() - 1.0;
    std::printf("%dD, %d bonds: frequency off by %.2e\n", dim, bonds, error);
    const std::string name = std::to_string(bonds) + " bonds, " + std::to_string(dim) + "D";
    verify({"lowest frequency of a clamped chain of " + name, beam, 2.0 / (bonds * bonds),
            "2 (d / L)²: joints are discrete"},
           error);
    coarse = fine;
    fine = error;
  }
  verify({"order of that error in d / L, " + std::to_string(dim) + "D", "second, midpoint rule",
          0.2, "orders above, for 16 and 32 bonds"},
         std::log2(coarse / fine) - 2.0);
}
TEST(BondedBeam, swings_like_that_of_timoshenko_in_2D) {
  swings<2>();
}
TEST(BondedBeam, swings_like_that_of_timoshenko_in_3D) {
  swings<3>();
}

} // namespace
} // namespace kerf
