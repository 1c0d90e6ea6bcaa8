// Internal forces of the elements, and their sum at the nodes.
#pragma once

#include "fem_core/elements.hpp"
#include "fem_core/materials.hpp"

#include <span>

namespace kerf::fem {

/// Internal forces of every element at its own nodes, f = sum_q B^T sigma alpha detJ; Rojek (2008)
/// eqs 24 and 44 with small strain.
///
/// @param displacement   [num_nodes][dim] m
/// @param element_force  [elements.size()][element_nodes][dim] receives the forces, N
template <int dim>
void compute_element_forces(const Elements<dim>& elements, const LinearElastic& material,
                            std::span<const double> displacement, std::span<double> element_force);

/// Resultant -F^int of the element forces at every node, N; Rojek (2008) eq. 23. A node adds up its
/// corners in the order of the elements, so the bits do not depend on the number of threads.
///
/// @param node_force  [num_nodes][dim] receives the resultants, N
template <int dim>
void gather_element_forces(const Elements<dim>& elements, std::span<const double> element_force,
                           std::span<double> node_force);

} // namespace kerf::fem
