#include "dem_core/reactions.hpp"

#include "common/ordered_sum.hpp"
#include "dem_core/integrate.hpp"

namespace kerf::dem {

namespace {

/// Force and moment that hold one particle.
template <int dim> struct Hold {
  Vec<dim> force;  // N
  Rot<dim> moment; // N m
  HalfStepBefore<dim> before;
};

template <int dim>
Hold<dim> hold(const Particles<dim>& p, const Loads<dim>& loads, const Boundary<dim>& boundary,
               double time_step, std::uint32_t i, unsigned components) {
  Hold<dim> hold{.force = Vec<dim>::Zero(),
                 .moment = Rot<dim>::Zero(),
                 .before = half_step_before(p, loads, boundary, time_step, i)};
  const auto loaded = acceleration(p, loads, i);
  for (int a = 0; a < dim; ++a)
    if ((components >> a & 1u) != 0)
      hold.force[a] = p.mass[i] * ((p.velocity[i][a] - hold.before.velocity[a]) / time_step -
                                   loaded.translation[a]);
  if ((components >> dim & 1u) != 0)
    hold.moment =
        p.inertia[i] *
        ((p.angular_velocity[i] - hold.before.angular_velocity) / time_step - loaded.rotation);
  return hold;
}

/// Power before and after t_n, W.
struct Powers {
  double before = 0.0, after = 0.0;

  Powers& operator+=(const Powers& other) {
    before += other.before;
    after += other.after;
    return *this;
  }
};

template <int dim> struct Sum {
  Reaction<dim> reaction;

  Sum& operator+=(const Sum& other) {
    reaction.force += other.reaction.force;
    reaction.moment += other.reaction.moment;
    reaction.displacement += other.reaction.displacement;
    return *this;
  }
};

} // namespace

template <int dim>
void Reactions<dim>::book(const Particles<dim>& p, const Loads<dim>& loads,
                          const Boundary<dim>& boundary, double time_step, bool is_first_step) {
  for (std::size_t k = 0; k < work_.size(); ++k) {
    const PrescribedSet& set = boundary.sets()[k];
    const Powers powers = ordered_sum(set.particles.size(), [&](std::size_t entry) {
      const std::uint32_t i = set.particles[entry];
      const auto h = hold(p, loads, boundary, time_step, i, set.components[entry]);
      return Powers{h.force.dot(h.before.velocity) + h.moment.dot(h.before.angular_velocity),
                    h.force.dot(p.velocity[i]) + h.moment.dot(p.angular_velocity[i])};
    });
    work_[k].add(powers.before, powers.after, time_step, is_first_step);
  }
}

template <int dim> void Reactions<dim>::replace_sets(std::size_t sets) {
  for (const RunningWork& work : work_)
    of_former_sets_ += work.ahead();
  work_.assign(sets, RunningWork());
}

template <int dim> double Reactions<dim>::work() const {
  double sum = of_former_sets_;
  for (const RunningWork& work : work_)
    sum += work.work();
  return sum;
}

template <int dim>
Reaction<dim> reaction(const Particles<dim>& p, const Loads<dim>& loads,
                       const Boundary<dim>& boundary, double time_step, std::size_t k) {
  const PrescribedSet& set = boundary.sets()[k];
  const std::size_t count = set.particles.size();
  if (count == 0)
    return {};
  const auto position = [&](std::uint32_t i) -> Vec<dim> { // x^n
    return p.position(i) - time_step * p.velocity[i];
  };
  Vec<dim> middle = Vec<dim>::Zero();
  for (const std::uint32_t i : set.particles)
    middle += position(i) / static_cast<double>(count);
  return ordered_sum(count,
                     [&](std::size_t entry) {
                       const std::uint32_t i = set.particles[entry];
                       const auto h = hold(p, loads, boundary, time_step, i, set.components[entry]);
                       Sum<dim> one;
                       one.reaction.force = h.force;
                       one.reaction.moment = h.moment + moment<dim>(position(i) - middle, h.force);
                       one.reaction.displacement = (p.displacement[i] - time_step * p.velocity[i]) /
                                                   static_cast<double>(count);
                       return one;
                     })
      .reaction;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template class Reactions<dim>;                                                                   \
  template Reaction<dim> reaction<dim>(const Particles<dim>&, const Loads<dim>&,                   \
                                       const Boundary<dim>&, double, std::size_t);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
