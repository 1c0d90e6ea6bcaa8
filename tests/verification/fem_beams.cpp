// Cantilevers: how far they bend, how they swing, and large rotations.
#include "tests/cases/fem_loads.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kerf::fem {
namespace {

/// A bar of height 1 m from the clamp at x = 0, in plane stress: its section has the stiffnesses of
/// a beam.
struct Bar {
  double length = 10.0; // m
  std::array<std::uint32_t, 2> count;
  double E = 1000.0, nu = 0.3, rho = 1.0;

  double bending() const { return E / 12.0; } // E I, N m²
  double shearing() const { // k G A, N; G. R. Cowper, J. Appl. Mech. 33 (1966) 335
    return 10 * (1 + nu) / (12 + 11 * nu) * E / (2 * (1 + nu));
  }
  double slow() const { // lowest frequency of a slender one, rad/s
    return 3.516 / (length * length) * std::sqrt(bending() / rho);
  }
  Mesh<2> mesh() const {
    return make_box(BoxMesh<2>{.origin = {0.0, -0.5}, .size = {length, 1.0}, .count = count});
  }
  Engine<2> engine(const Law& law, double damping, bool finite_strain = false) const {
    Engine<2> engine(mesh(), {.materials = cases::of<2>(law, Formulation::full, finite_strain),
                              .plane = Plane::stress,
                              .boundary = {cases::held<2>("left", {true, true})},
                              .mass_damping = damping});
    engine.start(0.8 * cases::critical_step(engine));
    return engine;
  }
  Law elastic() const { return IsotropicElastic::from_young(rho, E, nu); }
};

/// Mean displacement of the free end, m.
Vec<2> tip(const Mesh<2>& mesh, const std::vector<double>& u) {
  Vec<2> sum = Vec<2>::Zero();
  const auto nodes = nodes_with_tag(mesh, "right", "tag");
  for (const std::uint32_t a : nodes)
    sum += Vec<2>(&u[2 * a]);
  return sum / static_cast<double>(nodes.size());
}

// w = P L³ / 3EI + P L / kGA: S. P. Timoshenko, Phil. Mag. 41 (1921) 744. The load has the
// parabola of the shear stress of the section. Full integration is too stiff in bending by half of
// (length of an element / height of the bar)², 0.35 %; the clamp does not let the section contract.
TEST(FemCantilever, bends_like_a_beam_of_timoshenko) {
  const Bar bar{.count = {120, 8}};
  Engine<2> engine = bar.engine(bar.elastic(), 2.0 * bar.slow());
  const double P = 1e-3;
  const auto u = cases::settle(
      engine, cases::load_on(engine.mesh(), "right", [&](const Vec<2>& x, const Vec<2>&) {
        return Vec<2>(0.0, 1.5 * P * (1.0 - 4.0 * x[1] * x[1]));
      }));
  const double L = bar.length;
  const double exact = P * L * L * L / (3 * bar.bending()) + P * L / bar.shearing();
  const double error = tip(engine.mesh(), u)[1] / exact - 1.0;
  std::printf("  deflection %+.2e\n", error);
  verify({"deflection of a cantilever, 120 x 8 quad4",
          "S.P. Timoshenko, Phil. Mag. 41 (1921) 744, doi:10.1080/14786442108636264", 0.01,
          "full integration is stiff in bending by 0.0035; the clamp and ends of the load"},
         error);
}

/// Solution of the beam equations (w, slope, moment, shear force)' = A (…) over the length, for a
/// motion with w² = omega2, rad²/s².
Eigen::Matrix4d transfer(const Bar& bar, double omega2) {
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A(0, 1) = 1.0;
  A(0, 3) = 1.0 / bar.shearing();
  A(1, 2) = 1.0 / bar.bending();
  A(2, 1) = -bar.rho / 12.0 * omega2;
  A(2, 3) = -1.0;
  A(3, 0) = -bar.rho * omega2;
  Eigen::Matrix4d part = Eigen::Matrix4d::Identity(), sum = part;
  for (int k = 1; k < 60; ++k) // of the exponential
    sum += part = part * A * bar.length / k;
  return sum;
}

/// The lowest: nothing moves at the clamp, and the end is free where moment and force can vanish.
double lowest_frequency(const Bar& bar) {
  const auto free_end = [&](double omega) {
    return transfer(bar, omega * omega).bottomRightCorner<2, 2>().determinant();
  };
  double low = 0.5 * bar.slow(), high = 1.2 * bar.slow();
  const double sign = free_end(low);
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (free_end(middle) * sign > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Let go from the deflection of a slender beam under a force at its end, which is 97 % of the
// lowest mode; the mass times that shape sees less still of the others. Two swings are timed by the
// zeros of this sum.
TEST(FemCantilever, swings_like_a_beam_of_timoshenko) {
  const Bar bar{.count = {120, 8}};
  Engine<2> engine = bar.engine(bar.elastic(), 0.0);
  const std::vector<double> mass = engine.mass();
  std::vector<double> shape(engine.mesh().positions.size());
  for (std::size_t a = 0; a < mass.size(); ++a) {
    const Vec<2> X = engine.mesh().position(a) / bar.length;
    shape[2 * a] = -X[1] * (6 * X[0] - 3 * X[0] * X[0]) * 1e-3;
    shape[2 * a + 1] = X[0] * X[0] * (3 - X[0]) * 1e-3;
  }
  engine.set_motion(shape, std::vector<double>(shape.size()));
  const double time_step = 0.8 * cases::critical_step(engine);
  std::vector<double> zeros; // s
  double before = 1.0;
  for (int n = 1; zeros.size() < 4; ++n) {
    engine.integrate();
    const std::vector<double> u = engine.displacement();
    double q = 0.0;
    for (std::size_t k = 0; k < u.size(); ++k)
      q += mass[k / 2] * shape[k] * u[k];
    if (before * q < 0.0)
      zeros.push_back((n - q / (q - before)) * time_step);
    before = q;
  }
  const double frequency = 1.5 * 2 * std::numbers::pi / (zeros[3] - zeros[0]);
  const double error = frequency / lowest_frequency(bar) - 1.0;
  std::printf("  frequency %+.2e; a slender beam would be %+.2e off\n", error,
              bar.slow() / lowest_frequency(bar) - 1.0);
  verify({"lowest frequency of a cantilever, 120 x 8 quad4",
          "S.P. Timoshenko, Phil. Mag. 41 (1921) 744, doi:10.1080/14786442108636264", 0.01,
          "half of that of the stiffness"},
         error);
}

struct Elastica {
  double load, across, along; // P L² / EI, w / L, u / L
};

// A dead force across the end of a beam that does not stretch: K. Mattiasson, Int. J. Numer. Meth.
// Eng. 17 (1981) 145-153, doi:10.1002/nme.1620170113, table 1. With the length of 16 heights shear
// adds 0.2 %, and at the clamp fibres are strained by up to 14 %, where the laws differ from a
// straight line by 0.3 to 0.6 % of the moment; full integration is too stiff by 0.8 %.
const std::vector<Elastica> mattiasson = {
    {1, 0.30172, 0.05643}, {2, 0.49346, 0.16064}, {5, 0.71379, 0.38763}, {10, 0.81061, 0.55500}};

void bend(const Law& law, const Bar& bar, std::span<const Elastica> loads,
          const std::string& name) {
  Engine<2> engine = bar.engine(law, 2.0 * bar.slow(), true);
  const double L = bar.length;
  for (const Elastica& elastica : loads) {
    const double P = elastica.load * bar.bending() / (L * L);
    const auto u = cases::settle(
        engine, cases::load_on(engine.mesh(), "right",
                               [&](const Vec<2>&, const Vec<2>&) { return Vec<2>(0.0, P); }));
    const Vec<2> end = tip(engine.mesh(), u) / L, exact(-elastica.along, elastica.across);
    const double error = (end - exact).norm() / exact.norm();
    std::printf("  P L² / EI = %g: u / L = %.4f, w / L = %.4f, %.2e off\n", elastica.load, -end[0],
                end[1], error);
    verify({"end of a cantilever that is bent far, " + name,
            "elastica; K. Mattiasson, doi:10.1002/nme.1620170113", 0.01,
            "0.008 of elements in bending; shear and the strain of fibres work against it"},
           error);
  }
}

TEST(FemCantilever, bent_far_by_a_dead_force_is_the_elastica_with_an_objective_rate) {
  const Bar bar{.length = 16.0, .count = {128, 4}, .nu = 0.0};
  bend(bar.elastic(), bar, mattiasson, "objective rate");
}

TEST(FemCantilever, bent_far_by_a_dead_force_is_the_elastica_when_it_is_neo_hookean) {
  const Bar bar{.length = 16.0, .count = {128, 4}, .nu = 0.0};
  bend(NeoHookean::from(std::get<IsotropicElastic>(bar.elastic())), bar, {&mattiasson[3], 1},
       "neo-Hookean");
}

} // namespace
} // namespace kerf::fem
