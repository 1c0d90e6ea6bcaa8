// Which particles are bonded.
#pragma once

#include "dem_core/neighbours.hpp"

namespace kerf::dem {

/// Pairs with a gap of at most gap_tolerance (r_i + r_j), as the engine bonds them, ascending.
template <int dim>
std::vector<Pair> bonded_pairs(std::span<const Vec<dim>> position, std::span<const double> radius,
                               double gap_tolerance, const Period<dim>& period);

/// The gap tolerance with which 2 * bonds / particles comes nearest to a coordination number. Pairs
/// whose gaps differ by less than 1e-9 (r_i + r_j) are bonded together.
/// @param coordination_number  of all particles, those at the boundary too
/// @throws std::invalid_argument when the particles that touch are more than that already, or there
///         are not enough particles for it
template <int dim>
double gap_tolerance_for(double coordination_number, std::span<const Vec<dim>> position,
                         std::span<const double> radius, const Period<dim>& period);

} // namespace kerf::dem
