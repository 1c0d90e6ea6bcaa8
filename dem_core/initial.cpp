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

/// The mean of the rates half a step before and after t = 0.
template <class Function, class Slope>
double central_rate(const Pulse& pulse, double z, double dt, Function f, Slope f_slope) {
  const double half = 0.5 * pulse.wave_speed * dt; // m
  return 0.5 * (rate(pulse, z - half, f, f_slope) + rate(pulse, z + half, f, f_slope));
}

/// Half the curl of a displacement along `component` that grows by one per metre of `axis`.
template <int dim> Rot<dim> mean_rotation(int axis, int component) {
  const Vec<dim> along = Vec<dim>::Unit(axis), moved = Vec<dim>::Unit(component);
  return 0.5 * moment<dim>(along, moved);
}

/// Calls use(condition, i) for every particle that a condition holds for.
template <int dim, class Use>
void for_each_selected(std::span<const InitialCondition<dim>> conditions,
                       const Particles<dim>& particles, Use use) {
  for (const InitialCondition<dim>& condition : conditions)
    for (std::size_t i = 0; i < particles.size(); ++i)
      if (!condition.box || condition.box->contains(particles.reference[i]))
        use(condition, i);
}

} // namespace

template <int dim>
std::vector<Aligned<Rot<dim>>>
apply_initial_displacements(std::span<const InitialCondition<dim>> conditions,
                            Particles<dim>& particles) {
  std::vector<Aligned<Rot<dim>>> rotation(particles.size());
  for_each_selected<dim>(conditions, particles, [&](const auto& condition, std::size_t i) {
    if (!condition.pulse)
      return;
    const Pulse& pulse = *condition.pulse;
    const double z = particles.reference[i][pulse.axis] - pulse.center;
    particles.displacement[i][pulse.component] += displacement(pulse, z);
    rotation[i] += slope(pulse, z) * mean_rotation<dim>(pulse.axis, pulse.component);
  });
  return rotation;
}

template <int dim>
void apply_initial_velocities(std::span<const InitialCondition<dim>> conditions, double time_step,
                              Particles<dim>& particles) {
  for_each_selected<dim>(conditions, particles, [&](const auto& condition, std::size_t i) {
    particles.velocity[i] += condition.velocity;
    if (!condition.pulse)
      return;
    const Pulse& pulse = *condition.pulse;
    const double z = particles.reference[i][pulse.axis] - pulse.center;
    particles.velocity[i][pulse.component] +=
        central_rate(pulse, z, time_step, displacement, slope);
    particles.angular_velocity[i] += central_rate(pulse, z, time_step, slope, curvature) *
                                     mean_rotation<dim>(pulse.axis, pulse.component);
  });
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template std::vector<Aligned<Rot<dim>>> apply_initial_displacements<dim>(                        \
      std::span<const InitialCondition<dim>>, Particles<dim>&);                                    \
  template void apply_initial_velocities<dim>(std::span<const InitialCondition<dim>>, double,      \
                                              Particles<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
