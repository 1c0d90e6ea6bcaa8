// Bonds that are made during a run.
#include "dem_core/contact.hpp"
#include "dem_core/contact_constants.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kerf::dem {

namespace {

/// Makes a pressed Hertzian contact linear: it keeps its forces, with another stress-free distance,
/// and forgets how it has rolled.
/// @return the energy that it had stored beyond what it has then, J
template <int dim>
double replace_hertz(Contacts<dim>& c, std::size_t k, const Span<dim>& span,
                     const ContactStiffness& bond) {
  const double F_n = -c.normal_stiffness[k] * std::pow(-span.opening, 1.5); // of now, N
  c.rest_length[k] = span.length - F_n / bond.normal;
  double excess = 0.4 * F_n * span.opening - 0.5 * F_n * F_n / bond.normal;
  const ContactStiffness soft = stiffness_of(c, k, span.opening);
  if (const double F_T2 = c.shear_force[k].squaredNorm(); F_T2 > 0.0) {
    excess += 0.5 * F_T2 / soft.tangential;
    if (bond.tangential > 0.0)
      excess -= 0.5 * F_T2 / bond.tangential;
    else
      c.shear_force.set(k, Rot<dim>::Zero());
  }
  if (soft.bending > 0.0)
    excess += 0.5 * c.moment[k].squaredNorm() / soft.bending;
  c.moment.set(k, Rot<dim>::Zero());
  return c.weight[k] * excess;
}

} // namespace

template <int dim>
std::size_t bond_pairs(Contacts<dim>& contacts, const Particles<dim>& particles,
                       const Materials& materials, double gap_tolerance, double skin,
                       const Period<dim>& period) {
  if (!materials.may_bond())
    throw std::invalid_argument("no materials may be bonded");
  const double largest = *std::max_element(particles.radius.begin(), particles.radius.end());
  const double reach = std::max(skin, gap_tolerance * 2.0 * largest);
  renew_contacts(contacts, particles, materials, reach, period);
  std::size_t count = 0;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const std::uint32_t i = contacts.first[k], j = contacts.second[k];
    const double r_i = particles.radius[i], r_j = particles.radius[j];
    const Mixture& mixture = materials.between(particles, i, j);
    const Span<dim> span = span_of(contacts, particles, k);
    if (contacts.bonded[k] || !mixture.bonds ||
        span.length - (r_i + r_j) > gap_tolerance * (r_i + r_j))
      continue;
    contacts.bonded[k] = 1;
    if (span.opening > 0.0)
      contacts.rest_length[k] = span.length;
    else if (contacts.is_hertzian(k))
      contacts.losses[i / particles_per_block].fracture +=
          replace_hertz(contacts, k, span, bond_springs<dim>(mixture, r_i, r_j));
    ++count;
  }
  renew_contacts(contacts, particles, materials, skin, period); // to their place among the bonds
  return count;
}

template std::size_t bond_pairs<2>(Contacts<2>&, const Particles<2>&, const Materials&, double,
                                   double, const Period<2>&);
template std::size_t bond_pairs<3>(Contacts<3>&, const Particles<3>&, const Materials&, double,
                                   double, const Period<3>&);

} // namespace kerf::dem
