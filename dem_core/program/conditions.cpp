#include "dem_core/program/conditions.hpp"

#include "dem_core/balance.hpp"

#include <algorithm>
#include <map>

namespace kerf::dem {

namespace {

const std::map<std::string, Quantity> quantities = {
    {"unbalanced_force", Quantity::unbalanced_force},
    {"kinetic_ratio", Quantity::kinetic_ratio},
    {"cracks", Quantity::cracks},
    {"strain", Quantity::strain},
    {"stress", Quantity::stress},
    {"displacement", Quantity::displacement},
    {"force", Quantity::force}};

/// Where a name stands in a list of names.
std::size_t find_name(const Node& node, const char* what, const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), node.text());
  if (found == names.end())
    node.fail(fmt::format("there is no {} \"{}\"", what, node.text()));
  return static_cast<std::size_t>(found - names.begin());
}

template <int dim> int find_component(const Node& node) {
  const std::vector<std::string> names =
      dim == 2 ? std::vector<std::string>{"xx", "yy", "xy"}
               : std::vector<std::string>{"xx", "yy", "zz", "yz", "xz", "xy"};
  return static_cast<int>(find_name(node, "component", names));
}

template <int dim>
double value_of(const Condition& c, const Engine<dim>& engine, std::span<const Probe<dim>> probes) {
  const auto reading = [&] {
    return read_probe(probes[c.index].box, engine.period(), engine.contacts(), engine.particles());
  };
  switch (c.quantity) {
  case Quantity::unbalanced_force:
    return engine.unbalanced_force();
  case Quantity::kinetic_ratio:
    return kinetic_ratio(engine.energies());
  case Quantity::cracks:
    return static_cast<double>(engine.cracks().size());
  case Quantity::strain:
    return reading().strain[c.component];
  case Quantity::stress:
    return reading().stress[c.component];
  case Quantity::displacement: {
    const Pose<dim>& pose = engine.tools()[c.index].pose();
    return pose.reference[c.component] - pose.start[c.component];
  }
  case Quantity::force:
    return engine.tools()[c.index].load().force[c.component];
  }
  return 0.0;
}

} // namespace

template <int dim>
std::vector<Condition> read_conditions(const Node& nodes, const Engine<dim>& engine,
                                       std::span<const Probe<dim>> probes) {
  std::vector<std::string> tool_names, probe_names;
  for (std::size_t k = 0; k < engine.tools().size(); ++k)
    tool_names.push_back(engine.tool_name(k));
  for (const Probe<dim>& probe : probes)
    probe_names.push_back(probe.name);

  std::vector<Condition> conditions;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Node node = nodes[k];
    Condition c;
    c.name = node["name"].text();
    c.quantity = node["quantity"].one_of(quantities);
    if (c.quantity == Quantity::strain || c.quantity == Quantity::stress) {
      c.index = find_name(node["probe"], "probe", probe_names);
      c.component = find_component<dim>(node["component"]);
    }
    if (c.quantity == Quantity::displacement || c.quantity == Quantity::force) {
      c.index = find_name(node["tool"], "tool", tool_names);
      c.component = node["component"].axis<dim>();
    }
    if (!node["above"].is_null())
      c.above = node["above"].number();
    if (!node["below"].is_null())
      c.below = node["below"].number();
    c.after = node["after"].number_or(0.0);
    c.every = static_cast<std::uint64_t>(node["every"].positive());
    conditions.push_back(std::move(c));
  }
  return conditions;
}

template <int dim>
std::optional<Met> find_met(std::span<const Condition> conditions, std::uint64_t step,
                            std::uint64_t begin, const Engine<dim>& engine,
                            std::span<const Probe<dim>> probes) {
  return kerf::find_met(conditions, step, begin, engine.time_step(),
                        [&](const Condition& c) { return value_of(c, engine, probes); });
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template std::vector<Condition> read_conditions<dim>(const Node&, const Engine<dim>&,            \
                                                       std::span<const Probe<dim>>);               \
  template std::optional<Met> find_met<dim>(std::span<const Condition>, std::uint64_t,             \
                                            std::uint64_t, const Engine<dim>&,                     \
                                            std::span<const Probe<dim>>);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
