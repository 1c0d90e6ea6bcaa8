// What ends a run, or a stage of it, before its time: a quantity that has passed a bound.
#pragma once

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

struct Condition {
  std::string name;
  Quantity quantity = Quantity::unbalanced_force;
  std::size_t index = 0; // of the probe or tool
  int component = 0;     // of its stress, strain or vector
  std::optional<double> above, below;
  double after = 0.0;      // from the beginning of the run or stage, s
  std::uint64_t every = 1; // steps from one look to the next
};

/// A condition that is met, with its value.
struct Met {
  std::string name;
  double value = 0.0;
};

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
