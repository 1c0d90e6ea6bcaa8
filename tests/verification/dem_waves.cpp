// Speeds of long compression and shear waves in bonded lattices.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::LatticeType;

/// A standing wave cos(k x_axis) of one wave length over the whole period. Its particles begin with
/// velocities along a component and swing at omega = c k. -> c, m/s
template <int dim> double wave_speed(dem::Settings<dim> settings, int axis, int component) {
  const double k = 2.0 * std::numbers::pi / settings.period.length[axis];
  const double omega_max = std::sqrt(dem::Engine<dim>(settings).step_limit().omega2);
  const Vec<dim> reach = Vec<dim>::Constant(1e-3 * spacing);
  for (const Vec<dim>& x : settings.positions) {
    dem::InitialCondition<dim> condition;
    condition.box = Box<dim>{x - reach, x + reach};
    condition.velocity[component] = 1e-7 * spacing * omega_max * std::cos(k * x[axis]);
    settings.initial.push_back(condition);
  }
  dem::Engine<dim> engine(settings);
  const auto rate = [&] { // of the wave; what else swings is orthogonal to it or small
    double sum = 0.0;
    for (std::size_t i = 0; i < engine.size(); ++i)
      sum += engine.particles().velocity[i][component] *
             std::cos(k * engine.particles().reference[i][axis]);
    return sum;
  };
  const double dt = 0.5 * 2.0 / omega_max;
  engine.start(dt);
  cases::step(engine);
  double before = rate(), first = 0.0, last = 0.0;
  constexpr int crossings = 9; // four periods
  for (int n = 1, found = 0; found < crossings; ++n) {
    cases::step(engine);
    const double now = rate();
    if (before * now < 0.0) {
      last = (n - now / (now - before)) * dt;
      first = ++found == 1 ? last : first;
    }
    before = now;
  }
  return std::numbers::pi * (crossings - 1) / (last - first) / k;
}

/// Verifies the speeds of P and S waves along an axis.
template <int dim>
void verify_speeds(const std::string& lattice, const dem::Settings<dim>& settings, int axis,
                   double density, double C11, double C66, const std::string& moduli) {
  // Dispersion (k d)² / 24 of a chain of this spacing, less of lattices; three times that.
  const double kd = 2.0 * std::numbers::pi * spacing / settings.period.length[axis];
  for (const bool shear : {false, true}) {
    const double c = wave_speed(settings, axis, shear ? (axis + 1) % dim : axis);
    const double error = c / std::sqrt((shear ? C66 : C11) / density) - 1.0;
    std::printf("%s, axis %d, %s: %+.2e, (k d)² / 24 = %.2e\n", lattice.c_str(), axis,
                shear ? "S" : "P", error, kd * kd / 24.0);
    verify({std::string("speed of ") + (shear ? "S" : "P") + " waves in the " + lattice +
                " along " + "xyz"[axis],
            std::string(shear ? "sqrt(C66 / rho), " : "sqrt(C11 / rho), ") + moduli, kd * kd / 8.0,
            "three times the dispersion (k d)² / 24"},
           error);
  }
}

// Reference: C11 = sqrt(3)/4 (3 k_n + k_t), C66 = sqrt(3)/4 (k_n + k_t), the same in every
// direction; density of a particle over its cell, sqrt(3)/2 d².
TEST(LatticeWaves, of_the_triangular_lattice_have_the_speeds_of_its_moduli) {
  const double k_n = 1e10, row = 0.5 * std::numbers::sqrt3;
  for (const double ratio : {0.2, 1.0})
    for (const int axis : {0, 1}) {
      const std::array<int, 2> count =
          axis == 0 ? std::array<int, 2>{64, 6} : std::array<int, 2>{6, 64};
      auto settings = cases::lattice_model<2>(LatticeType::triangular, count, rock(2, ratio));
      settings.period.length = {count[0] * spacing, count[1] * row * spacing};
      const double mass = dem::Engine<2>(settings).particles().mass[0];
      verify_speeds<2>("triangular lattice", settings, axis, mass / (row * spacing * spacing),
                       0.5 * row * k_n * (3.0 + ratio), 0.5 * row * k_n * (1.0 + ratio),
                       "homogenisation of six bonds");
    }
}

// Reference: along a cube edge, C11 = sqrt(2) (k_n + k_t) / d and C66 = (k_n + k_t) / (sqrt(2) d),
// with particles that turn freely; density of a particle over d³ / sqrt(2).
TEST(LatticeWaves, of_the_face_centred_lattice_have_the_speeds_of_its_moduli) {
  const double k_n = 1e7, root = std::numbers::sqrt2;
  for (const double ratio : {0.2, 1.0}) {
    const std::array<int, 3> count{40, 3, 3};
    auto settings = cases::lattice_model<3>(LatticeType::fcc, count, rock(3, ratio));
    for (int a = 0; a < 3; ++a)
      settings.period.length[a] = count[static_cast<std::size_t>(a)] * root * spacing;
    const double mass = dem::Engine<3>(settings).particles().mass[0];
    const double C11 = root * k_n * (1.0 + ratio) / spacing;
    verify_speeds<3>("face-centred lattice", settings, 0,
                     mass * root / (spacing * spacing * spacing), C11, 0.5 * C11,
                     "homogenisation of twelve bonds");
  }
}

} // namespace
} // namespace kerf
