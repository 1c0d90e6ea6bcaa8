// The overlap in one dimension: statics, stability, energy, and what an interface reflects.
#include "tests/cases/chain_and_bar.hpp"
#include "tests/verification/verification.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

namespace kerf::cases {
namespace {

/// Matrices of the coupled 1D problem, assembled from Rojek (2008) eqs 44-56 independently of the
/// engines: chain first, then the nodes of the bar (both nodes of a column move alike).
struct Assembled {
  Eigen::MatrixXd K; // without the constraint; with the springs of a penalty
  Eigen::VectorXd M;
  Eigen::MatrixXd G; // constraint rows: x_D - N x_F

  explicit Assembled(const ChainAndBar& model) {
    const int n = model.particles(), columns = model.width + model.elements_outside + 1;
    const double d = model.spacing, h = model.h(), zone = model.zone();
    const double EA = model.normal_stiffness * d; // E h
    const double mass_per_length = model.particle_mass() / d;
    const bool blended = model.overlap.blending;
    const auto alpha = [&](double x) { return blended ? std::clamp(x / zone, 0.0, 1.0) : 1.0; };
    const auto share = [&](double x) { // of the particles and of their contacts, at their places
      return blended ? std::clamp(1.0 - x / zone, 0.05, 1.0) : 1.0;
    };
    K.setZero(n + columns, n + columns);
    M.setZero(n + columns);
    const auto spring = [&](int a, int b, double k) {
      K(a, a) += k;
      K(b, b) += k;
      K(a, b) -= k;
      K(b, a) -= k;
    };
    for (int i = 0; i < n; ++i) {
      const double x = model.particle_x(i);
      M[i] = share(x) * model.particle_mass();
      if (i + 1 < n)
        spring(i, i + 1, share(x + 0.5 * d) * model.normal_stiffness);
    }
    for (int e = 0; e + 1 < columns; ++e) {
      const double a = alpha(e * h), b = alpha((e + 1) * h); // alpha is linear in the element
      spring(n + e, n + e + 1, 0.5 * (a + b) * EA / h);
      M[n + e] += mass_per_length * h * (a / 3.0 + b / 6.0); // integral of alpha N_1
      M[n + e + 1] += mass_per_length * h * (a / 6.0 + b / 3.0);
    }
    G.setZero(n - model.particles_outside, n + columns);
    for (int i = model.particles_outside; i < n; ++i) {
      const double x = model.particle_x(i);
      const int e = static_cast<int>(x / h);
      const int row = i - model.particles_outside;
      G(row, i) = 1.0;
      G(row, n + e) = -(1.0 - (x / h - e));
      G(row, n + e + 1) = -(x / h - e);
      if (!model.overlap.lagrange) {
        const double shape =
            model.overlap.uniform_stiffness ? 1.0 : 4.0 * (x / zone) * (1.0 - x / zone);
        K += shape * model.overlap.stiffness_ratio * model.normal_stiffness *
             G.row(row).transpose() * G.row(row);
      }
    }
  }

  /// Largest frequency of the system, with the constraint if it is one of multipliers, rad/s.
  double largest_frequency(bool constrained) const {
    const Eigen::VectorXd root = M.cwiseSqrt().cwiseInverse();
    Eigen::MatrixXd A = root.asDiagonal() * K * root.asDiagonal();
    if (constrained) { // on the null space of G M^-1/2
      const Eigen::MatrixXd scaled = G * root.asDiagonal();
      const Eigen::MatrixXd null =
          Eigen::FullPivLU<Eigen::MatrixXd>(scaled).kernel().householderQr().householderQ() *
          Eigen::MatrixXd::Identity(scaled.cols(), scaled.cols() - scaled.rows());
      A = (null.transpose() * A * null).eval();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A, Eigen::EigenvaluesOnly);
    return std::sqrt(solver.eigenvalues().maxCoeff());
  }

  /// Displacements under a unit force on the first particle, the last node held, m.
  Eigen::VectorXd static_solution(bool constrained) const {
    const Eigen::Index size = K.rows() - 1, rows = constrained ? G.rows() : 0;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size + rows, size + rows);
    // Scaled multipliers keep the matrix well conditioned.
    const double scale = K.diagonal().maxCoeff();
    A.topLeftCorner(size, size) = K.topLeftCorner(size, size) / scale;
    if (constrained) {
      A.bottomLeftCorner(rows, size) = G.leftCols(size);
      A.topRightCorner(size, rows) = G.leftCols(size).transpose();
    }
    Eigen::VectorXd load = Eigen::VectorXd::Zero(size + rows);
    load[0] = 1.0 / scale;
    return A.fullPivLu().solve(load).head(size);
  }
};

ChainAndBar model_of(int element_ratio, int width, bool lagrange, bool blending = true) {
  ChainAndBar model;
  model.element_ratio = element_ratio;
  model.width = width;
  model.overlap.lagrange = lagrange;
  model.overlap.blending = blending;
  return model;
}

// The weights that the coupling hands out are those of the assembled model.
TEST(OverlapChain, the_engines_have_the_assembled_masses) {
  for (const int ratio : {1, 2, 4}) {
    const ChainAndBar model = model_of(ratio, 4, true);
    const Assembled assembled(model);
    const CoupledSystem system = model.system();
    const auto n = static_cast<std::size_t>(model.particles());
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_NEAR(system.dem.particles().mass[i], assembled.M[static_cast<Eigen::Index>(i)],
                  1e-14 * model.particle_mass());
    const auto columns = static_cast<std::size_t>(assembled.M.size()) - n;
    for (std::size_t a = 0; a < columns; ++a)
      EXPECT_NEAR(system.fem.mass()[a] + system.fem.mass()[columns + a],
                  assembled.M[static_cast<Eigen::Index>(n + a)],
                  1e-14 * model.particle_mass() * ratio);
  }
}

// Patch test: a uniform stress passes through the overlap, so that the strains far from it agree.
// Tolerance: round-off of a dense solve with a condition number of about 1e4.
TEST(OverlapChain, a_uniform_stress_strains_chain_and_bar_alike) {
  for (const int ratio : {1, 2, 4}) {
    const ChainAndBar model = model_of(ratio, 4, true);
    const Eigen::VectorXd u = Assembled(model).static_solution(true);
    const double chain = (u[3] - u[0]) / (3.0 * model.spacing);
    const Eigen::Index last = u.size() - 1;
    const double bar = (u[last] - u[last - 3]) / (3.0 * model.h());
    verify({"strain of the bar over that of the chain under uniform stress", "patch test", 1e-10,
            "rounding of a dense solve, condition number 1e4"},
           bar / chain - 1.0);
    std::printf("h = %d d: strain ratio - 1 = %.1e\n", ratio, bar / chain - 1.0);
  }
}

// With multipliers and h = d the patch test holds inside the overlap, too: every bond and every
// element of it has the strain of the far field.
TEST(OverlapChain, a_uniform_stress_strains_the_overlap_like_the_rest) {
  const ChainAndBar model = model_of(1, 4, true);
  const Eigen::VectorXd u = Assembled(model).static_solution(true);
  const double strain = (u[1] - u[0]) / model.spacing;
  for (int i = 0; i + 1 < model.particles(); ++i)
    verify({"strain inside the overlap under uniform stress, h = d", "patch test", 1e-10,
            "rounding of a dense solve, condition number 1e4"},
           (u[i + 1] - u[i]) / model.spacing / strain - 1.0);
}

// Closed form: springs of a uniform stiffness k_DF on w / d particles that carry a force F between
// two bars with shares that add up to one slip by chi = F d / (w k_DF), everywhere alike.
TEST(OverlapChain, a_penalty_overlap_slips_as_its_closed_form_says) {
  ChainAndBar model = model_of(1, 8, false);
  model.overlap.uniform_stiffness = true;
  const Assembled assembled(model);
  const Eigen::VectorXd u = assembled.static_solution(false);
  const double closed_form = model.spacing / (model.zone() * model.normal_stiffness); // F = 1 N
  for (Eigen::Index row = 2; row + 2 < assembled.G.rows(); ++row) { // the ends differ by 1/w
    const double chi = assembled.G.row(row).head(u.size()) * u;
    verify({"slip of a penalty overlap", "F d / (w k_DF)", 0.02, "the ends of the overlap differ"},
           chi / closed_form - 1.0);
  }
  const double middle = assembled.G.row(assembled.G.rows() / 2).head(u.size()) * u;
  std::printf("slip / closed form - 1 = %.2e\n", middle / closed_form - 1.0);
}

struct Variant {
  int element_ratio;
  int width;
  bool lagrange;
  bool uniform;
  double ratio;
  bool blending;
};
const Variant variants[] = {
    {1, 4, true, false, 1.0, true},  {2, 4, true, false, 1.0, true},
    {4, 4, true, false, 1.0, true},  {1, 4, true, false, 1.0, false},
    {1, 4, false, false, 1.0, true}, {1, 4, false, false, 3.0, true},
    {1, 4, false, true, 1.0, true},  {2, 4, false, false, 10.0, true},
    {1, 2, false, true, 1.0, false},
};

ChainAndBar model_of(const Variant& v) {
  ChainAndBar model = model_of(v.element_ratio, v.width, v.lagrange, v.blending);
  model.overlap.uniform_stiffness = v.uniform;
  model.overlap.stiffness_ratio = v.ratio;
  return model;
}

// Reference: Rojek (2008) eq. 10 with omega_max from a dense eigenvalue solve of the assembled
// coupled system. A multiplier method may do better than its bound, which ignores the constraint.
TEST(OverlapChain, the_coupled_time_step_bound_never_exceeds_the_critical_step) {
  for (const Variant& v : variants) {
    const ChainAndBar model = model_of(v);
    const double critical = 2.0 / Assembled(model).largest_frequency(v.lagrange);
    const double bound = model.system().critical_step;
    verify({"excess of the coupled step over the critical one",
            "dense eigenvalues of the coupled system", 1e-9, "rounding of the eigenvalue solver"},
           std::max(0.0, bound / critical - 1.0));
    EXPECT_GE(bound, 0.7 * critical); // what a user pays for certainty; the worst one gives 0.73
    std::printf("h = %d d, width %d, %s kappa %g%s%s: bound / critical = %.3f\n", v.element_ratio,
                v.width, v.lagrange ? "Lagrange" : "penalty", v.ratio, v.uniform ? " uniform" : "",
                v.blending ? "" : " unblended", bound / critical);
  }
}

/// Largest speed of any particle after some steps from small random velocities.
double speed_after(const ChainAndBar& model, double time_step, int steps) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> velocity(-1e-6, 1e-6); // m/s: strains of 1e-9
  dem::Settings<2> particles = model.dem_settings();
  for (const Vec<2>& x : particles.positions) {
    dem::InitialCondition<2> kick;
    kick.box = {x, x};
    kick.velocity = Vec<2>(velocity(random), 0.0);
    kick.box->lower.array() -= 0.1 * model.spacing;
    kick.box->upper.array() += 0.1 * model.spacing;
    particles.initial.push_back(kick);
  }
  CoupledSystem system = model.system(particles, model.fem_settings());
  system.start(time_step);
  double largest = 0.0;
  for (int n = 0; n < steps; ++n) {
    system.step();
    if (n % 100 == 0 || n + 1 == steps)
      for (const Vec<2>& v : system.dem.particles().velocity)
        largest = v.allFinite() ? std::max(largest, v.cwiseAbs().maxCoeff()) : INFINITY;
    if (!(largest < 1e3))
      break;
  }
  return largest;
}

// Central differences are stable below 2 / omega_max and grow exponentially above (eq. 9): at 1.01
// of it the fastest mode grows by 1 + 2 sqrt(0.02) a step.
TEST(OverlapChain, it_is_stable_at_099_of_the_critical_step_and_flies_apart_at_101) {
  for (const Variant& v : {variants[0], variants[1], variants[4], variants[5]}) {
    const ChainAndBar model = model_of(v);
    const double critical = 2.0 / Assembled(model).largest_frequency(v.lagrange);
    EXPECT_LT(speed_after(model, 0.99 * critical, 100'000), 1e-4); // at most some 1/sqrt(1-0.99²)
    EXPECT_GT(speed_after(model, 1.01 * critical, 1000), 1.0);
  }
}

/// A Hann pulse of 32 d that runs from the chain into the bar.
struct Pulse {
  double reflected = 0.0; // energy that came back into x < -3 d over the incident energy
  double drift = 0.0;     // of the total energy
};

/// What comes back is the difference from a chain that goes on for ever: the pulse has a tail of
/// short slow waves of its own, which is not the interface's.
Pulse send_pulse(ChainAndBar model, int extra_steps = 0) {
  const double d = model.spacing, length = 32.0 * d;
  const double c = d * std::sqrt(model.normal_stiffness / model.particle_mass());
  dem::InitialCondition<2> start;
  start.pulse = dem::Pulse{
      .amplitude = 1e-3 * d, .center = -40.0 * d, .length = length, .wave_speed = c, .spacing = d};
  model.particles_outside = 100;
  model.elements_outside = 120 / model.element_ratio;
  dem::Settings<2> particles = model.dem_settings();
  particles.initial.push_back(start);
  CoupledSystem system = model.system(particles, model.fem_settings());
  while (particles.positions.size() < 220) {
    particles.positions.push_back(particles.positions.back() + Vec<2>(d, 0.0));
    particles.radii.push_back(0.5 * d);
  }
  dem::Engine<2> whole(particles);

  const double dt = 0.8 * 2.0 / Assembled(model).largest_frequency(model.overlap.lagrange);
  system.start(dt);
  whole.start(dt);
  const auto step = [&] {
    system.step();
    whole.compute_own_forces();
    whole.integrate();
  };
  step();
  const double incident = system.energy();
  // Until the pulse has left the overlap, before its echo comes to the far end of the chain.
  const double distance = 40.0 * d + 0.5 * length + model.zone() + 6.0 * d;
  for (double t = dt; t < distance / c; t += dt)
    step();

  Pulse result;
  const auto &p = system.dem.particles(), &q = whole.particles();
  const auto &contacts = system.dem.contacts(), &others = whole.contacts();
  for (std::size_t i = 0; p.reference[i][0] < -3.0 * d; ++i) { // contact i joins i and i + 1
    const double force = contacts.normal_force[i] - others.normal_force[i];
    result.reflected += 0.5 * p.mass[i] * (p.velocity[i] - q.velocity[i]).squaredNorm() +
                        0.5 * force * force / contacts.normal_stiffness[i];
  }
  result.reflected /= incident;
  for (int n = 0; n < extra_steps; ++n)
    system.step();
  result.drift = system.energy() / incident - 1.0;
  return result;
}

struct Reflection {
  int element_ratio, width;
  bool lagrange;
  double ratio;
  double most;
};

// Accepted values: an independent study of these equations on chains (linear shares, floor of 0.05)
// found for the width of 4 elements 6.2e-6, 3.2e-4, 3.2e-3 with multipliers, and 9.6e-4, 1.2e-4
// for penalties of 4 alpha (1 - alpha) kappa k_n with kappa = 1 and 3.
TEST(OverlapChain, a_pulse_of_32_spacings_is_reflected_as_little_as_the_theory_allows) {
  const Reflection cases[] = {
      {1, 4, true, 1.0, 2e-5},  {2, 4, true, 1.0, 5e-4}, {4, 4, true, 1.0, 5e-3},
      {1, 2, true, 1.0, 2e-5},  {1, 8, true, 1.0, 2e-5}, {1, 4, false, 1.0, 1.5e-3},
      {1, 4, false, 3.0, 2e-4},
  };
  for (const Reflection& r : cases) {
    ChainAndBar model = model_of(r.element_ratio, r.width, r.lagrange);
    model.overlap.stiffness_ratio = r.ratio;
    const Pulse pulse = send_pulse(model);
    verify(
        {fmt::format("reflected energy, h = {} d, width {}, {}", r.element_ratio, r.width,
                     r.lagrange ? "multipliers" : fmt::format("penalty of kappa = {:g}", r.ratio)),
         "independent study of chains, docs/theory/coupling.md", r.most,
         "what such an overlap reflects, and some room"},
        pulse.reflected);
    std::printf("h = %d d, width %d, %s kappa %g: R = %.2e\n", r.element_ratio, r.width,
                r.lagrange ? "Lagrange" : "penalty", r.ratio, pulse.reflected);
  }
}

// Negative control: without blending the overlap has twice the mass and stiffness. Closed form
// R = 9 s² / (16 + 9 s²), s = sin(k w), for one wave number; the pulse averages it.
TEST(OverlapChain, without_blending_it_reflects_a_sixth_of_the_energy) {
  const double reflected = send_pulse(model_of(1, 4, true, false)).reflected;
  verify({"reflected energy without blending, less 0.17", "R = 9 s² / (16 + 9 s²), s = sin k w",
          0.01, "the pulse averages over k"},
         reflected - 0.17);
  std::printf("unblended: R = %.3f\n", reflected);
}

// A linear system under central differences conserves 1/2 v^(n-1/2).M v^(n+1/2) + 1/2 u.K u; what
// is left is the round-off of 1e5 steps.
TEST(OverlapChain, the_energy_drifts_by_less_than_1e_10_in_1e5_steps) {
  const double drift = send_pulse(model_of(1, 4, true), 100'000).drift;
  verify({"drift of the energy of a coupled chain over 1e5 steps",
          "invariant of central differences", 1e-10, "rounding of 1e5 steps"},
         drift);
  std::printf("energy drift after 1e5 steps: %.1e\n", drift);
}

TEST(OverlapChain, a_body_that_moves_rigidly_feels_no_force) {
  for (const bool lagrange : {true, false}) {
    ChainAndBar model = model_of(2, 4, lagrange);
    dem::Settings<2> particles = model.dem_settings();
    fem::Settings<2> bar = model.fem_settings();
    particles.initial.emplace_back().velocity = Vec<2>(3.0, 0.0);
    bar.initial.emplace_back().velocity = fem::InitialVelocity<2>{Vec<2>(3.0, 0.0)};
    CoupledSystem system = model.system(particles, bar);
    system.start(0.8 * system.critical_step);
    for (int n = 0; n < 1000; ++n)
      system.step();
    // Round-off of positions (1e-17 m) times stiffness (2e10 N/m), for multipliers over dt².
    const double scale = model.particle_mass() * 0.05 * 1e-15 / std::pow(system.critical_step, 2);
    for (const int side : {0, 1})
      for (const double force : system.force(side))
        EXPECT_LT(std::abs(force), std::max(scale, 1e-4));
    EXPECT_NEAR(system.dem.particles().velocity[0][0], 3.0, 1e-9);
  }
}

} // namespace
} // namespace kerf::cases
