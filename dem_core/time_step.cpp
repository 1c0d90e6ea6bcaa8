#include "dem_core/time_step.hpp"

#include "dem_core/row_block.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::dem {

namespace {

/// Largest eigenvalue of a particle that touches a tool, without anything else, rad²/s².
template <int dim>
double wall_eigenvalue(const WallMaterial& material, const Particles<dim>& p,
                       const Boundary<dim>& boundary, std::size_t i) {
  bool is_held = true;
  for (int a = 0; a < dim; ++a)
    is_held = is_held && boundary.prescribes(i, a);
  const double translation = is_held ? 0.0 : 1.0 / p.mass[i]; // 1/kg
  const double rotation =
      boundary.holds_rotation(i) ? 0.0 : p.radius[i] * p.radius[i] / p.inertia[i]; // 1/kg
  return std::max(material.normal_stiffness * translation,
                  material.tangential_stiffness * (translation + rotation));
}

} // namespace

template <int dim>
double row_sum(const Contacts<dim>& c, const Incidence& incidence, const Particles<dim>& p,
               const Boundary<dim>& boundary, const Clusters<dim>& clusters, std::size_t i) {
  if (p.is_member(i))
    return 0.0;
  RowBlock<dim> block;
  for (std::uint32_t e = incidence.offset[i]; e < incidence.offset[i + 1]; ++e)
    block.add(c, p, clusters, incidence.entry[e] >> 1, (incidence.entry[e] & 1u) != 0);

  const auto sums = block.sums();
  double largest = 0.0;
  for (int a = 0; a < dim; ++a)
    if (!boundary.prescribes(i, a))
      largest = std::max(largest, sums[a] / p.mass[i]);
  if (!boundary.holds_rotation(i)) {
    const double rotary_mass = p.inertia[i] / (p.radius[i] * p.radius[i]); // kg
    for (int a = dim; a < dofs(dim); ++a)
      largest = std::max(largest, sums[a] / rotary_mass);
  }
  return largest;
}

template <int dim> double dashpot_time(const Contacts<dim>& c, const Particles<dim>& p) {
  double longest = 0.0;
  for (std::size_t k = 0; k < c.size(); ++k) {
    const double opening = span_of(c, p, k).opening;
    if (!c.carries(k, opening))
      continue;
    const ContactStiffness spring = stiffness_of(c, k, opening);
    const double stiffens = c.is_hertzian(k) ? std::pow(std::max(0.0, -opening), 0.25) : 1.0;
    if (spring.normal > 0.0)
      longest = std::max(longest, stiffens * c.normal_viscosity[k] / spring.normal);
    if (spring.tangential > 0.0)
      longest = std::max(longest, stiffens * c.tangential_viscosity[k] / spring.tangential);
  }
  return longest;
}

double with_dashpots(double omega2, double time) {
  const double xi = 0.5 * std::sqrt(omega2) * time;
  const double factor = std::sqrt(1.0 + xi * xi) - xi;
  return omega2 / (factor * factor);
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template double dashpot_time<dim>(const Contacts<dim>&, const Particles<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

template <int dim>
std::vector<double> wall_sums(std::span<const Tool<dim>> tools,
                              std::span<const WallContacts<dim>> contacts, const Particles<dim>& p,
                              const Boundary<dim>& boundary) {
  std::vector<double> sums(p.size(), 0.0), to_come(p.size(), 0.0);
  for (std::size_t k = 0; k < tools.size(); ++k) {
    const WallMaterial& material = contacts[k].material();
    const double stiffness = std::max(material.normal_stiffness, material.tangential_stiffness);
    const double of_one = stiffness * tools[k].mobility(tools[k].pose().reference);
    double of_tool = 0.0; // rad²/s²
    std::vector<int> count(p.size(), 0);
    contacts[k].for_each([&](const WallContact<dim>& contact, const FacetContact<dim>& place) {
      of_tool += stiffness * tools[k].mobility(tools[k].pose().to_space(place.point));
      ++count[contact.particle];
    });
    for (std::size_t i = 0; i < p.size(); ++i) {
      const double of_particle = wall_eigenvalue(material, p, boundary, i);
      if (count[i] > 0)
        sums[i] += count[i] * of_particle + of_tool;
      else
        to_come[i] = std::max(to_come[i], of_particle + of_one);
    }
  }
  for (std::size_t i = 0; i < p.size(); ++i)
    sums[i] += to_come[i];
  return sums;
}

template double row_sum<2>(const Contacts<2>&, const Incidence&, const Particles<2>&,
                           const Boundary<2>&, const Clusters<2>&, std::size_t);
template double row_sum<3>(const Contacts<3>&, const Incidence&, const Particles<3>&,
                           const Boundary<3>&, const Clusters<3>&, std::size_t);
template std::vector<double> wall_sums<2>(std::span<const Tool<2>>,
                                          std::span<const WallContacts<2>>, const Particles<2>&,
                                          const Boundary<2>&);
template std::vector<double> wall_sums<3>(std::span<const Tool<3>>,
                                          std::span<const WallContacts<3>>, const Particles<3>&,
                                          const Boundary<3>&);

} // namespace kerf::dem
