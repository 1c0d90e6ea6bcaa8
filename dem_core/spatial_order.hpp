// An order of the particles in which neighbours in space are neighbours in memory.
#pragma once

#include "common/vec.hpp"
#include "dem_core/settings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::dem {

/// Particles along a Morton curve through cells of the size of one particle. Blocks of particles in
/// this order are compact, which is what makes steps fast; an engine takes any order.
/// Particles without a finite position come last.
/// @return [n] which particle comes where
/// @see G.M. Morton, IBM technical report (1966)
template <int dim> std::vector<std::uint32_t> spatial_order(std::span<const Vec<dim>> positions);

/// Arranges the particles of a model in their spatial order. Each keeps its id.
template <int dim> void put_in_spatial_order(Settings<dim>& settings);

} // namespace kerf::dem
