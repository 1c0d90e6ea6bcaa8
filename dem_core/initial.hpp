// The state of the particles at time zero.
#pragma once

#include "dem_core/particles.hpp"
#include "dem_core/settings.hpp"

#include <span>
#include <vector>

namespace kerf::dem {

/// Displaces the particles by the pulses, which add up. A transverse pulse also turns them with the
/// continuum, by half the curl of the displacement.
///
/// @return [n] rotation that each particle has made from its reference, rad
template <int dim>
std::vector<Aligned<Rot<dim>>>
apply_initial_displacements(std::span<const InitialCondition<dim>> conditions,
                            Particles<dim>& particles);

/// Adds the initial velocities v^0 and angular velocities.
///
/// A pulse travels one way: its velocities are -c (u(z + s/2) - u(z - s/2)) / s, which is exact in
/// a chain of spacing s, as the mean of their values at t = -dt/2 and dt/2. The value at t = 0
/// itself would send a share of (omega dt)^4 / 256 of the energy the other way.
template <int dim>
void apply_initial_velocities(std::span<const InitialCondition<dim>> conditions, double time_step,
                              Particles<dim>& particles);

} // namespace kerf::dem
