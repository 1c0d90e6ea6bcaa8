// Forces that hold particles to their prescribed motion.
#pragma once

#include "dem_core/boundary.hpp"
#include "dem_core/contact_forces.hpp"
#include "dem_core/particles.hpp"
#include "dem_core/running_work.hpp"

#include <cstddef>
#include <vector>

namespace kerf::dem {

/// Of one set of the boundary.
template <int dim> struct Reaction {
  Vec<dim> force = Vec<dim>::Zero();        // on the particles, N
  Rot<dim> moment = Rot<dim>::Zero();       // about the mean of their positions, N m
  Vec<dim> displacement = Vec<dim>::Zero(); // their mean, m
};

template <int dim> class Reactions {
public:
  explicit Reactions(std::size_t sets) : work_(sets) {}

  /// Enters the work of a step, after integrate().
  void book(const Particles<dim>& particles, const Loads<dim>& loads, const Boundary<dim>& boundary,
            double time_step, bool is_first_step);
  /// Goes on with another number of sets.
  void replace_sets(std::size_t sets);
  const RunningWork& work_of(std::size_t set) const { return work_[set]; }
  double work() const; // of all sets until t_n, J

private:
  friend struct StateParts;

  std::vector<RunningWork> work_; // of each set
  double of_former_sets_ = 0.0;   // J
};

/// What holds set `set` at t_n: mass times acceleration less all loads, in the components that the
/// set prescribes. As long as the loads are those of the last integrate().
template <int dim>
Reaction<dim> reaction(const Particles<dim>& particles, const Loads<dim>& loads,
                       const Boundary<dim>& boundary, double time_step, std::size_t set);

} // namespace kerf::dem
