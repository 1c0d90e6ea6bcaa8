#include "dem_core/probe.hpp"

#include "common/ordered_sum.hpp"
#include "dem_core/gauge.hpp"

#include <vector>

namespace kerf::dem {

namespace {

/// What the contacts give to a box.
template <int dim> struct ContactSum {
  Symmetric<dim> dyad = Symmetric<dim>::Zero(); // of branch and force, N m
  double ends = 0.0; // of contacts that hold or press, at particles in the box

  ContactSum& operator+=(const ContactSum& other) {
    dyad += other.dyad;
    ends += other.ends;
    return *this;
  }
};

/// @param is_inside  [n] for each particle
template <int dim>
ContactSum<dim> sum_contacts(const Box<dim>& box, const Period<dim>& period,
                             const Contacts<dim>& contacts, const Particles<dim>& particles,
                             const std::vector<std::uint8_t>& is_inside) {
  return ordered_sum(contacts.size(), [&](std::size_t k) {
    ContactSum<dim> one;
    if (!contacts.bonded[k] && contacts.normal_force[k] == 0.0)
      return one;
    const std::uint32_t i = contacts.first[k], j = contacts.second[k];
    one.ends = is_inside[i] + is_inside[j];
    const Vec<dim> branch =
        contacts.reference_branch[k] + particles.displacement[j] - particles.displacement[i];
    if (contains<dim>(box, period, particles.position(i) + contacts.share[k] * branch))
      one.dyad = symmetric_part<dim>(branch * contact_force(contacts, particles, k).transpose());
    return one;
  });
}

} // namespace

template <int dim>
Reading<dim> read_probe(const Box<dim>& box, const Period<dim>& period,
                        const Contacts<dim>& contacts, const Particles<dim>& particles) {
  std::vector<std::uint32_t> inside;
  std::vector<std::uint8_t> is_inside(particles.size(), 0);
  double solid = 0.0;               // m³
  Vec<dim> flow = Vec<dim>::Zero(); // sum of volume times velocity, m³ m/s
  for (std::uint32_t i = 0; i < particles.size(); ++i)
    if (contains(box, period, particles.position(i))) {
      const double volume = volume_of_radius<dim>(particles.radius[i]);
      inside.push_back(i);
      is_inside[i] = 1;
      solid += volume;
      flow += volume * particles.velocity[i];
    }
  const ContactSum<dim> sum = sum_contacts(box, period, contacts, particles, is_inside);
  const double volume = (box.upper - box.lower).prod(); // m³

  Reading<dim> reading;
  reading.particles = inside.size();
  reading.stress = sum.dyad / volume;
  reading.strain = strain<dim>(particles, inside);
  reading.velocity = flow / solid;
  reading.coordination_number = sum.ends / static_cast<double>(inside.size());
  reading.solid_fraction = solid / volume;
  return reading;
}

template Reading<2> read_probe<2>(const Box<2>&, const Period<2>&, const Contacts<2>&,
                                  const Particles<2>&);
template Reading<3> read_probe<3>(const Box<3>&, const Period<3>&, const Contacts<3>&,
                                  const Particles<3>&);

} // namespace kerf::dem
