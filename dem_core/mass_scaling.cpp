// What the engine adds to masses for a larger step.
#include "dem_core/contacts_to_come.hpp"
#include "dem_core/engine.hpp"
#include "dem_core/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kerf::dem {

/// Makes heavier what has a smaller critical step than wished, in proportion: row sums fall as the
/// mass and the inertia grow. Free tools have no part in it.
template <int dim> void Engine<dim>::scale_mass() {
  if (!mass_scaling_)
    return;
  const auto is_bad = [](double value, double least) {
    return !(value >= least) || !std::isfinite(value);
  };
  if (is_bad(mass_scaling_->factor, 1.0) || is_bad(mass_scaling_->critical_step, 0.0))
    throw std::invalid_argument("mass scaling needs a factor from 1 or a positive critical step");
  if (!particles_.weight.empty())
    throw std::invalid_argument("the mass of a coupled body cannot be scaled");
  particles_.true_mass = particles_.mass;
  std::vector<double> of_particles(size(), mass_scaling_->factor);
  std::vector<double> of_clusters(clusters_.size(), mass_scaling_->factor);
  clusters_.scale_mass(std::vector<double>(clusters_.size(), 1.0)); // as they were
  if (const double step = mass_scaling_->critical_step; step > 0.0) {
    const ContactsToCome to_come =
        contacts_to_come(materials_, contacts_, particles_, boundary_, clusters_);
    const double time = std::max(dashpot_time(contacts_, particles_), to_come.dashpot_time);
    const double wished = 1.0 / (0.25 * step * step + 0.5 * time * step) / // see with_dashpots()
                          damping_.stiffening();
    const std::vector<double> walls = wall_sums<dim>(tools_, wall_contacts_, particles_, boundary_);
    const std::vector<double> sums = row_sums(), sums_of_clusters = cluster_sums();
    for (std::size_t i = 0; i < size(); ++i)
      of_particles[i] =
          std::max({1.0, sums[i] / wished,
                    to_come.particles[i] > 0.0 ? (to_come.particles[i] + walls[i]) / wished : 0.0});
    for (std::size_t k = 0; k < of_clusters.size(); ++k)
      of_clusters[k] = std::max(1.0, (sums_of_clusters[k] + to_come.clusters[k]) / wished);
  }
  for (std::size_t i = 0; i < size(); ++i)
    if (!particles_.is_member(i)) {
      particles_.mass[i] *= of_particles[i];
      particles_.inertia[i] *= of_particles[i];
    }
  clusters_.scale_mass(of_clusters);
}

template <int dim> AddedMass Engine<dim>::added_mass() const {
  AddedMass result;
  const auto add = [&](double before, double now, std::size_t particles, std::uint32_t id) {
    result.before += before;
    result.added += now - before;
    result.particles += now > before ? particles : 0;
    if (now > result.largest_factor * before) {
      result.largest_factor = now / before;
      result.largest_id = id;
    }
  };
  for (std::size_t i = 0; i < size(); ++i)
    if (!particles_.is_member(i))
      add(particles_.weighed_mass(i), particles_.mass[i], 1, particles_.ids[i]);
  for (const Cluster<dim>& c : clusters_.all())
    add(c.weighed_mass, c.mass, c.members.size(), particles_.ids[c.members.front()]);
  return result;
}

template void Engine<2>::scale_mass();
template void Engine<3>::scale_mass();
template AddedMass Engine<2>::added_mass() const;
template AddedMass Engine<3>::added_mass() const;

} // namespace kerf::dem
