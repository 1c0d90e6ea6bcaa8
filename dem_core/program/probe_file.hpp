// history/<participant>_<probe>.csv: what a probe reads over time.
#pragma once

#include "common/history.hpp"
#include "dem_core/engine.hpp"
#include "dem_core/probe.hpp"

#include <cstdint>
#include <filesystem>

namespace kerf::dem {

template <int dim> class ProbeFile {
public:
  ProbeFile(const std::filesystem::path& path, const Box<dim>& box, std::uint64_t first_step);

  /// After integrate(): forces of t_n, places of t_(n+1), velocities of half a step between.
  void write(std::uint64_t step, double time, const Engine<dim>& engine);

private:
  Box<dim> box_;
  History file_;
};

} // namespace kerf::dem
