#include "dem_core/damping.hpp"

namespace kerf::dem {

template <int dim>
void add_damping(const Damping& damping, const Particles<dim>& particles, ParticleBlock block,
                 Loads<dim>& loads) {
  if (!damping.is_on())
    return;
  for (std::size_t i = block.begin; i < block.end; ++i) {
    Load<dim>& own = loads.own[i];
    Load<dim>& part = loads.damping[i];
    if (particles.is_member(i)) // damped as one body
      continue;
    part.force = damping_force(damping.kind, damping.translation, own.force,
                               particles.velocity[i]); // eq. 18
    part.moment = damping_force(damping.kind, damping.rotation, own.moment,
                                particles.angular_velocity[i]); // eq. 19
    own.force += part.force;
    own.moment += part.moment;
  }
}

template void add_damping<2>(const Damping&, const Particles<2>&, ParticleBlock, Loads<2>&);
template void add_damping<3>(const Damping&, const Particles<3>&, ParticleBlock, Loads<3>&);

} // namespace kerf::dem
