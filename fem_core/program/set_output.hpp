// What kerf-fem writes beside the body: reactions of boundaries, loads, rigid walls, probes.
#pragma once

#include "common/history.hpp"
#include "fem_core/engine.hpp"
#include "fem_core/program/watch.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kerf::fem {

template <int dim> class SetOutput {
public:
  /// Makes history/<participant>_boundary.csv and _loads.csv when there are such sets, and
  /// <participant>_<name>.csv for each wall and probe; or goes on with them when the engine does.
  SetOutput(const Engine<dim>& engine, const Watch<dim>& watch,
            const std::filesystem::path& run_folder, const std::string& participant);

  /// After integrate(): all of t_n but velocities, v^(n+1/2), and the stress of probes, as
  /// Engine::element_state() gives it.
  void write_history(std::uint64_t step, double time);

private:
  void write_boundary(std::uint64_t step, double time, std::span<const double> displacement);
  void write_loads(std::uint64_t step, double time);
  void write_walls(std::uint64_t step, double time);

  const Engine<dim>& engine_;
  Watch<dim> watch_;
  std::optional<History> boundary_, loads_;
  std::vector<History> walls_, probes_;
};

} // namespace kerf::fem
