// The results of a finite element participant: frames of the mesh, history of the energies.
#pragma once

#include "common/history.hpp"
#include "common/results.hpp"
#include "fem_core/engine.hpp"
#include "fem_core/program/guard.hpp"
#include "fem_core/program/set_output.hpp"
#include "fem_core/program/watch.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kerf::fem {

/// Program and version that a checkpoint names.
inline constexpr const char* checkpoint_writer = "kerf-fem " KERF_VERSION;

/// What the loop of an engine calls when results are due. A look of the guard comes first: when the
/// body is lost, nothing of that moment is written, but a frame of the last state that was good.
template <int dim> class Output {
public:
  /// Goes on with the files of the run when the engine does not begin with step 0.
  /// @param alpha  [num_nodes] share of the elements in the blended virtual work; empty: one
  Output(const Engine<dim>& engine, Guard<dim> guard, const Watch<dim>& watch,
         std::vector<double> alpha, const std::filesystem::path& run_folder,
         const std::string& participant);

  /// Looks at the state between two steps.
  /// @throws LostBody
  void look();
  /// Looks when it is time to.
  void look_if_due() {
    if (guard_.is_due())
      look();
  }

  /// Writes the state x^n, v^(n-1/2).
  void write_frame(std::uint64_t step, double time);
  /// Writes the energies of t_n and what belongs to them, after integrate().
  void write_history(std::uint64_t step, double time);

  /// Of the rows from now on.
  void set_stage(std::size_t stage) { stage_ = stage; }

  /// The state between two steps.
  void write_checkpoint(const std::filesystem::path& file);

  double seconds() const { return seconds_; } // spent here so far

private:
  void write_state(std::uint64_t step, double time);

  const Engine<dim>& engine_;
  Guard<dim> guard_;
  double time_step_;                 // s
  std::optional<std::size_t> stage_; // in a run with stages
  std::optional<std::uint64_t> last_frame_;
  std::vector<double> alpha_;
  std::vector<std::int64_t> ids_;
  FrameWriter frames_;
  History history_;
  SetOutput<dim> sets_;
  double seconds_ = 0.0;
};

} // namespace kerf::fem
