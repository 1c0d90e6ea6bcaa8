// One step of central differences for every particle.
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
/// Writes velocity_before too.
template <int dim>
void integrate(Particles<dim>& particles, const Loads<dim>& loads, const Boundary<dim>& boundary,
               double time_step, bool is_first_step);

} // namespace kerf::dem
