// Nodes along a line: evenly, or with a geometric ratio.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace kerf::fem {

struct Axis {
  double origin = 0.0;     // m
  double length = 0.0;     // m, > 0
  std::uint32_t count = 1; // of elements
  double grading = 1.0;    // size of the last element over that of the first, > 0
};

/// What an error about an axis names.
struct AxisKeys {
  std::string_view length = "mesh.size", count = "mesh.count", grading = "mesh.grading";
};

/// Positions of the count + 1 nodes; both ends are met exactly. Sizes form a geometric series.
///
/// @param name  what an error calls the axis, for example "x"
/// @throws InputError for what is not positive or finite, or a grading of a single element
std::vector<double> positions_along(const Axis& axis, std::string_view name,
                                    const AxisKeys& keys = {});

/// @param num_corners  elements times nodes of each, as a real number, which cannot overflow
/// @throws InputError("mesh.count") when 32 bits cannot number them
void check_numbering(double num_corners);

} // namespace kerf::fem
