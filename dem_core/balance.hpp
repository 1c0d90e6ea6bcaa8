// How far a body is from equilibrium.
#pragma once

#include "dem_core/boundary.hpp"
#include "dem_core/clusters.hpp"
#include "dem_core/contact.hpp"
#include "dem_core/contact_forces.hpp"
#include "dem_core/energy.hpp"
#include "dem_core/particles.hpp"

namespace kerf::dem {

/// Mean resultant force on the particles without a prescribed motion, damping left out, over the
/// mean force of the contacts that hold or press; zero without such particles or forces. Both are
/// blended. A body at rest under its loads has a ratio far below one.
template <int dim>
double unbalanced_force(const Contacts<dim>& contacts, const Particles<dim>& particles,
                        const Boundary<dim>& boundary, const Loads<dim>& loads,
                        const Clusters<dim>& clusters);

/// Kinetic over elastic energy; zero where nothing is stored.
inline double kinetic_ratio(const Energies& energies) {
  return energies.elastic > 0.0 ? energies.kinetic / energies.elastic : 0.0;
}

} // namespace kerf::dem
