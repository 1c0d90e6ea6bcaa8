// Strain of a group of particles from their displacements.
#pragma once

#include "dem_core/particles.hpp"
#include "dem_core/stress.hpp"

#include <cstdint>
#include <span>

namespace kerf::dem {

/// Gradient H of the displacement field u = a + H (X - mean X) that is closest to a group of
/// particles: sum |u_i - u(X_i)|² is least. X is the reference position.
/// @param group  the particles
/// @return not a number when the group does not span the space
template <int dim>
Matrix<dim> displacement_gradient(const Particles<dim>& particles,
                                  std::span<const std::uint32_t> group);

/// Small strain (H + H^T) / 2 of the displacement since the start. A rigid rotation by an angle has
/// a strain of the order of its square.
template <int dim>
Symmetric<dim> strain(const Particles<dim>& particles, std::span<const std::uint32_t> group) {
  return symmetric_part<dim>(displacement_gradient(particles, group));
}

} // namespace kerf::dem
