// What may change between two steps while the state goes on.
#pragma once

#include "fem_core/settings.hpp"

#include <optional>
#include <string>
#include <vector>

namespace kerf::fem {

/// Nothing: it stays. Tables of the boundaries and of the loads that a change brings count their
/// times from it.
template <int dim> struct Change {
  std::optional<Vec<dim>> gravity{}; // m/s²
  std::optional<double> mass_damping{}, local_damping{};
  std::optional<bool> kinetic_damping{};
  std::optional<std::vector<BoundarySetting<dim>>> boundary{}; // in place of all there were
  std::optional<std::vector<LoadSetting<dim>>> loads{};        // likewise
  std::vector<std::string> remove{}; // regions whose elements are taken out
  bool reset_displacement = false;   // results count displacements from here
};

} // namespace kerf::fem
