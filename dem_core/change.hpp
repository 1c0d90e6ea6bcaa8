// What may change between two steps while the state goes on.
#pragma once

#include "dem_core/settings.hpp"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace kerf::dem {

/// Nothing: it stays. Tables of boundaries and tools count their times from the change.
template <int dim> struct Change {
  std::optional<Damping> damping;
  std::optional<Vec<dim>> gravity; // m/s²
  std::optional<double> friction;  // of contacts without a bond
  /// Bonds all pairs with a gap of at most this times r_i + r_j. Who touches keeps its force and
  /// its stress-free distance; across a gap a bond is free of stress where it is.
  std::optional<double> bond_gap;
  std::optional<std::vector<Prescription<dim>>> boundary; // in place of all there were
  /// Motions of tools by index. Pose, and the velocity along free axes, go on from what they are.
  std::vector<std::pair<std::size_t, ToolMotion<dim>>> tools;
};

} // namespace kerf::dem
