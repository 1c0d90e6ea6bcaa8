#include "dem_core/gravity.hpp"

#include "common/ordered_sum.hpp"

namespace kerf::dem {

template <int dim>
void add_weight(const Vec<dim>& gravity, const Particles<dim>& particles, ParticleBlock block,
                Loads<dim>& loads) {
  if (gravity.isZero(0.0))
    return;
  for (std::size_t i = block.begin; i < block.end; ++i)
    if (!particles.is_member(i))
      loads.own[i].force += particles.weighed_mass(i) * gravity;
}

template <int dim>
double weight_work(const Vec<dim>& gravity, const Particles<dim>& p, double time_step) {
  if (gravity.isZero(0.0))
    return 0.0;
  return ordered_sum(p.size(), [&](std::size_t i) {
    if (p.is_member(i))
      return 0.0;
    return p.weighed_mass(i) * gravity.dot(p.displacement[i] - time_step * p.velocity[i]);
  });
}

template void add_weight<2>(const Vec<2>&, const Particles<2>&, ParticleBlock, Loads<2>&);
template void add_weight<3>(const Vec<3>&, const Particles<3>&, ParticleBlock, Loads<3>&);
template double weight_work<2>(const Vec<2>&, const Particles<2>&, double);
template double weight_work<3>(const Vec<3>&, const Particles<3>&, double);

} // namespace kerf::dem
