#include "dem_core/energy.hpp"

#include "common/ordered_sum.hpp"
#include "dem_core/integrate.hpp"

#include <cmath>

namespace kerf::dem {

namespace {

/// A sum term that starts at zero, which an Eigen vector does not.
template <int dim> struct Total {
  Vec<dim> value = Vec<dim>::Zero();
  Total& operator+=(const Total& other) {
    value += other.value;
    return *this;
  }
};

double half_square_over(double square, double stiffness) {
  return stiffness > 0.0 ? 0.5 * square / stiffness : 0.0;
}

/// Of bending and, in 3D, twisting.
template <int dim>
double energy_of_moment(const Contacts<dim>& c, const Particles<dim>& particles, std::size_t k,
                        const ContactStiffness& stiffness) {
  const Rot<dim> moment = c.moment[k];
  double twist = 0.0; // N m
  if constexpr (dim == 3)
    twist = moment.dot(span_of(c, particles, k).normal());
  return half_square_over(moment.squaredNorm() - twist * twist, stiffness.bending) +
         half_square_over(twist * twist, stiffness.twisting);
}

/// Half of the work of a force over the whole step, on each side of t_n.
template <class Vector>
void add_halves(StepWork& work, double Work::*book, const Vector& force, const Vector& before,
                const std::type_identity_t<Vector>& after, double time_step) {
  work.before.*book += 0.5 * time_step * force.dot(before);
  work.after.*book += 0.5 * time_step * force.dot(after);
}

} // namespace

template <int dim>
double kinetic_energy(const Particles<dim>& p, const Loads<dim>& loads,
                      const Boundary<dim>& boundary, double time_step) {
  return ordered_sum(p.size(), [&](std::size_t i) {
    if (p.is_member(i))
      return 0.0;
    const auto before = half_step_before(p, loads, boundary, time_step, i);
    return 0.5 * p.mass[i] * before.velocity.dot(p.velocity[i]) +
           0.5 * p.inertia[i] * before.angular_velocity.dot(p.angular_velocity[i]);
  });
}

template <int dim> double elastic_energy(const Contacts<dim>& c, const Particles<dim>& particles) {
  return ordered_sum(c.size(), [&](std::size_t k) {
    const double F_n = std::abs(c.normal_force[k]), F_T2 = c.shear_force[k].squaredNorm();
    double energy = 0.0, opening = 0.0;
    if (c.is_hertzian(k)) { // F_n = k_n delta^(3/2) has the energy 2/5 F_n delta
      opening = -std::pow(F_n / c.normal_stiffness[k], 2.0 / 3.0);
      energy = -0.4 * F_n * opening;
    } else {
      energy = half_square_over(F_n * F_n, c.normal_stiffness[k]);
    }
    const ContactStiffness stiffness = stiffness_of(c, k, opening);
    energy += half_square_over(F_T2, stiffness.tangential);
    if (c.has_moments)
      energy += energy_of_moment(c, particles, k, stiffness);
    return c.weight[k] * energy;
  });
}

template <int dim>
Vec<dim> momentum(const Particles<dim>& p, const Loads<dim>& loads, const Boundary<dim>& boundary,
                  double time_step) {
  return ordered_sum(p.size(),
                     [&](std::size_t i) {
                       if (p.is_member(i))
                         return Total<dim>{};
                       const auto before = half_step_before(p, loads, boundary, time_step, i);
                       return Total<dim>{0.5 * p.mass[i] * (before.velocity + p.velocity[i])};
                     })
      .value;
}

template <int dim>
StepWork step_work(const Particles<dim>& p, const Loads<dim>& loads, const Boundary<dim>& boundary,
                   std::span<const std::uint32_t> touched, double time_step) {
  const auto before = [&](std::size_t i) {
    return half_step_before(p, loads, boundary, time_step, i);
  };
  StepWork work = ordered_sum(touched.size(), [&](std::size_t entry) {
    const std::uint32_t i = touched[entry];
    StepWork one;
    add_halves(one, &Work::interface, loads.interface_force[i], before(i).velocity, p.velocity[i],
               time_step);
    return one;
  });
  work += ordered_sum(loads.damping.size(), [&](std::size_t i) {
    const auto half = before(i);
    StepWork one;
    add_halves(one, &Work::damping, loads.damping[i].force, half.velocity, p.velocity[i],
               time_step);
    add_halves(one, &Work::damping, loads.damping[i].moment, half.angular_velocity,
               p.angular_velocity[i], time_step);
    return one;
  });
  return work;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template double kinetic_energy<dim>(const Particles<dim>&, const Loads<dim>&,                    \
                                      const Boundary<dim>&, double);                               \
  template double elastic_energy<dim>(const Contacts<dim>&, const Particles<dim>&);                \
  template Vec<dim> momentum<dim>(const Particles<dim>&, const Loads<dim>&, const Boundary<dim>&,  \
                                  double);                                                         \
  template StepWork step_work<dim>(const Particles<dim>&, const Loads<dim>&, const Boundary<dim>&, \
                                   std::span<const std::uint32_t>, double);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
