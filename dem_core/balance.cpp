#include "dem_core/balance.hpp"

#include "common/ordered_sum.hpp"

#include <cmath>

namespace kerf::dem {

namespace {

struct Mean {
  double sum = 0.0, count = 0.0;

  Mean& operator+=(const Mean& other) {
    sum += other.sum;
    count += other.count;
    return *this;
  }
  double value() const { return count > 0.0 ? sum / count : 0.0; }
};

} // namespace

template <int dim>
double unbalanced_force(const Contacts<dim>& contacts, const Particles<dim>& particles,
                        const Boundary<dim>& boundary, const Loads<dim>& loads,
                        const Clusters<dim>& clusters) {
  Mean resultant = ordered_sum(particles.size(), [&](std::size_t i) {
    if (boundary.of(i) != nullptr)
      return Mean{};
    Vec<dim> force = loads.own[i].force;
    if (!loads.damping.empty())
      force -= loads.damping[i].force;
    if (!loads.interface_force.empty())
      force += loads.interface_force[i];
    return Mean{force.norm(), 1.0};
  });
  for (const Cluster<dim>& cluster : clusters.all())
    if (cluster.is_free)
      resultant += Mean{cluster.load.force.norm(), 1.0};
  const Mean contact = ordered_sum(contacts.size(), [&](std::size_t k) {
    if (!contacts.bonded[k] && contacts.normal_force[k] == 0.0)
      return Mean{};
    return Mean{contacts.weight[k] *
                    std::hypot(contacts.normal_force[k], contacts.shear_force[k].norm()),
                1.0};
  });
  return contact.value() > 0.0 ? resultant.value() / contact.value() : 0.0;
}

template double unbalanced_force<2>(const Contacts<2>&, const Particles<2>&, const Boundary<2>&,
                                    const Loads<2>&, const Clusters<2>&);
template double unbalanced_force<3>(const Contacts<3>&, const Particles<3>&, const Boundary<3>&,
                                    const Loads<3>&, const Clusters<3>&);

} // namespace kerf::dem
