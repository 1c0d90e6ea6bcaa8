// What kerf-dem writes of sets of particles: reactions of the boundary, applied forces, clusters.
#pragma once

#include "common/history.hpp"
#include "dem_core/engine.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace kerf::dem {

template <int dim> class SetOutput {
public:
  /// Makes history/<participant>_boundary.csv, _loads.csv and _clusters.csv when there are such
  /// sets.
  SetOutput(const Engine<dim>& engine, bool has_stages, const std::filesystem::path& run_folder,
            const std::string& participant);

  /// A row for each set, in the order of the case; all of t_n but velocities, v^(n+1/2).
  void write_history(std::uint64_t step, double time);

private:
  const Engine<dim>& engine_;
  std::optional<History> boundary_, loads_, clusters_;
};

} // namespace kerf::dem
