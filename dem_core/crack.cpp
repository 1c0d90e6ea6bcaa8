#include "dem_core/crack.hpp"

namespace kerf::dem {

template <int dim>
Crack<dim> crack_of(const Break<dim>& lost, const Contacts<dim>& contacts, std::uint64_t step,
                    double time) {
  const std::uint32_t k = lost.contact;
  Crack<dim> crack;
  crack.step = step;
  crack.time = time;
  crack.first = contacts.first[k];
  crack.second = contacts.second[k];
  crack.place = lost.place;
  crack.normal = lost.normal;
  crack.mode = lost.mode;
  crack.energy = lost.energy;
  crack.strength =
      lost.mode == BreakMode::tension ? contacts.tensile_strength[k] : contacts.shear_strength[k];
  return crack;
}

template Crack<2> crack_of<2>(const Break<2>&, const Contacts<2>&, std::uint64_t, double);
template Crack<3> crack_of<3>(const Break<3>&, const Contacts<3>&, std::uint64_t, double);

} // namespace kerf::dem
