#include "dem_core/damping.hpp"

namespace kerf::dem {

template <int dim>
void add_damping(const Damping& damping, const Particles<dim>& particles,
                 const Boundary<dim>& boundary, ParticleBlock block, Loads<dim>& loads) {
  if (!damping.is_on())
    return;
  for (std::size_t i = block.begin; i < block.end; ++i) {
    Load<dim>& own = loads.own[i];
    Load<dim>& part = loads.damping[i];
    if (particles.is_member(i)) // damped as one body
      continue;
    Load<dim> free = own;
    Vec<dim> velocity = particles.velocity[i];
    if (const PrescribedMotion<dim>* given = boundary.of(i)) {
      for (int axis = 0; axis < dim; ++axis)
        if (given->prescribes(axis))
          free.force[axis] = velocity[axis] = 0.0;
      if (given->holds_rotation())
        free.moment.setZero();
    }
    part.force = damping_force(damping.kind, damping.translation, free.force, velocity); // eq. 18
    part.moment = damping_force(damping.kind, damping.rotation, free.moment,
                                particles.angular_velocity[i]); // eq. 19
    own.force += part.force;
    own.moment += part.moment;
  }
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template void add_damping<dim>(const Damping&, const Particles<dim>&, const Boundary<dim>&,      \
                                 ParticleBlock, Loads<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
