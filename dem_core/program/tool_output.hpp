// What kerf-dem writes of rigid tools: a history of each, and their surfaces in the frames.
#pragma once

#include "common/history.hpp"
#include "common/results.hpp"
#include "dem_core/engine.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace kerf::dem {

template <int dim> class ToolOutput {
public:
  /// Makes history/<participant>_<tool>.csv for each tool, or goes on with it when the engine does.
  ToolOutput(const Engine<dim>& engine, const std::filesystem::path& run_folder,
             const std::string& participant);

  /// Adds a grid for the surface of every tool that has one, at its pose of now.
  /// They look at numbers that are kept here until the next call.
  void add_grids(std::vector<Grid>& grids);

  /// Position, force, moment, power and work of t_n; the velocity after it, v^(n+1/2).
  void write_history(std::uint64_t step, double time);

private:
  /// What a grid looks at.
  struct Face {
    std::string name;
    std::vector<Vec<dim>> position;          // m
    std::vector<std::uint32_t> connectivity; //
  };

  const Engine<dim>& engine_;
  std::vector<History> histories_;
  std::vector<Face> faces_;
};

} // namespace kerf::dem
