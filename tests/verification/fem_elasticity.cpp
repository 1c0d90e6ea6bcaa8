// Plane bodies at rest against the theory of elasticity: thick cylinder, hole, membranes.
#include "tests/cases/fem_loads.hpp"
#include "tests/verification/verification.hpp"

#include "fem_core/mesh/disc.hpp"
#include "fem_core/mesh/tunnel.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kerf::fem {
namespace {

constexpr double pi = std::numbers::pi;

/// Stress xx, yy, xy, Pa.
using Stress = Eigen::Vector3d;

Stress stress_of(const Engine<2>& engine, std::uint32_t element) {
  const auto s = engine.element_state(element).stress;
  return {s[0], s[1], s[3]};
}

/// Stress at a corner of four elements of a row from the edge inwards, by the parabola through
/// their middles.
double at_edge(double first, double second, double third) {
  return (15.0 * first - 10.0 * second + 3.0 * third) / 8.0;
}

/// Of a stress rr, tt, rt at an angle.
Stress from_polar(const Stress& polar, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * c * polar[0] + s * s * polar[1] - 2 * c * s * polar[2],
          s * s * polar[0] + c * c * polar[1] + 2 * c * s * polar[2],
          c * s * (polar[0] - polar[1]) + (c * c - s * s) * polar[2]};
}

/// Largest difference between the stress of elements and a field in their middle.
template <class Field> double largest_error(const Engine<2>& engine, Field exact) {
  double error = 0.0;
  for (const std::uint32_t e : engine.active_elements()) {
    const Vec<2> middle = engine.mesh().corners(e).rowwise().mean();
    error = std::max(error, (stress_of(engine, e) - exact(middle)).cwiseAbs().maxCoeff());
  }
  return error;
}

Engine<2> started(const Mesh<2>& mesh, const IsotropicElastic& law, Plane plane, double damping,
                  const std::vector<BoundarySetting<2>>& boundary = {}) {
  Engine<2> engine(mesh, {.materials = cases::of<2>(law),
                          .plane = plane,
                          .boundary = boundary,
                          .mass_damping = damping});
  engine.start(0.9 * cases::critical_step(engine));
  return engine;
}

// Lamé: sigma_rr, tt = A -+ B / r² with A = p a²/(b² - a²), B = A b², and in plane strain
// u = (1 + nu)/E ((1 - 2 nu) A r + B / r); Timoshenko & Goodier, Theory of Elasticity, section 28.
// As a ring of quads and as rings of one row; elements of a tenth of the wall.
TEST(FemElasticity, of_a_thick_cylinder_is_that_of_lame) {
  const double a = 1.0, b = 2.0, p = 1.0, E = 1000.0, nu = 0.3;
  const double A = p * a * a / (b * b - a * a), B = A * b * b;
  const double exact = (1 + nu) / E * ((1 - 2 * nu) * A * a + B / a);
  const auto law = IsotropicElastic::from_young(1.0, E, nu);
  const double damping = 2.0 * std::sqrt(E) / 1.5; // the ring breathes with sqrt(E / rho) / radius
  const std::string source = "Lamé; Timoshenko & Goodier, Theory of Elasticity, section 28";
  {
    const Mesh<2> mesh =
        make_disc({.radius = b, .inner_radius = a, .radial = 10, .around = 64, .grading = 2.0});
    Engine<2> engine = started(mesh, law, Plane::strain, damping);
    const auto u =
        cases::settle(engine, cases::load_on(mesh, "inner", [&](const Vec<2>&, const Vec<2>& n) {
                        return Vec<2>(-p * n);
                      }));
    double error = 0.0;
    for (const std::uint32_t k : nodes_with_tag(mesh, "inner", "tag"))
      error = std::max(error, std::abs(mesh.position(k).dot(Vec<2>(&u[2 * k])) / a / exact - 1.0));
    const double of_stress = largest_error(engine, [&](const Vec<2>& x) {
      const double r2 = x.squaredNorm();
      return from_polar({A - B / r2, A + B / r2, 0.0}, std::atan2(x[1], x[0]));
    });
    std::printf("  ring of quads: displacement %.2e, stress %.2e\n", error, of_stress);
    verify({"displacement of the wall of a thick cylinder, quad4", source, 0.02,
            "10 elements through the wall: (h / r)²"},
           error);
    verify({"stress in a thick cylinder, quad4, over the largest", source, 0.02,
            "10 elements through the wall: (h / r)²"},
           of_stress / (A + B));
  }
  for (const Shape shape : {Shape::tri3, Shape::quad4}) {
    const double h = 0.1;
    const Mesh<2> mesh = make_box(
        BoxMesh<2>{.origin = {a, 0.0}, .size = {b - a, h}, .count = {10, 1}, .shape = shape});
    Engine<2> engine =
        started(mesh, law, Plane::axisymmetric, damping,
                {cases::held<2>("bottom", {false, true}), cases::held<2>("top", {false, true})});
    const auto u =
        cases::settle(engine, cases::load_on(mesh, "left", [&](const Vec<2>& x, const Vec<2>& n) {
                        return Vec<2>(-p * 2 * pi * x[0] * n);
                      }));
    double error = 0.0;
    for (const std::uint32_t k : nodes_with_tag(mesh, "left", "tag"))
      error = std::max(error, std::abs(u[2 * k] / exact - 1.0));
    std::printf("  rings of %s: %.2e\n", std::string(name_of(shape)).c_str(), error);
    verify({"displacement of the wall of a thick cylinder, rings of " + std::string(name_of(shape)),
            source, 0.02, "10 elements through the wall: (h / r)²"},
           error);
  }
}

// Kirsch (1898): a hole in an infinite plate under tension along x. The outline gets the tractions
// of the infinite plate, so the closed form holds in the square too. Elements at the wall are a
// tenth of its radius.
TEST(FemElasticity, around_a_hole_is_that_of_kirsch) {
  const double R = 1.0, tension = 1.0, E = 1000.0;
  const auto kirsch = [&](const Vec<2>& x) {
    const double angle = std::atan2(x[1], x[0]), c = std::cos(2 * angle), s = std::sin(2 * angle);
    const double r2 = R * R / x.squaredNorm(), r4 = r2 * r2, half = 0.5 * tension;
    return from_polar({half * (1 - r2) + half * (1 - 4 * r2 + 3 * r4) * c,
                       half * (1 + r2) - half * (1 + 3 * r4) * c,
                       -half * (1 + 2 * r2 - 3 * r4) * s},
                      angle);
  };
  const std::uint32_t radial = 20, around = 64;
  const Mesh<2> mesh = make_tunnel({.origin = {-4 * R, -4 * R},
                                    .size = {8 * R, 8 * R},
                                    .radius = R,
                                    .radial = radial,
                                    .around = around});
  Engine<2> engine = started(mesh, IsotropicElastic::from_young(1.0, E, 0.25), Plane::strain,
                             2.0 * std::sqrt(E) / (4 * R));
  cases::Load load;
  for (const char* side : {"left", "right", "bottom", "top"}) {
    const cases::Load of_side = cases::load_on(mesh, side, [&](const Vec<2>& x, const Vec<2>& n) {
      const Stress s = kirsch(x);
      return Vec<2>(s[0] * n[0] + s[2] * n[1], s[2] * n[0] + s[1] * n[1]);
    });
    load.nodes.insert(load.nodes.end(), of_side.nodes.begin(), of_side.nodes.end());
    load.force.insert(load.force.end(), of_side.force.begin(), of_side.force.end());
  }
  cases::settle(engine, load);

  const std::string source = "G. Kirsch, Z. VDI 42 (1898) 797-807";
  const double error = largest_error(engine, kirsch) / (3.0 * tension);
  // The elements at the wall that are nearest to its top, and those behind them.
  std::vector<std::pair<double, std::uint32_t>> above;
  for (const std::uint32_t e : engine.active_elements()) {
    const Vec<2> middle = mesh.corners(e).rowwise().mean();
    if (middle[0] > 0.0 && middle[0] < 1.01 * middle[1] * std::tan(pi / around))
      above.emplace_back(middle[1], e);
  }
  std::sort(above.begin(), above.end());
  ASSERT_EQ(above.size(), radial);
  const double angle = pi / 2 - pi / around;
  const double peak =
      at_edge(stress_of(engine, above[0].second)[0], stress_of(engine, above[1].second)[0],
              stress_of(engine, above[2].second)[0]);
  const double exact = kirsch(R * Vec<2>(std::cos(angle), std::sin(angle)))[0];
  std::printf("  stress %.2e of the largest, at the wall %.3f, exact %.3f\n", error, peak, exact);
  verify({"stress around a hole, quad4, over the largest", source, 0.02,
          "elements of a tenth of the radius: (h / R)²"},
         error);
  verify({"largest stress at the wall of a hole, quad4", source, 0.02,
          "elements of a tenth of the radius, parabola to the wall"},
         peak / exact - 1.0);
}

/// A box whose unit square is bent.
template <class Map> Mesh<2> mapped(const BoxMesh<2>& box, Map map) {
  Mesh<2> mesh = make_box(box);
  for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
    Eigen::Map<Vec<2>>(&mesh.positions[2 * a]) = map(mesh.position(a));
  return mesh;
}

// R. D. Cook, J. Struct. Div. ASCE 100 (1974) 1851-1863: a tapered panel, 44 and 16 high, 48 long,
// sheared by a force of one; E = 1, nu = 1/3, plane stress. Deflection of the middle of the free
// edge.
TEST(FemElasticity, of_cooks_membrane_has_the_published_deflection) {
  const std::uint32_t count = 32;
  const Mesh<2> mesh = mapped({.size = {1.0, 1.0}, .count = {count, count}}, [](const Vec<2>& s) {
    return Vec<2>(48 * s[0], 44 * s[0] + s[1] * (44 - 28 * s[0]));
  });
  Engine<2> engine = started(mesh, IsotropicElastic::from_young(1.0, 1.0, 1.0 / 3.0), Plane::stress,
                             0.05, {cases::held<2>("left", {true, true})});
  const auto u =
      cases::settle(engine, cases::load_on(mesh, "right", [](const Vec<2>&, const Vec<2>&) {
                      return Vec<2>(0.0, 1.0 / 16.0);
                    }));
  double tip = 0.0;
  for (const std::uint32_t a : nodes_with_tag(mesh, "right", "tag"))
    if (std::abs(mesh.position(a)[1] - 52.0) < 1e-9)
      tip = u[2 * a + 1];
  std::printf("  tip %.3f\n", tip);
  verify({"tip of Cook's membrane, 32 x 32 quad4",
          "23.96; R. D. Cook, J. Struct. Div. ASCE 100 (1974) 1851", 0.01,
          "0.6 % of this mesh in every code: full integration is stiff in bending"},
         tip / 23.96 - 1.0);
}

// NAFEMS LE1: a quarter of an elliptic membrane, pulled with 10 MPa at its outer edge; sigma_yy at
// the end of the inner axis.
TEST(FemElasticity, of_the_elliptic_membrane_of_nafems_has_its_stress) {
  const std::uint32_t count = 32;
  const Mesh<2> mesh = mapped(
      {.size = {1.0, 1.0}, .count = {count, count}, .grading = {4.0, 2.0}}, [](const Vec<2>& s) {
        const double c = std::cos(0.5 * pi * s[1]), d = std::sin(0.5 * pi * s[1]);
        return Vec<2>((2.0 + 1.25 * s[0]) * c, (1.0 + 1.75 * s[0]) * d);
      });
  Engine<2> engine =
      started(mesh, IsotropicElastic::from_young(7850.0, 210e9, 0.3), Plane::stress, 1500.0,
              {cases::held<2>("bottom", {false, true}), cases::held<2>("top", {true, false})});
  cases::settle(engine, cases::load_on(mesh, "right", [](const Vec<2>&, const Vec<2>& n) {
                  return Vec<2>(10e6 * n);
                }));
  // Along the axis from D, the mean of the first two elements across it: it is even there.
  const auto yy = [&](std::uint32_t i) {
    return (9 * stress_of(engine, i)[1] - stress_of(engine, count + i)[1]) / 8;
  };
  const double stress = at_edge(yy(0), yy(1), yy(2));
  std::printf("  sigma_yy at D %.2f MPa\n", 1e-6 * stress);
  verify({"stress in the elliptic membrane LE1, 32 x 32 quad4",
          "92.7 MPa; NAFEMS, The Standard NAFEMS Benchmarks (1990)", 0.02,
          "elements of a seventieth of the wall, parabola to the edge"},
         stress / 92.7e6 - 1.0);
}

} // namespace
} // namespace kerf::fem
