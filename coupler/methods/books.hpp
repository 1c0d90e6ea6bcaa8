// What a coupling exchanged: momentum, work and constraint violation, from positions and forces.
#pragma once

#include "common/vec.hpp"

#include <span>

namespace kerf::coupler {

/// Sum and size of the forces and moments (about the origin) on some points.
template <int dim> struct Resultant {
  Vec<dim> force = Vec<dim>::Zero();  // N
  Rot<dim> moment = Rot<dim>::Zero(); // N m
  double force_size = 0.0;            // sum of the components' magnitudes, N
  double moment_size = 0.0;           // the same of |x| |f|, N m
};

/// @param position  [n][dim] m
/// @param force     [n][dim] N
template <int dim>
Resultant<dim> resultant(std::span<const double> position, std::span<const double> force);

/// Power of the forces, W; also the work of a step for a displacement in place of the velocity.
double power(std::span<const double> force, std::span<const double> velocity);

/// Largest magnitude of the constraint, m. @param chi [n][dim]
template <int dim> double largest_violation(std::span<const double> chi);

/// Energy stored in the penalty springs, J: the sum of k chi² / 2. @param stiffness [n] N/m
template <int dim>
double penalty_energy(std::span<const double> chi, std::span<const double> stiffness);

} // namespace kerf::coupler
