// Initial conditions: where the nodes start and how fast.
#pragma once

#include "fem_core/mesh.hpp"
#include "fem_core/settings.hpp"

#include <span>
#include <vector>

namespace kerf::fem {

/// Adds initial conditions to a body.
///
/// @param displacement  [num_nodes][dim] of the nodes from the reference configuration, m
/// @param velocity      [num_nodes][dim] v^0, m/s
/// @throws InputError for a pulse whose length is not positive or whose spacing is negative
template <int dim>
void add_initial(const Mesh<dim>& mesh, const std::vector<InitialSetting<dim>>& settings,
                 std::span<double> displacement, std::span<double> velocity);

} // namespace kerf::fem
