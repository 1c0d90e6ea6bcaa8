// The stop conditions of a case: what of a body is compared with a bound.
#pragma once

#include "common/stop_condition.hpp"
#include "fem_core/engine.hpp"
#include "fem_core/program/table.hpp"
#include "fem_core/program/watch.hpp"

#include <vector>

namespace kerf::fem {

enum class Quantity {
  unbalanced_force, // resultants of what is free over all forces
  kinetic_ratio,    // kinetic over the size of the elastic energy, which counts from the start
  stress,           // a component of a probe, Pa
  displacement,     // likewise, since the last reset, m
  force,            // on a wall along an axis, N
};
using Condition = StopCondition<Quantity>;

/// @throws coupler::SettingsError for a probe, a wall or a component that is not there
template <int dim>
std::vector<Condition> read_conditions(const std::vector<Table>& list, const Watch<dim>& watch);

/// The quantity of a condition, after integrate().
template <int dim>
double value_of(const Condition& condition, const Engine<dim>& engine, const Watch<dim>& watch);

} // namespace kerf::fem
