#include "dem_core/crack.hpp"

namespace kerf::dem {

template <int dim>
Crack<dim> crack_of(const Break& lost, const Contacts<dim>& contacts,
                    const Particles<dim>& particles, std::uint64_t step, double time) {
  const std::uint32_t k = lost.contact;
  const Span<dim> span = span_of(contacts, particles, k);
  Crack<dim> crack;
  crack.step = step;
  crack.time = time;
  crack.first = contacts.first[k];
  crack.second = contacts.second[k];
  crack.place = particles.position(crack.first) + contacts.share[k] * span.branch;
  crack.normal = span.normal();
  crack.mode = lost.mode;
  crack.energy = lost.energy;
  crack.strength =
      lost.mode == BreakMode::tension ? contacts.tensile_strength[k] : contacts.shear_strength[k];
  return crack;
}

template Crack<2> crack_of<2>(const Break&, const Contacts<2>&, const Particles<2>&, std::uint64_t,
                              double);
template Crack<3> crack_of<3>(const Break&, const Contacts<3>&, const Particles<3>&, std::uint64_t,
                              double);

} // namespace kerf::dem
