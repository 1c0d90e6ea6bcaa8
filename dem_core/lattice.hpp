// Regular arrangements of equal particles.
#pragma once

#include "common/vec.hpp"

#include <array>
#include <vector>

namespace kerf::dem {

enum class LatticeType {
  chain,      // 2D, 3D: along x
  triangular, // 2D: close-packed rows along x, odd rows shifted by half a spacing
  square,     // 2D
  cubic,      // 3D
  fcc,        // 3D: cubes with an edge of spacing * sqrt(2), four particles each
};

template <int dim> struct Lattice {
  LatticeType type = LatticeType::chain;
  double spacing = 0.0;               // distance of nearest neighbours, m
  Vec<dim> origin = Vec<dim>::Zero(); // of the first particle, m
  std::array<int, dim> count{};       // particles (fcc: cubes) along each axis
};

/// Centres of a lattice, x fastest, then y, then z; the four of a cube one after the other.
/// @throws std::invalid_argument when the type does not exist in this dimension, the spacing is not
///         positive, a count is below one, or a chain counts more than one across x
template <int dim> std::vector<Vec<dim>> lattice_points(const Lattice<dim>& lattice);

} // namespace kerf::dem
