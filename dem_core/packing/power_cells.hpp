// The part of space that belongs to each particle of a packing.
#pragma once

#include "common/vec.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::dem {

/// Cells of the power diagram: the points whose tangent to the particle is shorter than to any
/// other. The boundary of two particles that touch passes through the point of contact.
struct PowerCells {
  std::vector<double> volume;          // [n] of closed cells, m³, in 2D m²
  std::vector<std::uint8_t> is_closed; // [n] false at the outside, where a cell goes on for ever
};

/// A cell counts as closed when no corner has a tangent longer than 1.5 of the largest radius; the
/// corners of dense packings and of all lattices of touching particles have shorter ones.
/// @param position  [n] m
/// @param radius    [n] m
template <int dim>
PowerCells power_cells(std::span<const Vec<dim>> position, std::span<const double> radius);

} // namespace kerf::dem
