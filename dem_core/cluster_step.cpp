// The critical step of rigid clusters.
#include "dem_core/row_block.hpp"
#include "dem_core/time_step.hpp"

#include <algorithm>

namespace kerf::dem {

namespace {

/// What contacts of the members with tools add at most, N/m over kg; tools that a member does not
/// touch yet are to come.
template <int dim>
std::vector<double> wall_part(const Particles<dim>& p, const Clusters<dim>& clusters,
                              std::span<const Tool<dim>> tools,
                              std::span<const WallContacts<dim>> wall_contacts) {
  std::vector<double> sums(clusters.size(), 0.0), to_come(p.size(), 0.0);
  for (std::size_t t = 0; t < tools.size(); ++t) {
    const WallMaterial& material = wall_contacts[t].material();
    const double stiffness = std::max(material.normal_stiffness, material.tangential_stiffness);
    std::vector<std::uint8_t> touches(p.size(), 0);
    const auto mobility = [&](const Cluster<dim>& c, double arm2, const Vec<dim>& point) { // 1/kg
      return 1.0 / c.mass + arm2 / c.least_inertia + tools[t].mobility(point);
    };
    wall_contacts[t].for_each([&](const WallContact<dim>& contact, const FacetContact<dim>& place) {
      if (const Cluster<dim>* c = clusters.free_one_of(p, contact.particle)) {
        const Vec<dim> point = tools[t].pose().to_space(place.point);
        sums[p.cluster[contact.particle] - 1] +=
            stiffness * mobility(*c, c->extent * c->extent, point);
        touches[contact.particle] = 1;
      }
    });
    for (const Cluster<dim>& c : clusters.all())
      for (std::size_t k = 0; c.is_free && k < c.members.size(); ++k) {
        const std::uint32_t i = c.members[k];
        const double arm = c.arms[k].norm() + p.radius[i];
        if (!touches[i])
          to_come[i] =
              std::max(to_come[i], stiffness * mobility(c, arm * arm, tools[t].pose().reference));
      }
  }
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p.is_member(i))
      sums[p.cluster[i] - 1] += to_come[i];
  return sums;
}

} // namespace

template <int dim>
std::vector<double> cluster_sums(const Contacts<dim>& contacts, const Particles<dim>& p,
                                 const Clusters<dim>& clusters, std::span<const Tool<dim>> tools,
                                 std::span<const WallContacts<dim>> wall_contacts) {
  std::vector<RowBlock<dim>> blocks(clusters.size());
  for (std::size_t k = 0; k < contacts.size(); ++k)
    for (const bool is_second : {false, true}) {
      const std::uint32_t i = is_second ? contacts.second[k] : contacts.first[k];
      if (clusters.free_one_of(p, i) != nullptr)
        blocks[p.cluster[i] - 1].add(contacts, p, clusters, k, is_second);
    }
  std::vector<double> sums = wall_part(p, clusters, tools, wall_contacts);
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const Cluster<dim>& c = clusters.all()[k];
    if (!c.is_free)
      continue;
    const auto rows = blocks[k].sums();
    const double rotary_mass = c.least_inertia / (c.extent * c.extent); // kg
    sums[k] += std::max(rows.template head<dim>().maxCoeff() / c.mass,
                        rows.template tail<rotations<dim>>().maxCoeff() / rotary_mass);
  }
  return sums;
}

template std::vector<double> cluster_sums<2>(const Contacts<2>&, const Particles<2>&,
                                             const Clusters<2>&, std::span<const Tool<2>>,
                                             std::span<const WallContacts<2>>);
template std::vector<double> cluster_sums<3>(const Contacts<3>&, const Particles<3>&,
                                             const Clusters<3>&, std::span<const Tool<3>>,
                                             std::span<const WallContacts<3>>);

} // namespace kerf::dem
