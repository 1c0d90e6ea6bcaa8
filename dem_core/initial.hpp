// The state of the particles at time zero.
#pragma once

#include "dem_core/particles.hpp"
#include "dem_core/settings.hpp"

#include <span>
#include <vector>

namespace kerf::dem {

/// Sets displacements, velocities and angular velocities; the conditions add up.
///
/// A pulse travels one way: its velocities are -c (u(z + s/2) - u(z - s/2)) / s, which is exact for
/// long waves in a chain of spacing s. A transverse pulse also turns the particles with the
/// continuum, by half the curl of the displacement.
///
/// @return [n] rotation that each particle has made from its reference, rad
template <int dim>
std::vector<Rot<dim>> apply_initial_conditions(std::span<const InitialCondition<dim>> conditions,
                                               Particles<dim>& particles);

} // namespace kerf::dem
