// What a case asks to watch, beside the particles themselves.
#pragma once

#include "dem_core/probe.hpp"

#include <optional>
#include <vector>

namespace kerf::dem {

template <int dim> struct Watch {
  std::vector<Probe<dim>> probes;
  std::optional<Box<dim>> domain; // that no particle may leave
  bool has_stages = false;        // then histories say which one it is
};

} // namespace kerf::dem
