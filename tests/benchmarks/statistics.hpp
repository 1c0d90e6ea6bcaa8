// The middle of a few measurements.
#pragma once

#include <algorithm>
#include <vector>

namespace kerf::benchmarks {

/// The upper one of two in the middle. @pre there is a value
inline double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

} // namespace kerf::benchmarks
