#include "dem_core/stress.hpp"

namespace kerf::dem {

template <int dim>
std::vector<Symmetric<dim>> particle_stress(const Contacts<dim>& contacts,
                                            const Particles<dim>& particles) {
  std::vector<Symmetric<dim>> stress(particles.size(), Symmetric<dim>::Zero());
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Vec<dim> branch = span_of(contacts, particles, k).branch;
    // Force and arm of the second are both opposite to those of the first.
    const Symmetric<dim> dyad =
        symmetric_part<dim>(branch * contact_force(contacts, particles, k).transpose()); // N m
    stress[contacts.first[k]] += contacts.share[k] * dyad;
    stress[contacts.second[k]] += (1.0 - contacts.share[k]) * dyad;
  }
  for (std::size_t i = 0; i < stress.size(); ++i)
    stress[i] /= volume_of_radius<dim>(particles.radius[i]);
  return stress;
}

template std::vector<Symmetric<2>> particle_stress<2>(const Contacts<2>&, const Particles<2>&);
template std::vector<Symmetric<3>> particle_stress<3>(const Contacts<3>&, const Particles<3>&);

} // namespace kerf::dem
