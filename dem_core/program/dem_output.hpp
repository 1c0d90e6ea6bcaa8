// What kerf-dem writes into the run folder: frames of particles, contacts and tools, and histories.
#pragma once

#include "common/history.hpp"
#include "common/results.hpp"
#include "dem_core/engine.hpp"
#include "dem_core/program/tool_output.hpp"

#include <filesystem>
#include <string>

namespace kerf::dem {

template <int dim> class DemOutput {
public:
  /// Makes history/<name>.csv; frames come with write_frame().
  DemOutput(Engine<dim>& engine, const std::filesystem::path& run_folder, const std::string& name);

  /// The state x^n, v^(n-1/2), and the forces of x^n, which are computed for it. Forces and
  /// stiffness of contacts are those without weight.
  void write_frame(std::uint64_t step, double time);

  /// Energies of t_n.
  /// @throws std::runtime_error when a particle is no longer where a number can say
  void write_history(std::uint64_t step, double time);

  double seconds() const noexcept { return seconds_; } // spent here, but for the forces

private:
  Engine<dim>& engine_;
  FrameWriter frames_;
  History history_;
  ToolOutput<dim> tools_;
  double seconds_ = 0.0;
};

} // namespace kerf::dem
