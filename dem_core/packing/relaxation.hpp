// Moves overlapping particles apart inside a region.
#pragma once

#include "dem_core/packing/region.hpp"

#include <cstddef>
#include <vector>

namespace kerf::dem {

/// Particles at their places.
template <int dim> struct ParticleSet {
  std::vector<Vec<dim>> positions; // [n] m
  std::vector<double> radii;       // [n] m
};

/// Minimises the sum of the squared overlaps with FIRE, the wall being hard: Bitzek et al., Phys.
/// Rev. Lett. 97 (2006) 170201, doi:10.1103/PhysRevLett.97.170201.
///
/// Ends when nothing overlaps; in the jammed state when a hundred steps lower the sum by less than
/// a hundredth; at last after `most_steps`. The particles are sorted by place on the way. The bits
/// do not depend on the number of threads.
///
/// @return steps made
template <int dim>
std::size_t relax(const Region<dim>& region, ParticleSet<dim>& particles, std::size_t most_steps);

} // namespace kerf::dem
