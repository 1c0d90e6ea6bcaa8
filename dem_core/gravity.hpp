// Weight of the particles; clusters have theirs as one body.
#pragma once

#include "dem_core/contact_forces.hpp"
#include "dem_core/particles.hpp"

namespace kerf::dem {

/// Adds m g to the own resultants of a block, with blended masses.
/// @param gravity  m/s²
template <int dim>
void add_weight(const Vec<dim>& gravity, const Particles<dim>& particles, ParticleBlock block,
                Loads<dim>& loads);

/// Work of the weight since the particles left their reference positions, sum of m g . u, J.
/// @param time_step  s; after integrate() of step n it gives the work until t_n, 0 until now
template <int dim>
double weight_work(const Vec<dim>& gravity, const Particles<dim>& particles, double time_step);

} // namespace kerf::dem
