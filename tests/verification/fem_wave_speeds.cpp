// How fast waves travel through the elements of every shape and along a free surface.
#include "tests/cases/fem_loads.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kerf::fem {
namespace {

using cases::rock;
constexpr double pi = std::numbers::pi;
const double c_P = std::sqrt(rock.moduli.uniaxial() / rock.density); // m/s
const double c_S = std::sqrt(rock.moduli.mu / rock.density);

/// Mean place of a displacement, weighted with its square, m.
template <int dim> double place(const Engine<dim>& engine, int component) {
  const std::vector<double> u = engine.displacement();
  double sum = 0.0, first = 0.0;
  for (std::size_t a = 0; a < engine.mesh().num_nodes(); ++a) {
    const double weight = std::pow(u[a * dim + static_cast<std::size_t>(component)], 2);
    sum += weight;
    first += weight * engine.mesh().position(a)[0];
  }
  return first / sum;
}

template <int dim> double speed_of(Shape shape, int component, double speed) {
  const double h = 1e-3, length = 64 * h, way = 80 * h;
  BoxMesh<dim> box{.size = Vec<dim>::Constant(3 * h), .shape = shape};
  box.count.fill(3);
  box.size[0] = 240 * h;
  box.count[0] = 240;
  Period<dim> period{.length = box.size};
  period.length[0] = 0.0;
  const InitialPulse pulse{.amplitude = 1e-8,
                           .center = 70 * h,
                           .length = length,
                           .wave_speed = speed,
                           .spacing = h,
                           .component = component};
  Engine<dim> engine(
      make_box(box, period),
      {.materials = cases::of<dim>(rock), .boundary = {}, .initial = {cases::started<dim>(pulse)}});
  const int steps = static_cast<int>(std::ceil(way / speed / (0.8 * cases::critical_step(engine))));
  const double time_step = way / speed / steps;
  engine.start(time_step);
  const double from = place(engine, component);
  for (int n = 0; n < steps; ++n)
    engine.integrate();
  return (place(engine, component) - from) / (steps * time_step);
}

// A pulse is as fast as its group: slower by (k h)²/8 on lumped linear elements, 0.1 % for the main
// wave number of a pulse of 64 elements, more for those beside it.
TEST(FemWaves, of_compression_and_shear_travel_with_their_speeds_in_elements_of_every_shape) {
  for (const Shape shape : {Shape::tri3, Shape::quad4, Shape::tet4, Shape::hex8})
    for (const int component : {0, 1}) {
      const double exact = component == 0 ? c_P : c_S;
      const double speed = dimension_of(shape) == 2 ? speed_of<2>(shape, component, exact)
                                                    : speed_of<3>(shape, component, exact);
      std::printf("  %s %s: %+.2e\n", std::string(name_of(shape)).c_str(),
                  component == 0 ? "P" : "S", speed / exact - 1.0);
      verify({std::string(component == 0 ? "c_P" : "c_S") + " in " + std::string(name_of(shape)),
              "c_P² = C11 / rho, c_S² = mu / rho", 0.005,
              "the group of a pulse of 64 elements lags by (k h)² / 8 and more"},
             speed / exact - 1.0);
    }
}

/// Root of (2 - x)² = 4 sqrt(1 - x) sqrt(1 - x c_S²/c_P²), x = c_R²/c_S²; Lord Rayleigh, Proc.
/// London Math. Soc. s1-17 (1885) 4-11, doi:10.1112/plms/s1-17.1.4.
double rayleigh_speed() {
  double low = 0.1, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (low + high), ratio = c_S / c_P;
    const bool above = (2 - x) * (2 - x) > 4 * std::sqrt(1 - x) * std::sqrt(1 - x * ratio * ratio);
    (above ? high : low) = x;
  }
  return c_S * std::sqrt(0.5 * (low + high));
}

// Started with the motion of the wave over a half space, which is 2.5 wave lengths deep here: there
// it has 0.2 % left. The phase of the surface tells how far the wave is after two wave lengths;
// elements of a fortieth of it let it lag by (k h)²/24, 0.1 %.
TEST(FemWaves, of_rayleigh_travel_along_a_free_surface) {
  const int count = 40, lengths = 2;
  const double wave = 1.0, depth = 2.5 * wave, k = 2 * pi / wave;
  const double c_R = rayleigh_speed(), omega = c_R * k;
  const double q = std::sqrt(k * k - std::pow(omega / c_P, 2));
  const double s = std::sqrt(k * k - std::pow(omega / c_S, 2));
  const Mesh<2> mesh = make_box(
      BoxMesh<2>{.origin = {0.0, -depth}, .size = {wave, depth}, .count = {count, count * 5 / 2}},
      {.length = {wave, 0.0}});
  std::vector<double> u(mesh.positions.size()), v(u.size());
  for (std::size_t a = 0; a < mesh.num_nodes(); ++a) {
    const Vec<2> X = mesh.position(a);
    const double eq = std::exp(q * X[1]), es = std::exp(s * X[1]), ss = s * s + k * k;
    const double along = 1e-6 * k * (eq - 2 * q * s / ss * es);
    const double up = -1e-6 * q * (eq - 2 * k * k / ss * es);
    u[2 * a] = along * std::sin(k * X[0]);
    u[2 * a + 1] = up * std::cos(k * X[0]);
    v[2 * a] = -omega * along * std::cos(k * X[0]);
    v[2 * a + 1] = omega * up * std::sin(k * X[0]);
  }
  Engine<2> engine(mesh, {.materials = cases::of<2>(rock),
                          .boundary = {cases::held<2>("bottom", {true, true})}});
  const double time = lengths * wave / c_R;
  const int steps = static_cast<int>(std::ceil(time / (0.8 * cases::critical_step(engine))));
  engine.start(time / steps);
  engine.set_motion(u, v);
  for (int n = 0; n < steps; ++n)
    engine.integrate();
  const std::vector<double> end = engine.displacement();
  double sine = 0.0, cosine = 0.0; // u_x = A sin(k x - phase)
  for (const std::uint32_t a : nodes_with_tag(mesh, "top", "tag")) {
    sine += end[2 * a] * std::sin(k * mesh.position(a)[0]);
    cosine += end[2 * a] * std::cos(k * mesh.position(a)[0]);
  }
  const double phase = std::atan2(-cosine, sine); // of whole wave lengths: zero
  std::printf("  Rayleigh: %+.2e\n", phase / (2 * pi * lengths));
  verify({"speed of a Rayleigh wave", "Lord Rayleigh (1885), doi:10.1112/plms/s1-17.1.4", 0.005,
          "(k h)² / 24 is 0.001, half a per mille for the depth"},
         phase / (2 * pi * lengths));
  EXPECT_GT(sine / (count / 2), 0.9 * u[2 * (nodes_with_tag(mesh, "top", "tag")[count / 4])]);
}

} // namespace
} // namespace kerf::fem
