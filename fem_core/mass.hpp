// Lumped masses of the nodes.
#pragma once

#include "fem_core/elements.hpp"

#include <vector>

namespace kerf::fem {

/// Row sums of an element's mass matrix, m_a = sum_q rho N_a alpha detJ, kg (per metre in 2D); the
/// shape functions add up to one, so these are the row sums of Rojek (2008) eq. 46.
template <int dim>
NodeValues<dim> element_mass(const Elements<dim>& elements, std::size_t element, double density);

/// Masses of the nodes, kg (per metre of thickness in 2D); zero at nodes without elements.
/// @return [num_nodes]
template <int dim> std::vector<double> lumped_mass(const Elements<dim>& elements, double density);

} // namespace kerf::fem
