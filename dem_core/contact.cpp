#include "dem_core/contact.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::dem {

namespace {

/// The contact weight between two particles.
template <int dim> double weight_of(const Particles<dim>& p, std::uint32_t i, std::uint32_t j) {
  return bounded_share((p.radius[j] * p.weight[i] + p.radius[i] * p.weight[j]) /
                       (p.radius[i] + p.radius[j]));
}

} // namespace

template <int dim> std::size_t Contacts<dim>::bonds() const noexcept {
  return static_cast<std::size_t>(std::count(bonded.begin(), bonded.end(), std::uint8_t{1}));
}

template <int dim> double Contacts<dim>::memory() const {
  const std::size_t numbers = dim + 3 + (has_moments ? 2 : 1) * rotations<dim>;
  std::size_t constants = 0;
  for (const PerContact* constant :
       {&normal_stiffness, &tangential_stiffness, &tensile_strength, &shear_strength, &friction,
        &weight, &normal_viscosity, &tangential_viscosity, &bending_stiffness, &twisting_stiffness,
        &bond_lever, &rolling_limit})
    constants += constant->each().size();
  return static_cast<double>(size() * (numbers * sizeof(double) + 3 * sizeof(std::uint32_t) + 1) +
                             constants * sizeof(double) +
                             waiting_rows() * 2 * sizeof(std::uint32_t));
}

template <int dim> void blend(Contacts<dim>& contacts, const Particles<dim>& particles) {
  std::vector<double> weight(contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k)
    weight[k] = weight_of(particles, contacts.first[k], contacts.second[k]);
  contacts.weight.set_each(std::move(weight));
}

template <int dim> Incidence incidence(const Contacts<dim>& c, std::size_t particles) {
  Incidence result;
  result.offset.assign(particles + 1, 0);
  for (std::size_t k = 0; k < c.size(); ++k) {
    ++result.offset[c.first[k] + 1];
    ++result.offset[c.second[k] + 1];
  }
  for (std::size_t i = 0; i < particles; ++i)
    result.offset[i + 1] += result.offset[i];
  result.entry.resize(2 * c.size());
  std::vector<std::uint32_t> next(result.offset.begin(), result.offset.end() - 1);
  for (std::uint32_t k = 0; k < c.size(); ++k) {
    result.entry[next[c.first[k]]++] = 2 * k;
    result.entry[next[c.second[k]]++] = 2 * k + 1;
  }
  return result;
}

template <int dim>
ContactStiffness stiffness_of(const Contacts<dim>& c, std::size_t k, double opening) {
  ContactStiffness stiffness{c.normal_stiffness[k], c.tangential_stiffness[k],
                             c.bending_stiffness[k], c.twisting_stiffness[k]};
  if (c.is_hertzian(k)) {
    const double root = std::sqrt(std::max(0.0, -opening));
    stiffness.normal *= 1.5 * root; // of delta^(3/2)
    stiffness.tangential *= root;
    stiffness.bending *= root;
  }
  return stiffness;
}

template <int dim>
Span<dim> span_of(const Contacts<dim>& c, const Particles<dim>& particles, std::size_t k) {
  Span<dim> span;
  const Vec<dim> B = c.reference_branch[k];
  const Vec<dim> relative =
      particles.displacement[c.second[k]] - particles.displacement[c.first[k]];
  span.branch = B + relative;
  span.length = span.branch.norm();
  // |b| - |B| is computed from the displacement, so that it keeps its digits when it is small.
  const double stretch = relative.dot(2.0 * B + relative) / (span.length + B.norm());
  span.opening = stretch + (B.norm() - c.rest_length[k]);
  return span;
}

template <int dim>
Vec<dim> shear_force(const Contacts<dim>& c, const Particles<dim>& particles, std::size_t k) {
  if constexpr (dim == 2)
    return spin<2>(c.shear_force[k], span_of(c, particles, k).normal());
  else
    return c.shear_force[k];
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template struct Contacts<dim>;                                                                   \
  template void blend<dim>(Contacts<dim>&, const Particles<dim>&);                                 \
  template Incidence incidence<dim>(const Contacts<dim>&, std::size_t);                            \
  template ContactStiffness stiffness_of<dim>(const Contacts<dim>&, std::size_t, double);          \
  template Span<dim> span_of<dim>(const Contacts<dim>&, const Particles<dim>&, std::size_t);       \
  template Vec<dim> shear_force<dim>(const Contacts<dim>&, const Particles<dim>&, std::size_t);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
