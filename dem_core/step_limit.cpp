// The critical step of a whole model.
#include "dem_core/contacts_to_come.hpp"
#include "dem_core/engine.hpp"
#include "dem_core/time_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace kerf::dem {

/// Of every particle, rad²/s².
template <int dim> std::vector<double> Engine<dim>::row_sums() const {
  std::vector<double> sums = wall_sums<dim>(tools_, wall_contacts_, particles_, boundary_);
  const Incidence incident = incidence(contacts_, size());
  const auto count = static_cast<std::int64_t>(size());
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < count; ++i)
    sums[i] += row_sum(contacts_, incident, particles_, boundary_, clusters_, i);
  return sums;
}

/// Of every cluster, rad²/s².
template <int dim> std::vector<double> Engine<dim>::cluster_sums() const {
  return clusters_.size() == 0
             ? std::vector<double>()
             : dem::cluster_sums<dim>(contacts_, particles_, clusters_, tools_, wall_contacts_);
}

template <int dim> StepLimit Engine<dim>::step_limit() const {
  const std::vector<double> sums = row_sums();
  const auto largest = std::max_element(sums.begin(), sums.end());
  const auto i = static_cast<std::size_t>(largest - sums.begin());
  StepLimit limit{*largest, fmt::format("particle {}", particles_.ids[i])};
  const std::vector<double> of_clusters = cluster_sums();
  for (std::size_t k = 0; k < of_clusters.size(); ++k)
    if (of_clusters[k] > limit.omega2)
      limit = {of_clusters[k], fmt::format("cluster {}", k)};
  limit.omega2 =
      with_dashpots(damping_.stiffening() * limit.omega2, dashpot_time(contacts_, particles_));
  return limit;
}

template <int dim> StepLimit Engine<dim>::step_limit_to_come() const {
  const ContactsToCome to_come =
      contacts_to_come(materials_, contacts_, particles_, boundary_, clusters_);
  const std::vector<double> walls = wall_sums<dim>(tools_, wall_contacts_, particles_, boundary_);
  StepLimit limit;
  for (std::size_t i = 0; i < size(); ++i)
    if (to_come.particles[i] > 0.0 && to_come.particles[i] + walls[i] > limit.omega2)
      limit = {to_come.particles[i] + walls[i],
               fmt::format("contacts to come of particle {}", particles_.ids[i])};
  const std::vector<double> of_clusters = cluster_sums();
  for (std::size_t k = 0; k < of_clusters.size(); ++k)
    if (const double sum = to_come.clusters[k] + of_clusters[k];
        to_come.clusters[k] > 0.0 && sum > limit.omega2)
      limit = {sum, fmt::format("contacts to come of cluster {}", k)};
  limit.omega2 = with_dashpots(damping_.stiffening() * limit.omega2, to_come.dashpot_time);
  return limit;
}

template <int dim>
void Engine<dim>::omega2(std::span<const std::uint32_t> points, std::span<double> out) const {
  assert(out.size() == points.size());
  const std::vector<double> sums = row_sums();
  const double time = dashpot_time(contacts_, particles_);
  for (std::size_t k = 0; k < points.size(); ++k)
    out[k] = with_dashpots(damping_.stiffening() * sums[points[k]], time);
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template std::vector<double> Engine<dim>::row_sums() const;                                      \
  template std::vector<double> Engine<dim>::cluster_sums() const;                                  \
  template StepLimit Engine<dim>::step_limit() const;                                              \
  template StepLimit Engine<dim>::step_limit_to_come() const;                                      \
  template void Engine<dim>::omega2(std::span<const std::uint32_t>, std::span<double>) const;
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
