// What a case asks to watch, beside the body itself.
#pragma once

#include "fem_core/program/probe.hpp"

#include <string>
#include <vector>

namespace kerf::fem {

template <int dim> struct Watch {
  std::vector<Probe<dim>> probes;
  std::vector<std::string> walls; // names
  double time_step = 0.0;         // s
  bool has_stages = false;        // then histories say which one it is
};

} // namespace kerf::fem
