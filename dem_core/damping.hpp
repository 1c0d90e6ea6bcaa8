// Non-viscous damping: dissipation that asks for no viscosity and no natural frequency.
#pragma once

#include "dem_core/boundary.hpp"
#include "dem_core/contact_forces.hpp"
#include "dem_core/particles.hpp"
#include "dem_core/settings.hpp"

#include <cmath>

namespace kerf::dem {

/// Damping of one resultant by one velocity; works for forces and for moments.
///
/// nonviscous:    -alpha |F| v / |v|, Rojek (2008) eqs 18 and 19; zero at rest, where the equation
///                is 0 / 0.
/// componentwise: -alpha F_k sign(F_k v_k) in each component, as in YADE; compare P.A. Cundall,
///                in: G.N. Pande et al. (eds), Rock Engineering (1987), and
///                V. Šmilauer et al., YADE documentation, doi:10.5281/zenodo.5705394
template <class Vector>
Vector damping_force(DampingKind kind, double alpha, const Vector& force,
                     const std::type_identity_t<Vector>& velocity) {
  if (kind == DampingKind::nonviscous) {
    const double speed = velocity.norm();
    if (speed == 0.0)
      return Vector::Zero();
    return (-alpha * force.norm() / speed) * velocity;
  }
  Vector damping = Vector::Zero();
  for (int k = 0; k < damping.size(); ++k)
    if (force[k] * velocity[k] != 0.0)
      damping[k] = -alpha * force[k] * std::copysign(1.0, force[k] * velocity[k]);
  return damping;
}

/// Adds damping to the own resultants of a block, but for members of clusters, and keeps it beside
/// for the books. The velocity is that of half a step before, v^(n-1/2). Of particles whose motion
/// is given in part only the free components count.
/// @pre loads.damping has room for all particles, unless it is empty and nothing is damped
template <int dim>
void add_damping(const Damping& damping, const Particles<dim>& particles,
                 const Boundary<dim>& boundary, ParticleBlock block, Loads<dim>& loads);

} // namespace kerf::dem
