// The stop conditions of a case: what of the particles is compared with a bound.
#pragma once

#include "common/stop_condition.hpp"
#include "dem_core/engine.hpp"
#include "dem_core/probe.hpp"
#include "dem_core/program/settings_node.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kerf::dem {

enum class Quantity {
  unbalanced_force, // mean resultant over mean contact force
  kinetic_ratio,    // kinetic over elastic energy
  cracks,           // bonds that broke since the start
  strain,           // a component of a probe
  stress,           // likewise, Pa
  displacement,     // of a tool along an axis since the start, m
  force,            // on a tool along an axis, N
};

using Condition = StopCondition<Quantity>;

/// @param list  conditions of a case or a stage, null for none
/// @throws coupler::SettingsError for a probe, a tool or a component that is not there
template <int dim>
std::vector<Condition> read_conditions(const Node& list, const Engine<dim>& engine,
                                       std::span<const Probe<dim>> probes);

/// The first condition that is met, after integrate() of a step: everything is of t_n.
/// @param begin  first step of the run or stage
template <int dim>
std::optional<Met> find_met(std::span<const Condition> conditions, std::uint64_t step,
                            std::uint64_t begin, const Engine<dim>& engine,
                            std::span<const Probe<dim>> probes);

} // namespace kerf::dem
