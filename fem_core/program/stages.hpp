// The stages of a run of kerf-fem: what changes at the beginning of each, and what may end it.
#pragma once

#include "fem_core/engine.hpp"
#include "fem_core/program/conditions.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kerf::fem {

template <int dim> class Stages {
public:
  /// Reads `stages` and `stop` of a participant's table.
  /// @param name  of the participant: what is of others is theirs
  /// @throws coupler::SettingsError
  Stages(const Table& participant, const std::string& name, Engine<dim>& engine,
         const Watch<dim>& watch);

  std::size_t size() const noexcept { return stages_.size(); } // 0: the run has none

  /// Makes the changes of a stage, before its first step.
  void begin(std::size_t stage);
  /// Makes the settings those of a stage, of which the state will be restored.
  void adopt(std::size_t stage);
  /// The condition of the stage or the run that a step meets which has just been integrated.
  std::optional<Met> met(std::size_t stage, std::uint64_t begin, const Watch<dim>& watch) const;

private:
  struct Stage {
    std::vector<Change<dim>> changes;
    std::vector<Condition> conditions;
  };

  Engine<dim>& engine_;
  std::vector<Stage> stages_;
  std::vector<Condition> conditions_; // of the whole run
};

} // namespace kerf::fem
