// One step of central differences.
#pragma once

#include "dem_core/boundary.hpp"
#include "dem_core/contact_forces.hpp"
#include "dem_core/particles.hpp"

namespace kerf::dem {

/// Rojek (2008) eqs 3-7: a = F / m, v^(n+1/2) = v^(n-1/2) + a dt, u^(n+1) = u^n + v^(n+1/2) dt, and
/// the same for rotations. The force is the own resultant plus the interface force.
///
/// In the first step the velocities are v^0, and v^(-1/2) = v^0 - a dt / 2 comes first. Prescribed
/// components follow the boundary instead; they move with their first velocity before the start.
/// @return the farthest that a particle of the block has moved, m
template <int dim>
double integrate(Particles<dim>& particles, const Loads<dim>& loads, Boundary<dim>& boundary,
                 ParticleBlock block, double time_step, bool is_first_step);

/// What drives a particle, m/s² and rad/s².
template <int dim> struct Acceleration {
  Vec<dim> translation;
  Rot<dim> rotation;
};
template <int dim>
Acceleration<dim> acceleration(const Particles<dim>& particles, const Loads<dim>& loads,
                               std::size_t i) {
  Vec<dim> force = loads.own[i].force;
  if (!loads.interface_force.empty())
    force += loads.interface_force[i];
  return {force * (1.0 / particles.mass[i]),                   // Rojek (2008) eq. 3
          loads.own[i].moment * (1.0 / particles.inertia[i])}; // eq. 6
}

/// v^(n-1/2) and omega^(n-1/2), as long as the loads are those of the last integrate().
template <int dim> struct HalfStepBefore {
  Vec<dim> velocity;
  Rot<dim> angular_velocity;
};
template <int dim>
HalfStepBefore<dim> half_step_before(const Particles<dim>& particles, const Loads<dim>& loads,
                                     const Boundary<dim>& boundary, double time_step,
                                     std::size_t i) {
  const auto a = acceleration(particles, loads, i);
  HalfStepBefore<dim> before{particles.velocity[i] - time_step * a.translation,
                             particles.angular_velocity[i] - time_step * a.rotation};
  if (const PrescribedMotion<dim>* prescribed = boundary.of(i)) {
    for (int axis = 0; axis < dim; ++axis)
      if (prescribed->prescribes(axis))
        before.velocity[axis] = prescribed->velocity_before[axis];
    if (prescribed->holds_rotation())
      before.angular_velocity = prescribed->angular_velocity_before;
  }
  return before;
}

} // namespace kerf::dem
