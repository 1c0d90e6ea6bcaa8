#include "fem_core/initial.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace kerf::fem {
namespace {

double pulse_displacement(const InitialPulse& pulse, double z) {
  if (!(std::abs(z) < 0.5 * pulse.length))
    return 0.0;
  const double c = std::cos(std::numbers::pi * z / pulse.length);
  return pulse.amplitude * c * c; // = A (1 + cos 2x) / 2
}

/// Velocity of a pulse that travels as u(z - wave_speed t), m/s. With a spacing s the slope is the
/// difference over s, which gives every harmonic the frequency 2 c/s sin(k s/2) that it has on a
/// chain of masses and on lumped linear elements.
double pulse_velocity(const InitialPulse& pulse, double z) {
  const double s = pulse.spacing;
  if (s > 0.0)
    return -pulse.wave_speed *
           (pulse_displacement(pulse, z + 0.5 * s) - pulse_displacement(pulse, z - 0.5 * s)) / s;
  if (!(std::abs(z) < 0.5 * pulse.length))
    return 0.0;
  const double k = 2.0 * std::numbers::pi / pulse.length; // rad/m
  return 0.5 * pulse.wave_speed * pulse.amplitude * k * std::sin(k * z);
}

void check(const InitialPulse& pulse, std::size_t number) {
  if (!(pulse.length > 0.0))
    throw InputError(fmt::format("initial[{}].length", number),
                     fmt::format("{} m must be positive", pulse.length));
  if (!(pulse.spacing >= 0.0))
    throw InputError(fmt::format("initial[{}].spacing", number),
                     fmt::format("{} m must not be negative", pulse.spacing));
}

} // namespace

template <int dim>
void add_initial(const Mesh<dim>& mesh, const std::vector<InitialSetting<dim>>& settings,
                 std::span<double> displacement, std::span<double> velocity) {
  for (std::size_t k = 0; k < settings.size(); ++k) {
    const auto& setting = settings[k];
    if (setting.pulse)
      check(*setting.pulse, k);
    for (std::size_t a = 0; a < mesh.num_nodes(); ++a) {
      const Vec<dim> X = mesh.position(a);
      if (setting.box && !setting.box->contains(X))
        continue;
      if (setting.velocity)
        Eigen::Map<Vec<dim>>(velocity.data() + a * dim) += setting.velocity->velocity;
      if (setting.pulse) {
        const InitialPulse& pulse = *setting.pulse;
        Vec<dim> from_center = Vec<dim>::Zero();
        from_center[pulse.axis] = X[pulse.axis] - pulse.center;
        const double z = mesh.period.shortest(from_center)[pulse.axis];
        displacement[a * dim + pulse.component] += pulse_displacement(pulse, z);
        velocity[a * dim + pulse.component] += pulse_velocity(pulse, z);
      }
    }
  }
}

template void add_initial<2>(const Mesh<2>&, const std::vector<InitialSetting<2>>&,
                             std::span<double>, std::span<double>);
template void add_initial<3>(const Mesh<3>&, const std::vector<InitialSetting<3>>&,
                             std::span<double>, std::span<double>);

} // namespace kerf::fem
