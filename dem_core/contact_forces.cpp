#include "dem_core/contact_forces.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::dem {

namespace {

/// The tangential force carried with the contact, and what the increment adds to it.
template <int dim> struct Shear {
  Vec<dim> carried; // N
  Vec<dim> slip;    // tangential displacement of second minus first, m
};

/// Measures the slip on the branch in the middle of the increment (or at its end) and turns it
/// and the stored force to the branch at the end.
/// @param branch  at the end; b its length
template <int dim>
Shear<dim> follow(const Contacts<dim>& c, std::size_t k, const Increment<dim>& increment,
                  const Vec<dim>& branch, const Vec<dim>& normal, ShearIncrement rule) {
  const std::uint32_t i = c.first[k], j = c.second[k];
  const Vec<dim> moved =
      increment.scale * (increment.translation[j] - increment.translation[i]); // of the branch
  const Vec<dim> old_branch = branch - moved;
  const Vec<dim> n_old = old_branch.normalized();
  const Vec<dim> middle =
      rule == ShearIncrement::midpoint ? Vec<dim>(branch - 0.5 * moved) : branch;
  const double length = middle.norm();
  const Vec<dim> n = middle / length;

  // The arms share the branch, so that a rigid rotation of both particles makes no slip.
  const Rot<dim> turned = increment.scale * (c.share[k] * increment.rotation[i] +
                                             (1.0 - c.share[k]) * increment.rotation[j]);
  Vec<dim> slip = moved - length * spin<dim>(turned, n);
  slip -= slip.dot(n) * n;

  Vec<dim> carried = turn<dim>(c.shear_force[k], n_old, n);
  if constexpr (dim == 3) {
    const Rot<3> mean = 0.5 * increment.scale * (increment.rotation[i] + increment.rotation[j]);
    const double angle = mean.dot(n);
    carried = twist(carried, n, angle);
    if (rule == ShearIncrement::midpoint) // what slips in the middle has half the turn before it
      slip = twist(slip, n, 0.5 * angle);
  }
  if (rule == ShearIncrement::midpoint)
    return {turn<dim>(carried, n, normal), turn<dim>(slip, n, normal)};
  return {carried, slip};
}

/// Work of a force that falls from `trial` to `after` although its spring is not released.
template <class Force>
double loss(const Force& before, const Force& trial, const Force& after, double stiffness) {
  if (stiffness == 0.0)
    return 0.0;
  if constexpr (std::is_same_v<Force, double>)
    return 0.5 * (before + after) * (trial - after) / stiffness;
  else
    return 0.5 * (before + after).dot(trial - after) / stiffness;
}

} // namespace

template <int dim>
void update_contacts(Contacts<dim>& c, const Particles<dim>& particles,
                     const Increment<dim>& increment, ShearIncrement rule, double friction) {
  const auto count = static_cast<std::int64_t>(c.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t entry = 0; entry < count; ++entry) {
    const auto k = static_cast<std::size_t>(entry);
    const std::uint32_t i = c.first[k], j = c.second[k];
    const Vec<dim> relative = particles.displacement[j] - particles.displacement[i];
    const Vec<dim> branch = c.reference_branch[k] + relative;
    const double length = branch.norm();
    const double u_n = opening(c, k, relative, length);   // m, > 0 is a gap opening
    if (!c.carries(k, u_n) && c.normal_force[k] == 0.0) { // open, as it was before
      c.force[k].setZero();
      c.couple[k].setZero();
      continue;
    }

    const Vec<dim> n = branch / length;
    const auto [carried, slip] = follow(c, k, increment, branch, n, rule);
    const double trial_n = c.normal_stiffness[k] * u_n;                  // N; Rojek (2008) eq. 12
    const Vec<dim> trial_T = carried + c.tangential_stiffness[k] * slip; // N; eq. 13

    double F_n = trial_n;
    Vec<dim> F_T = trial_T;
    const bool breaks = c.bonded[k] && (trial_n > c.tensile_strength[k] ||     // eq. 14
                                        trial_T.norm() > c.shear_strength[k]); // eq. 15
    if (breaks)
      c.bonded[k] = 0;
    if (!c.bonded[k]) {
      F_n = std::min(trial_n, 0.0);
      const double limit = friction * std::abs(F_n);
      const double size = trial_T.norm();
      if (size > limit) {
        F_T *= limit / size;
        const double lost = c.weight[k] * loss(carried, trial_T, F_T, c.tangential_stiffness[k]);
        (breaks ? c.fracture_loss[k] : c.friction_loss[k]) += lost;
      }
      if (breaks)
        c.fracture_loss[k] +=
            c.weight[k] * loss(c.normal_force[k], trial_n, F_n, c.normal_stiffness[k]);
    }

    c.normal_force[k] = F_n;
    c.shear_force[k] = F_T;
    c.force[k] = c.weight[k] * (F_n * n + F_T);           // eq. 11
    c.couple[k] = c.weight[k] * moment<dim>(branch, F_T); // F_n has no arm
  }
}

template <int dim> void gather_contacts(const Contacts<dim>& c, Loads<dim>& loads) {
  const auto count = static_cast<std::int64_t>(loads.force.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < count; ++i) {
    Vec<dim> force = Vec<dim>::Zero();
    Rot<dim> couple = Rot<dim>::Zero();
    for (std::uint32_t e = c.offset[i]; e < c.offset[i + 1]; ++e) {
      const std::uint32_t k = c.incidence[e] >> 1;
      if ((c.incidence[e] & 1u) == 0) {
        force += c.force[k];
        couple += c.share[k] * c.couple[k];
      } else {
        force -= c.force[k];
        couple += (1.0 - c.share[k]) * c.couple[k];
      }
    }
    loads.force[i] = force;
    loads.moment[i] = couple;
  }
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template void update_contacts<dim>(Contacts<dim>&, const Particles<dim>&, const Increment<dim>&, \
                                     ShearIncrement, double);                                      \
  template void gather_contacts<dim>(const Contacts<dim>&, Loads<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
