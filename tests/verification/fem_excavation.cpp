// A hole that is excavated in ground under stress, and Drucker-Prager rock on paths of the engine.
#include "fem_core/relax.hpp"

#include "fem_core/mesh/tunnel.hpp"
#include "tests/cases/fem_loads.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

namespace kerf::fem {
namespace {

using cases::rock;
constexpr double pi = std::numbers::pi;

// Kirsch (1898): a round opening in rock under the stresses S_x, S_y, plane strain. At its wall
// sigma_tt = S_x + S_y - 2 (S_x - S_y) cos 2a, and the wall moves by
// u_r = R / 4G (S_x + S_y + (3 - 4 nu) (S_x - S_y) cos 2a) when the rock in it is taken out. The
// sides, 12 radii away, go on to carry the stress that was there: (R / D)² = 0.007.
TEST(FemExcavation, of_a_tunnel_under_K0_moves_and_loads_its_wall_as_kirsch_says) {
  const double R = 2.0, D = 12.0 * R, S_y = -10e6, S_x = 0.6 * S_y, G = 4e9, nu = 0.25;
  const std::uint32_t around = 64;
  const Mesh<2> mesh = make_tunnel({.origin = {-D, -D},
                                    .size = {2 * D, 2 * D},
                                    .radius = R,
                                    .radial = 28,
                                    .around = around,
                                    .excavation = true});
  Settings<2> settings{.materials = cases::of<2>(rock)};
  settings.in_situ_stress = InSituStress<2>{.stress = {S_x, S_y, nu * (S_x + S_y), 0.0}};
  for (const char* side : {"left", "right", "bottom", "top"})
    settings.absorbing.push_back({.tag = side});
  Engine<2> engine(mesh, settings);
  engine.start(0.9 * cases::critical_step(engine));
  for (int n = 0; n < 100; ++n)
    engine.integrate();
  double moved = 0.0; // before anything is excavated
  for (const double u : engine.displacement())
    moved = std::max(moved, std::abs(u));
  EXPECT_LE(moved, 1e-9 * R * -S_y / G);
  Change<2> change;
  change.remove = {"excavation"};
  change.reset_displacement = true;
  engine.change(change);
  const Relaxation result = relax(engine, 1e-4);

  const auto u = engine.displacement_since_reset();
  const double mean = S_x + S_y, half = S_x - S_y;
  double error = 0.0;
  for (const std::uint32_t a : nodes_with_tag(mesh, "wall", "tag")) {
    const Vec<2> X = mesh.position(a);
    const double angle = std::atan2(X[1], X[0]);
    const double exact = R / (4 * G) * (mean + half * (3 - 4 * nu) * std::cos(2 * angle));
    error = std::max(error, std::abs(X.dot(Vec<2>(&u[2 * a])) / R - exact));
  }
  const double most = R / (4 * G) * (std::abs(mean) + std::abs(half) * (3 - 4 * nu));

  // Hoop stress at the wall by the parabola through the first three elements of each ray.
  std::map<int, std::map<double, std::uint32_t>> rays;
  for (const std::uint32_t e : engine.active_elements()) {
    const Vec<2> middle = mesh.corners(e).rowwise().mean();
    if (middle.norm() < 1.6 * R)
      rays[static_cast<int>(std::floor(std::atan2(middle[1], middle[0]) * around / (2 * pi)))]
          [middle.norm()] = e;
  }
  ASSERT_EQ(rays.size(), around);
  double of_stress = 0.0;
  for (const auto& [ray, elements] : rays) {
    ASSERT_GE(elements.size(), 3u);
    std::vector<double> r, hoop;
    double angle = 0.0;
    for (const auto& [distance, e] : elements) {
      const Vec<2> middle = mesh.corners(e).rowwise().mean();
      angle = std::atan2(middle[1], middle[0]);
      const auto s = engine.element_state(e).stress;
      const double sine = std::sin(angle), cosine = std::cos(angle);
      r.push_back(distance);
      hoop.push_back(sine * sine * s[0] + cosine * cosine * s[1] - 2 * sine * cosine * s[3]);
    }
    double at_wall = 0.0; // Lagrange
    for (std::size_t i = 0; i < 3; ++i) {
      double value = hoop[i];
      for (std::size_t j = 0; j < 3; ++j)
        if (j != i)
          value *= (R - r[j]) / (r[i] - r[j]);
      at_wall += value;
    }
    of_stress = std::max(of_stress, std::abs(at_wall - (mean - 2 * half * std::cos(2 * angle))));
  }
  const double strongest = std::abs(mean) + 2 * std::abs(half);
  std::printf("  %d steps; wall: displacement %.2e, hoop stress %.2e of the largest\n",
              static_cast<int>(result.steps), error / most, of_stress / strongest);
  const std::string source = "G. Kirsch, Z. VDI 42 (1898) 797-807";
  verify({"displacement of the wall of an excavated tunnel, K0 0.6", source, 0.02,
          "sides at 12 radii, elements of a tenth of the radius"},
         error / most);
  verify({"hoop stress at the wall of an excavated tunnel, K0 0.6, over the largest", source, 0.02,
          "sides at 12 radii, elements of a tenth of the radius, parabola to the wall"},
         of_stress / strongest);
}

/// One element of 1 mm whose sides move with constant velocities: strain rates along the axes, 1/s.
Engine<3> strained(const Law& law, double pressure, const Vec<3>& rates) {
  Settings<3> settings{.materials = cases::of<3>(law)};
  settings.in_situ_stress = InSituStress<3>{.stress = {-pressure, -pressure, -pressure}};
  const char* fixed[] = {"left", "bottom", "back"};
  const char* moving[] = {"right", "top", "front"};
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<bool, 3> along{};
    along[i] = true;
    settings.boundary.push_back(cases::held<3>(fixed[i], along));
    BoundarySetting<3> side = cases::held<3>(moving[i], along);
    side.motion = Motion::velocity;
    side.velocity[static_cast<Eigen::Index>(i)] = 1e-3 * rates[static_cast<Eigen::Index>(i)];
    settings.boundary.push_back(side);
  }
  return Engine<3>(make_box(BoxMesh<3>{.size = Vec<3>::Constant(1e-3), .count = {1, 1, 1}}),
                   settings);
}

// On a path of constant strain rates from an isotropic stress the deviator keeps its direction, so
// the equations of the flow are linear: with t = 2 mu |e| / sqrt 2 and p = p_0 + K tr eps of the
// elastic path, gamma = (t + eta p - xi c) / (mu + K eta eta') once that is positive, and
// sqrt J2 = t - mu gamma, mean p - K eta' gamma; on the cut-off p = p_t, and sqrt J2 stays at the
// corner.
TEST(FemDruckerPrager, follows_triaxial_paths_and_the_cut_off_in_the_engine) {
  const DruckerPrager law = DruckerPrager::from(
      rock,
      {.cohesion = 10e6, .friction_angle = pi / 6.0, .dilation_angle = 0.2, .tension_cutoff = 3e6});
  struct Path {
    const char* name;
    double pressure;
    Vec<3> rates;
  };
  for (const Path& path :
       {Path{"compression", 5e6, {2.0, 2.0, -10.0}}, Path{"extension", 20e6, {-3.0, -3.0, 8.0}},
        Path{"tension", 1e6, {8.0, 5.0, 5.0}}}) {
    Engine<3> engine = strained(law, path.pressure, path.rates);
    const double dt = 0.8 * cases::critical_step(engine);
    engine.start(dt);
    const double end = 1e-3; // s
    double error = 0.0;
    bool flowed = false, cut = false;
    const Vec<3> e = path.rates - Vec<3>::Constant(path.rates.mean());
    const double K = rock.moduli.bulk(), mu = rock.moduli.mu;
    for (double time = 0.0; time < end;) {
      time = static_cast<double>(engine.step()) * dt; // of the forces of this step
      engine.integrate();
      const double t = 2.0 * mu * time * e.norm() / std::sqrt(2.0);
      const double p = -path.pressure + K * time * path.rates.sum();
      const double gamma =
          std::max(0.0, (t + law.eta * p - law.strength) / (mu + K * law.eta * law.flow_eta));
      double root = t - mu * gamma, mean = p - K * law.flow_eta * gamma;
      if (mean > law.cutoff) {
        mean = law.cutoff;
        root = std::min(t, law.corner);
        cut = true;
      }
      flowed = flowed || gamma > 0.0;
      const auto stress = engine.element_state(0).stress;
      for (int i = 0; i < 3; ++i) {
        const double exact = mean + root * std::sqrt(2.0) * e[i] / e.norm();
        error = std::max(error, std::abs(stress[i] - exact));
      }
    }
    EXPECT_TRUE(flowed || cut) << path.name;
    EXPECT_EQ(cut, std::string(path.name) == "tension");
    verify({std::string("Drucker-Prager in the engine: stress of triaxial ") + path.name +
                ", over the strength",
            "closed form of proportional strain; de Souza Neto et al., section 8.3", 1e-6,
            "rounding of some thousand steps"},
           error / law.strength);
  }
}

} // namespace
} // namespace kerf::fem
