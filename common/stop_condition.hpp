// What ends a run, or a stage of it, before its time: a quantity that has passed a bound.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace kerf {

/// @tparam Quantity  what an engine can be asked for
template <class Quantity> struct StopCondition {
  std::string name;
  Quantity quantity{};
  std::size_t index = 0; // of the probe, tool or wall
  int component = 0;     // of its stress, strain or vector
  std::optional<double> above{}, below{};
  double after = 0.0;      // from the beginning of the run or stage, s
  std::uint64_t every = 1; // steps from one look to the next
};

/// A condition that is met, with its value.
struct Met {
  std::string name;
  double value = 0.0;
};

/// The first condition that is met in a step.
/// @param begin     first step of the run or stage
/// @param value_of  value of a condition, which is computed when it is due
template <class Quantity, class Value>
std::optional<Met> find_met(std::span<const StopCondition<Quantity>> conditions, std::uint64_t step,
                            std::uint64_t begin, double time_step, Value value_of) {
  for (const StopCondition<Quantity>& c : conditions) {
    if (step % c.every != 0 || static_cast<double>(step - begin) * time_step < c.after)
      continue;
    const double value = value_of(c);
    if ((c.above && value > *c.above) || (c.below && value < *c.below))
      return Met{c.name, value};
  }
  return std::nullopt;
}

} // namespace kerf
