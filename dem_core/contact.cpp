#include "dem_core/contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace kerf::dem {

namespace {

template <int dim>
std::vector<Pair> pairs_within(const Particles<dim>& particles, double reach,
                               const Period<dim>& period) {
  std::vector<Vec<dim>> position(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    position[i] = particles.position(i);
  return find_pairs<dim>(position, particles.radius, reach, period);
}

/// Appends a pair without bond or history; it is free of stress when the surfaces just touch.
template <int dim>
void add_pair(Contacts<dim>& c, Pair pair, const Particles<dim>& p, const Material& material,
              const Period<dim>& period) {
  const auto [i, j] = pair;
  const Vec<dim> relative = p.displacement[j] - p.displacement[i];
  const Vec<dim> branch = period.shortest(p.reference[j] - p.reference[i] + relative) - relative;
  c.first.push_back(i);
  c.second.push_back(j);
  c.reference_branch.push_back(branch);
  c.reference_length.push_back(branch.norm());
  c.rest_length.push_back(p.radius[i] + p.radius[j]);
  c.share.push_back(p.radius[i] / (p.radius[i] + p.radius[j]));
  c.normal_stiffness.push_back(material.normal_stiffness);
  c.tangential_stiffness.push_back(material.tangential_stiffness);
  c.tensile_strength.push_back(material.tensile_strength);
  c.shear_strength.push_back(material.shear_strength);
  c.bonded.push_back(0);
  c.bonded_at_start.push_back(0);
  c.normal_force.push_back(0.0);
  c.shear_force.push_back(Vec<dim>::Zero());
  c.friction_loss.push_back(0.0);
  c.fracture_loss.push_back(0.0);
}

/// Appends contact k of another list with all its history.
template <int dim> void add_copy(Contacts<dim>& c, const Contacts<dim>& from, std::size_t k) {
  c.first.push_back(from.first[k]);
  c.second.push_back(from.second[k]);
  c.reference_branch.push_back(from.reference_branch[k]);
  c.reference_length.push_back(from.reference_length[k]);
  c.rest_length.push_back(from.rest_length[k]);
  c.share.push_back(from.share[k]);
  c.normal_stiffness.push_back(from.normal_stiffness[k]);
  c.tangential_stiffness.push_back(from.tangential_stiffness[k]);
  c.tensile_strength.push_back(from.tensile_strength[k]);
  c.shear_strength.push_back(from.shear_strength[k]);
  c.bonded.push_back(from.bonded[k]);
  c.bonded_at_start.push_back(from.bonded_at_start[k]);
  c.normal_force.push_back(from.normal_force[k]);
  c.shear_force.push_back(from.shear_force[k]);
  c.friction_loss.push_back(from.friction_loss[k]);
  c.fracture_loss.push_back(from.fracture_loss[k]);
}

/// Fills what follows from the list of pairs.
template <int dim> void complete(Contacts<dim>& c, const Particles<dim>& particles) {
  c.force.assign(c.size(), Vec<dim>::Zero());
  c.couple.assign(c.size(), Rot<dim>::Zero());
  c.offset.assign(particles.size() + 1, 0);
  for (std::size_t k = 0; k < c.size(); ++k) {
    ++c.offset[c.first[k] + 1];
    ++c.offset[c.second[k] + 1];
  }
  for (std::size_t i = 0; i < particles.size(); ++i)
    c.offset[i + 1] += c.offset[i];
  c.incidence.resize(2 * c.size());
  std::vector<std::uint32_t> next(c.offset.begin(), c.offset.end() - 1);
  for (std::uint32_t k = 0; k < c.size(); ++k) {
    c.incidence[next[c.first[k]]++] = 2 * k;
    c.incidence[next[c.second[k]]++] = 2 * k + 1;
  }
  blend(c, particles);
}

} // namespace

template <int dim> std::size_t Contacts<dim>::bonds() const noexcept {
  return static_cast<std::size_t>(std::count(bonded.begin(), bonded.end(), std::uint8_t{1}));
}

template <int dim>
Contacts<dim> make_contacts(const Particles<dim>& particles, const Material& material,
                            double gap_tolerance, double skin, const Period<dim>& period) {
  const double largest = *std::max_element(particles.radius.begin(), particles.radius.end());
  const double reach = std::max(skin, gap_tolerance * 2.0 * largest);
  Contacts<dim> c;
  for (const Pair pair : pairs_within(particles, reach, period)) {
    const auto [i, j] = pair;
    const double contact_distance = particles.radius[i] + particles.radius[j];
    const double distance = period.shortest(particles.reference[j] - particles.reference[i]).norm();
    if (distance == 0.0)
      throw std::invalid_argument(fmt::format("particles {} and {} share a centre", i, j));
    const bool bonded = distance - contact_distance <= gap_tolerance * contact_distance;
    if (!bonded && distance - contact_distance > skin)
      continue;
    add_pair(c, pair, particles, material, period);
    if (bonded) {
      c.bonded.back() = c.bonded_at_start.back() = 1;
      c.rest_length.back() = c.reference_length.back();
    }
  }
  complete(c, particles);
  return c;
}

template <int dim>
void renew_contacts(Contacts<dim>& contacts, const Particles<dim>& particles,
                    const Material& material, double skin, const Period<dim>& period) {
  const std::vector<Pair> pairs = pairs_within(particles, skin, period);
  Contacts<dim> renewed;
  renewed.lost_friction = contacts.lost_friction;
  auto pair = pairs.begin();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Pair old{contacts.first[k], contacts.second[k]};
    for (; pair != pairs.end() && *pair < old; ++pair)
      add_pair(renewed, *pair, particles, material, period);
    const bool is_near = pair != pairs.end() && *pair == old;
    if (is_near)
      ++pair;
    if (is_near || contacts.bonded_at_start[k])
      add_copy(renewed, contacts, k);
    else
      renewed.lost_friction += contacts.friction_loss[k];
  }
  for (; pair != pairs.end(); ++pair)
    add_pair(renewed, *pair, particles, material, period);
  complete(renewed, particles);
  contacts = std::move(renewed);
}

template <int dim> void blend(Contacts<dim>& contacts, const Particles<dim>& particles) {
  contacts.weight.resize(contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const std::uint32_t i = contacts.first[k], j = contacts.second[k];
    const double r_i = particles.radius[i], r_j = particles.radius[j];
    contacts.weight[k] =
        bounded_share((r_j * particles.weight[i] + r_i * particles.weight[j]) / (r_i + r_j));
  }
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template struct Contacts<dim>;                                                                   \
  template Contacts<dim> make_contacts<dim>(const Particles<dim>&, const Material&, double,        \
                                            double, const Period<dim>&);                           \
  template void renew_contacts<dim>(Contacts<dim>&, const Particles<dim>&, const Material&,        \
                                    double, const Period<dim>&);                                   \
  template void blend<dim>(Contacts<dim>&, const Particles<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
