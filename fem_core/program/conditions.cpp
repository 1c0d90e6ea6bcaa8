#include "fem_core/program/conditions.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace kerf::fem {
namespace {

using Words = std::vector<std::string>;

/// Where a text stands in a list of words.
std::size_t find_word(const Table& table, const std::string& key, const Words& words) {
  const auto found = std::ranges::find(words, table.text(key));
  if (found == words.end())
    throw coupler::SettingsError(
        table.path(key),
        fmt::format("\"{}\" must be one of {}", table.text(key), fmt::join(words, ", ")));
  return static_cast<std::size_t>(found - words.begin());
}

} // namespace

template <int dim>
std::vector<Condition> read_conditions(const std::vector<Table>& list, const Watch<dim>& watch) {
  using enum Quantity;
  const Words axes = dim == 2 ? Words{"x", "y"} : Words{"x", "y", "z"};
  const Words pairs =
      dim == 2 ? Words{"xx", "yy", "zz", "xy"} : Words{"xx", "yy", "zz", "yz", "xz", "xy"};
  Words probes;
  for (const Probe<dim>& probe : watch.probes)
    probes.push_back(probe.name);

  std::vector<Condition> conditions;
  for (const Table& table : list) {
    Condition c;
    c.name = table.text("name");
    table.text("quantity"); // which must be there
    c.quantity = table.one_of<Quantity>("quantity", kinetic_ratio,
                                        {{"unbalanced_force", unbalanced_force},
                                         {"kinetic_ratio", kinetic_ratio},
                                         {"stress", stress},
                                         {"displacement", displacement},
                                         {"force", force}});
    if (c.quantity == stress || c.quantity == displacement)
      c.index = find_word(table, "probe", probes);
    if (c.quantity == force)
      c.index = find_word(table, "wall", watch.walls);
    if (c.quantity != unbalanced_force && c.quantity != kinetic_ratio)
      c.component =
          static_cast<int>(find_word(table, "component", c.quantity == stress ? pairs : axes));
    if (table.has("above"))
      c.above = table.number("above");
    if (table.has("below"))
      c.below = table.number("below");
    c.after = table.number("after", 0.0);
    c.every = table.has("every") ? table.count("every") : 1;
    conditions.push_back(std::move(c));
  }
  return conditions;
}

template <int dim>
double value_of(const Condition& condition, const Engine<dim>& engine, const Watch<dim>& watch) {
  switch (condition.quantity) {
  case Quantity::unbalanced_force:
    return engine.unbalanced_force();
  case Quantity::kinetic_ratio:
    return fem::kinetic_ratio(engine.energies());
  case Quantity::stress:
    return stress_at(watch.probes[condition.index], engine)[condition.component];
  case Quantity::displacement:
    return at_probe<dim>(watch.probes[condition.index], engine.mesh(),
                         displacement_of_step(engine, watch.time_step))[condition.component];
  case Quantity::force:
    return 0.0 - engine.wall_force(condition.index)[condition.component];
  }
  return 0.0;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template std::vector<Condition> read_conditions(const std::vector<Table>&, const Watch<dim>&);   \
  template double value_of(const Condition&, const Engine<dim>&, const Watch<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::fem
