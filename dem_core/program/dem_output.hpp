// What kerf-dem writes into the run folder: frames of particles, contacts and tools, histories,
// cracks.
#pragma once

#include "common/history.hpp"
#include "common/results.hpp"
#include "dem_core/engine.hpp"
#include "dem_core/fragments.hpp"
#include "dem_core/program/crack_file.hpp"
#include "dem_core/program/probe_file.hpp"
#include "dem_core/program/set_output.hpp"
#include "dem_core/program/tool_output.hpp"
#include "dem_core/program/watch.hpp"

#include <filesystem>
#include <string>

namespace kerf::dem {

/// Program and version that a checkpoint names.
inline constexpr const char* checkpoint_writer = "kerf-dem " KERF_VERSION;

template <int dim> class DemOutput {
public:
  /// Makes history/<name>.csv, <name>_cracks.csv and <name>_<probe>.csv; frames come with
  /// write_frame(). Goes on with them when the engine does not begin with step 0.
  DemOutput(Engine<dim>& engine, const Watch<dim>& watch, const std::filesystem::path& run_folder,
            const std::string& name);

  /// The state x^n, v^(n-1/2), and the forces of x^n, which are computed for it. Forces and
  /// stiffness of contacts are those without weight.
  /// @throws std::runtime_error when a particle is no longer where a number can say, or outside of
  ///         the domain
  void write_frame(std::uint64_t step, double time);

  /// Energies of t_n, and what the probes read.
  /// @throws std::runtime_error likewise
  void write_history(std::uint64_t step, double time);

  /// The bonds that broke since the last call.
  void write_cracks();

  /// The state between two steps.
  void write_checkpoint(const std::filesystem::path& file);

  /// Of the rows from now on.
  void set_stage(std::size_t stage) { stage_ = stage; }

  double seconds() const noexcept { return seconds_; } // spent here, but for the forces

private:
  void check(std::uint64_t step, double time) const;
  const Fragments& fragments();

  Engine<dim>& engine_;
  FrameWriter frames_;
  History history_;
  CrackFile<dim> cracks_;
  std::vector<ProbeFile<dim>> probes_;
  ToolOutput<dim> tools_;
  SetOutput<dim> sets_;
  std::optional<Box<dim>> domain_;
  std::optional<std::size_t> stage_; // in a run with stages
  Fragments fragments_;
  /// Cracks and bonds made, when they were found.
  std::pair<std::size_t, std::size_t> bonds_of_fragments_{};
  double seconds_ = 0.0;
};

} // namespace kerf::dem
