#include "dem_core/initial.hpp"

#include <cmath>
#include <numbers>

namespace kerf::dem {

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

double displacement(const Pulse& pulse, double z) {
  if (std::abs(z) >= 0.5 * pulse.length)
    return 0.0;
  return 0.5 * pulse.amplitude * (1.0 + std::cos(two_pi * z / pulse.length));
}

double slope(const Pulse& pulse, double z) {
  if (std::abs(z) >= 0.5 * pulse.length)
    return 0.0;
  const double k = two_pi / pulse.length;
  return -0.5 * pulse.amplitude * k * std::sin(k * z);
}

double curvature(const Pulse& pulse, double z) {
  if (std::abs(z) >= 0.5 * pulse.length)
    return 0.0;
  const double k = two_pi / pulse.length;
  return -0.5 * pulse.amplitude * k * k * std::cos(k * z);
}

/// Rate of a travelling quantity f: -c times its slope, over one spacing of the lattice.
template <class Function, class Slope>
double rate(const Pulse& pulse, double z, Function f, Slope f_slope) {
  const double s = pulse.spacing;
  if (s == 0.0)
    return -pulse.wave_speed * f_slope(pulse, z);
  return -pulse.wave_speed * (f(pulse, z + 0.5 * s) - f(pulse, z - 0.5 * s)) / s;
}

/// Half the curl of a displacement along `component` that grows by one per metre of `axis`.
template <int dim> Rot<dim> mean_rotation(int axis, int component) {
  const Vec<dim> along = Vec<dim>::Unit(axis), moved = Vec<dim>::Unit(component);
  return 0.5 * moment<dim>(along, moved);
}

} // namespace

template <int dim>
std::vector<Rot<dim>> apply_initial_conditions(std::span<const InitialCondition<dim>> conditions,
                                               Particles<dim>& particles) {
  std::vector<Rot<dim>> rotation(particles.size(), Rot<dim>::Zero());
  for (const InitialCondition<dim>& condition : conditions)
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Vec<dim>& x = particles.reference[i];
      if (condition.box && !condition.box->contains(x))
        continue;
      particles.velocity[i] += condition.velocity;
      if (!condition.pulse)
        continue;
      const Pulse& pulse = *condition.pulse;
      const double z = x[pulse.axis] - pulse.center;
      particles.displacement[i][pulse.component] += displacement(pulse, z);
      particles.velocity[i][pulse.component] += rate(pulse, z, displacement, slope);
      const Rot<dim> turn = mean_rotation<dim>(pulse.axis, pulse.component);
      rotation[i] += slope(pulse, z) * turn;
      particles.angular_velocity[i] += rate(pulse, z, slope, curvature) * turn;
    }
  return rotation;
}

template std::vector<Rot<2>> apply_initial_conditions<2>(std::span<const InitialCondition<2>>,
                                                         Particles<2>&);
template std::vector<Rot<3>> apply_initial_conditions<3>(std::span<const InitialCondition<3>>,
                                                         Particles<3>&);

} // namespace kerf::dem
