// Other codes on the same packing: YADE, LAMMPS, LIGGGHTS.
#pragma once

#include "dem_core/engine.hpp"
#include "tests/benchmarks/commands.hpp"
#include "tests/benchmarks/dem_models.hpp"

#include <string>
#include <vector>

namespace kerf::benchmarks {

/// One workload as files for the other codes: the packing, the velocities of kerf's start, bonds,
/// constants and the time step. docs/performance.md says what else is equal and what is not.
template <int dim> class Peers {
public:
  /// @param engine     before its first step
  /// @param time_step  s
  /// @throws std::runtime_error when a code that can run the workload is not installed
  Peers(const Workload& workload, const dem::Settings<dim>& settings,
        const dem::Engine<dim>& engine, double time_step);

  /// The codes that can run the workload.
  const std::vector<std::string>& codes() const noexcept { return codes_; }

  /// Set-up and warm-up are not timed.
  /// @throws std::runtime_error with the end of what the code said when it fails
  double seconds_per_step(const std::string& code, int threads, int steps) const;

private:
  void write_yade_model(const dem::Settings<dim>& settings, const dem::Engine<dim>& engine,
                        double time_step) const;
  void write_lammps_data(const dem::Settings<dim>& settings, const dem::Engine<dim>& engine,
                         bool with_bonds) const;

  Workload workload_;
  std::vector<std::string> codes_;
  TemporaryFolder folder_;
  std::string variables_; // of the LAMMPS and LIGGGHTS scripts
};

} // namespace kerf::benchmarks
