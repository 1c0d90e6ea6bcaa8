// The particle models that are timed.
#pragma once

#include "dem_core/settings.hpp"

#include <span>
#include <string>

namespace kerf::benchmarks {

struct Workload {
  std::string name;
  int dim = 0;
  bool bonded = false;
  std::size_t particles = 0;
};

std::span<const Workload> dem_workloads();

/// Edge of the cube or square that a workload fills, from the origin, m.
template <int dim> double edge_of(const Workload& workload);

/// A dense random packing, taken from the cache of packings or made and kept there, in spatial
/// order, with waves of a small strain travelling through it.
///
/// Bonded: a block with free faces, 3.1 bonds a particle, in 2D 2.07, few of which break.
/// Otherwise: periodic, compressed so that its contacts carry, without bonds, with Coulomb
/// friction.
template <int dim> dem::Settings<dim> settings_of(const Workload& workload);

/// An fcc lattice, shaken, with the bonds of the bonded workloads; no cheaper way to so many.
dem::Settings<3> shaken_lattice(std::size_t particles);

} // namespace kerf::benchmarks
