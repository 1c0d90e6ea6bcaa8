// The results of a finite element participant: frames of the mesh, history of the energies.
#pragma once

#include "common/history.hpp"
#include "common/results.hpp"
#include "fem_core/engine.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace kerf::fem {

/// Program and version that a checkpoint names.
inline constexpr const char* checkpoint_writer = "kerf-fem " KERF_VERSION;

/// What the loop of an engine calls when results are due. Both throw std::runtime_error, with a
/// node and the time, when the motion or its energies are no longer finite numbers; nothing of that
/// moment is written then.
template <int dim> class Output {
public:
  /// Goes on with the files of the run when the engine does not begin with step 0.
  /// @param alpha  [num_nodes] share of the elements in the blended virtual work; empty: one
  Output(const Engine<dim>& engine, std::vector<double> alpha,
         const std::filesystem::path& run_folder, const std::string& participant);

  /// Writes the state x^n, v^(n-1/2).
  void write_frame(std::uint64_t step, double time);
  /// Writes the energies of t_n, after integrate().
  void write_history(std::uint64_t step, double time);

  /// The state between two steps.
  void write_checkpoint(const std::filesystem::path& file);

  double seconds() const { return seconds_; } // spent here so far

private:
  void check_finite(std::uint64_t step, double time) const;

  const Engine<dim>& engine_;
  std::vector<double> alpha_;
  std::vector<std::int64_t> ids_;
  FrameWriter frames_;
  History history_;
  double seconds_ = 0.0;
};

} // namespace kerf::fem
