// What a step of elements needs at least, and how fast the machine could be with that.
#pragma once

#include "tests/benchmarks/fem_models.hpp"

namespace kerf::benchmarks {

/// Of one element in one step.
struct ElementWork {
  double operations = 0.0; // double precision; a multiply-add counts as two
  double bytes = 0.0;      // to and from memory when every array is streamed once
};

/// By count, from the formulas of docs/theory/fem.md as one would write them out; divisions, square
/// roots and logarithms count as what a vector processor needs for them, 5, 5 and 25. What is
/// computed or copied more than once, for the sake of speed, is not in it.
/// @param nodes_per_element  of the mesh
ElementWork work_of(const FemWorkload& workload, const std::string& law, double nodes_per_element);

/// The roofline of the machine with the threads that are set, measured now: all operations at the
/// rate of multiply-adds, or all bytes at the bandwidth of a triad over as much memory as the model
/// has, whichever is slower.
/// @return 1e6 element-steps/s
double limit_of(const ElementWork& work, std::size_t elements);

} // namespace kerf::benchmarks
