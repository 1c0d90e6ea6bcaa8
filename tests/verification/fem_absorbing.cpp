// What an absorbing boundary reflects of plane waves that meet it at an angle.
#include "tests/cases/fem_loads.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

namespace kerf::fem {
namespace {

using cases::rock;
using Complex = std::complex<double>;
using Pair = Eigen::Vector2cd;

constexpr double pi = std::numbers::pi;
const double rho = 2500.0, lambda = 4e9, mu = 4e9; // of cases::rock
const double c_P = std::sqrt((lambda + 2.0 * mu) / rho), c_S = std::sqrt(mu / rho);

/// A plane wave d exp(i (k.x - omega t)), P or S, with given omega and k_y; it travels towards
/// x > 0, or decays towards x < 0.
struct Wave {
  Pair k, d;

  Wave(bool is_P, double omega, double k_y, bool to_the_right) {
    const double c = is_P ? c_P : c_S, rest = omega * omega / (c * c) - k_y * k_y;
    const Complex k_x = rest > 0.0 ? Complex((to_the_right ? 1.0 : -1.0) * std::sqrt(rest), 0.0)
                                   : Complex(0.0, -std::sqrt(-rest));
    k = Pair(k_x, k_y);
    d = (is_P ? Pair(k_x, k_y) : Pair(-k_y, k_x)) * (c / omega);
  }
  /// What the dashpots of a side with the normal x leave of the traction: sigma n + C v.
  Pair residual(double omega) const {
    const Complex i(0.0, 1.0);
    return i * Pair(lambda * (k[0] * d[0] + k[1] * d[1]) + 2.0 * mu * k[0] * d[0] -
                        omega * rho * c_P * d[0],
                    mu * (k[0] * d[1] + k[1] * d[0]) - omega * rho * c_S * d[1]);
  }
};

/// Energy that comes back over that which arrives: of both reflected waves the flux rho omega² |a|²
/// c cos of the angle.
double reflected(bool is_P, double omega, double k_y) {
  const Wave in(is_P, omega, k_y, true), P(true, omega, k_y, false), S(false, omega, k_y, false);
  Eigen::Matrix2cd A;
  A << P.residual(omega), S.residual(omega);
  const Pair a = A.inverse() * -in.residual(omega);
  const auto flux = [&](const Wave& wave, double c) { return c * c * std::abs(wave.k[0].real()); };
  return (std::norm(a[0]) * flux(P, c_P) + std::norm(a[1]) * flux(S, c_S)) /
         flux(in, is_P ? c_P : c_S);
}

// A packet of plane waves of one k_y, periodic across, with k_x around the wanted angle; each of
// its waves is reflected as the closed form says, by its own angle. The square of the amplitudes
// that the mesh and the lumping add is below ((k h)² / 24)² with 14 elements a wave length, and
// beside a reflected amplitude r of the boundary they change the energy by up to 2 r (k h)² / 24.
TEST(FemAbsorbing, reflects_by_angle_what_the_dashpots_of_lysmer_and_kuhlemeyer_do) {
  const double length = 14e-3, h = 1e-3, k = 2.0 * pi / length;
  for (const bool is_P : {true, false})
    for (const int degrees : {0, 15, 30, 45}) {
      const double angle = degrees * pi / 180.0, c = is_P ? c_P : c_S;
      const double k_y = k * std::sin(angle);
      const double L = 20.0 * length;
      const auto across =
          static_cast<std::uint32_t>(degrees == 0 ? 3 : std::lround(2.0 * pi / k_y / h));
      const Vec<2> size(L, degrees == 0 ? 3.0 * h : 2.0 * pi / k_y);
      Settings<2> settings{.materials = cases::of<2>(rock)};
      settings.absorbing = {{.tag = "right"}};
      Engine<2> engine(
          make_box(BoxMesh<2>{.size = size,
                              .count = {static_cast<std::uint32_t>(std::lround(L / h)), across}},
                   {.length = {0.0, size[1]}}),
          settings);

      // exp(-(x / w)² / 2) cos(k.x) is the sum of waves with the weights exp(-(k_x w)² / 2).
      const double w = 1.6 * length, centre = 0.5 * L;
      std::vector<double> u(engine.mesh().positions.size()), v(u.size());
      double energy = 0.0, back = 0.0;
      for (int j = -20; j <= 20; ++j) {
        const double away = 0.2 * j / w, k_x = k * std::cos(angle) + away;
        const double weight = std::exp(-0.5 * away * away * w * w);
        const double omega = c * std::hypot(k_x, k_y);
        const Wave wave(is_P, omega, k_y, true);
        for (std::size_t a = 0; a < engine.mesh().num_nodes(); ++a) {
          const Vec<2> x = engine.mesh().position(a) - Vec<2>(centre, 0.0);
          const double phase = k_x * x[0] + k_y * x[1];
          for (Eigen::Index i = 0; i < 2; ++i) {
            u[2 * a + static_cast<std::size_t>(i)] +=
                1e-9 * weight * wave.d[i].real() * std::cos(phase);
            v[2 * a + static_cast<std::size_t>(i)] +=
                1e-9 * weight * omega * wave.d[i].real() * std::sin(phase);
          }
        }
        energy += weight * weight * omega * omega;
        back += weight * weight * omega * omega * reflected(is_P, omega, k_y);
      }
      const double dt = 0.8 * cases::critical_step(engine);
      engine.start(dt);
      engine.set_motion(u, v);
      engine.integrate();
      const Energies e0 = engine.energies();
      const double end = (0.5 * L + 5.0 * w) / (c * std::cos(angle)); // its tail has arrived
      while (static_cast<double>(engine.step()) * dt < end)
        engine.integrate();
      const Energies e1 = engine.energies();
      const double share = (e1.kinetic + e1.elastic) / (e0.kinetic + e0.elastic);
      const double exact = back / energy, error = share - exact;
      std::printf("  %s %2d degrees: reflected energy %.4f, theory %.4f\n", is_P ? "P" : "S",
                  degrees, share, exact);
      verify({std::string("share of the energy of ") + (is_P ? "P" : "S") +
                  " waves that an absorbing boundary reflects, 0 to 45 degrees",
              "dashpots of J. Lysmer and R. L. Kuhlemeyer, ASCE EM4 (1969) 859, plane waves", 0.01,
              "dispersion (k h)² / 24 of 14 elements a wave length, 0.008 of an amplitude"},
             error);
    }
}

// A bar that hits a rigid wall: the wall pushes with rho c v over the time 2 L / c of the wave to
// the free end and back, and the bar leaves with the velocity it came with. A sharp front in a mesh
// rings: the impulse and the mean of the middle of the time are compared, not the force of a step.
// What stays behind as vibration is taken from the momentum.
TEST(FemWalls, strike_a_bar_with_the_force_and_for_the_time_of_its_wave) {
  const std::uint32_t count = 200;
  const double E = 10e9, v = 1.0, h = 1e-3, L = count * h, c = std::sqrt(E / rho);
  Settings<2> settings{.materials = cases::of<2>(IsotropicElastic::from_young(rho, E, 0.0),
                                                 Formulation::full, false)};
  settings.initial = {{.box = {}, .velocity = InitialVelocity<2>{{-v, 0.0}}, .pulse = {}}};
  settings.walls = {{.tag = "left", .point = {0.0, 0.0}, .normal = {1.0, 0.0}}};
  Engine<2> engine(make_box(BoxMesh<2>{.size = {L, h}, .count = {count, 1}}), settings);
  const double dt = 0.9 * cases::critical_step(engine), time = 2.0 * L / c;
  engine.start(dt);
  double impulse = 0.0, middle = 0.0, last = 0.0;
  int steps = 0;
  while (static_cast<double>(engine.step()) * dt < 1.5 * time) {
    const double t = static_cast<double>(engine.step()) * dt;
    engine.integrate();
    const double force = engine.wall_force(0)[0];
    impulse += force * (engine.step() == 1 ? 0.5 * dt : dt);
    if (t > 0.25 * time && t < 0.75 * time) {
      middle += force;
      ++steps;
    }
    if (force > 0.0)
      last = t;
  }
  const double mass = rho * L * h;
  const std::string source = "one-dimensional wave; W. Goldsmith, Impact (1960)";
  std::printf("  force %.4f, duration %.4f, momentum %.4f\n", middle / steps / (rho * c * v * h),
              last / time, impulse / (2.0 * mass * v));
  verify({"force of a rigid wall on a bar that hits it", "rho c v A; " + source, 0.005,
          "mean over half of the contact, ringing of the front"},
         middle / steps / (rho * c * v * h) - 1.0);
  verify({"time that a bar touches a rigid wall", "2 L / c; " + source, 0.03,
          "the front is spread over some elements"},
         last / time - 1.0);
  verify({"impulse of a rigid wall on a bar", "2 m v; " + source, 0.02,
          "energy that stays in the ringing behind the front"},
         impulse / (2.0 * mass * v) - 1.0);
  EXPECT_NEAR(engine.momentum()[0], impulse - mass * v, 1e-9 * mass * v);
}

} // namespace
} // namespace kerf::fem
