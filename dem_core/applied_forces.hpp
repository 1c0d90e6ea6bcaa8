// Forces that are applied to particles from outside, and their work.
#pragma once

#include "dem_core/boundary.hpp"
#include "dem_core/contact_forces.hpp"
#include "dem_core/particles.hpp"
#include "dem_core/running_work.hpp"

#include <span>
#include <vector>

namespace kerf::dem {

template <int dim> class AppliedForces {
public:
  /// @throws std::invalid_argument when a box holds no particle
  AppliedForces(std::vector<AppliedForce<dim>> settings, const Particles<dim>& particles);

  std::size_t size() const noexcept { return settings_.size(); }
  std::span<const std::uint32_t> particles(std::size_t k) const { return selected_[k]; }
  /// Sum over the particles at time t, N.
  Vec<dim> total(std::size_t k, double t) const;

  /// The forces of time t; masses that share one are those of now.
  void begin_step(double t, const Particles<dim>& particles);
  /// Adds them to the own resultants of a block.
  void add(ParticleBlock block, Loads<dim>& loads) const;
  /// Enters the work of the step from t, after integrate().
  void book(double t, const Particles<dim>& particles, const Loads<dim>& loads,
            const Boundary<dim>& boundary, double time_step, bool is_first_step);
  const RunningWork& work_of(std::size_t k) const { return work_[k]; }
  double work() const; // of all of them until t_n, J

private:
  friend struct StateParts;

  Vec<dim> value(std::size_t k, double t) const; // of the table, N
  /// Of what the table says, on each particle of set k.
  std::vector<double> shares(std::size_t k, const Particles<dim>& particles) const;

  std::vector<AppliedForce<dim>> settings_;
  std::vector<std::vector<std::uint32_t>> selected_;
  std::vector<RunningWork> work_;
  std::vector<std::vector<Vec<dim>>> now_; // on each particle of every set in this step, N
};

} // namespace kerf::dem
