#include "dem_core/damping.hpp"

namespace kerf::dem {

template <int dim>
void add_damping(const Damping& damping, const Particles<dim>& particles, Loads<dim>& loads) {
  if (damping.translation == 0.0 && damping.rotation == 0.0)
    return;
  loads.damping_force.resize(particles.size());
  loads.damping_moment.resize(particles.size());
  const auto count = static_cast<std::int64_t>(particles.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < count; ++i) {
    loads.damping_force[i] = damping_force(damping.kind, damping.translation, loads.force[i],
                                           particles.velocity[i]); // eq. 18
    loads.damping_moment[i] = damping_force(damping.kind, damping.rotation, loads.moment[i],
                                            particles.angular_velocity[i]); // eq. 19
    loads.force[i] += loads.damping_force[i];
    loads.moment[i] += loads.damping_moment[i];
  }
}

template void add_damping<2>(const Damping&, const Particles<2>&, Loads<2>&);
template void add_damping<3>(const Damping&, const Particles<3>&, Loads<3>&);

} // namespace kerf::dem
