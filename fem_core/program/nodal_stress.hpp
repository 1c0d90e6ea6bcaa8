// Stress at the nodes, from that of the elements around them.
#pragma once

#include "fem_core/engine.hpp"

#include <span>
#include <string>
#include <vector>

namespace kerf::fem {

struct NodalStress {
  std::string name;
  std::vector<double> values; // [num_nodes][components] Pa
};

/// The mean over the elements around each node, weighted with their volumes at the start; zero at
/// nodes without any. Stress jumps where materials meet: each has a field of its own, which is
/// called stress_at_nodes where there is one material, else stress_at_nodes_0, …
///
/// @param stress  [num_elements][components] Pa
template <int dim>
std::vector<NodalStress> stress_at_nodes(const Engine<dim>& engine, std::span<const double> stress);

} // namespace kerf::fem
