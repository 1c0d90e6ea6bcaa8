// An order of points in which neighbours in space are neighbours in memory.
#pragma once

#include "common/vec.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf {

/// Points along a Morton curve through cells that hold about one of them. Blocks of particles or
/// elements in this order are compact, which is what makes steps fast; an engine takes any order.
/// Points without a finite position come last.
/// @return [n] which point comes where
/// @see G.M. Morton, IBM technical report (1966)
template <int dim> std::vector<std::uint32_t> spatial_order(std::span<const Vec<dim>> positions);

} // namespace kerf
