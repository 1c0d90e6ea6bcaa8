#include "dem_core/applied_forces.hpp"

#include "dem_core/integrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kerf::dem {

template <int dim>
AppliedForces<dim>::AppliedForces(std::vector<AppliedForce<dim>> settings,
                                  const Particles<dim>& particles)
    : settings_(std::move(settings)), selected_(settings_.size()), work_(settings_.size()) {
  for (std::size_t k = 0; k < settings_.size(); ++k) {
    for (std::uint32_t i = 0; i < particles.size(); ++i)
      if (settings_[k].box.contains(particles.reference[i]))
        selected_[k].push_back(i);
    if (selected_[k].empty())
      throw std::invalid_argument(fmt::format("the box of load {} holds no particle", k));
  }
}

template <int dim> Vec<dim> AppliedForces<dim>::value(std::size_t k, double t) const {
  Vec<dim> force;
  for (int a = 0; a < dim; ++a)
    force[a] = settings_[k].force[a].value(t);
  return force;
}

template <int dim> Vec<dim> AppliedForces<dim>::total(std::size_t k, double t) const {
  return (settings_[k].is_total ? 1.0 : static_cast<double>(selected_[k].size())) * value(k, t);
}

template <int dim>
std::vector<double> AppliedForces<dim>::shares(std::size_t k,
                                               const Particles<dim>& particles) const {
  std::vector<double> share(selected_[k].size(), 1.0);
  if (!settings_[k].is_total)
    return share;
  double mass = 0.0; // kg
  for (const std::uint32_t i : selected_[k])
    mass += particles.mass[i];
  for (std::size_t entry = 0; entry < share.size(); ++entry)
    share[entry] = particles.mass[selected_[k][entry]] / mass;
  return share;
}

template <int dim> void AppliedForces<dim>::begin_step(double t, const Particles<dim>& particles) {
  now_.resize(size());
  for (std::size_t k = 0; k < size(); ++k) {
    const Vec<dim> force = value(k, t);
    now_[k].clear();
    for (const double share : shares(k, particles))
      now_[k].push_back(share * force);
  }
}

template <int dim> void AppliedForces<dim>::add(ParticleBlock block, Loads<dim>& loads) const {
  for (std::size_t k = 0; k < size(); ++k) {
    const std::vector<std::uint32_t>& selected = selected_[k];
    auto at = std::lower_bound(selected.begin(), selected.end(), block.begin);
    for (; at != selected.end() && *at < block.end; ++at)
      loads.own[*at].force += now_[k][static_cast<std::size_t>(at - selected.begin())];
  }
}

template <int dim>
void AppliedForces<dim>::book(double t, const Particles<dim>& particles, const Loads<dim>& loads,
                              const Boundary<dim>& boundary, double time_step, bool is_first_step) {
  for (std::size_t k = 0; k < size(); ++k) {
    const Vec<dim> force = value(k, t);
    const std::vector<double> share = shares(k, particles);
    Vec<dim> before = Vec<dim>::Zero(), after = Vec<dim>::Zero(); // shared velocities, m/s
    for (std::size_t entry = 0; entry < share.size(); ++entry) {
      const std::uint32_t i = selected_[k][entry];
      before += share[entry] * half_step_before(particles, loads, boundary, time_step, i).velocity;
      after += share[entry] * particles.velocity[i];
    }
    work_[k].add(force.dot(before), force.dot(after), time_step, is_first_step);
  }
}

template <int dim> double AppliedForces<dim>::work() const {
  double sum = 0.0;
  for (const RunningWork& work : work_)
    sum += work.work();
  return sum;
}

template class AppliedForces<2>;
template class AppliedForces<3>;

} // namespace kerf::dem
