#include "dem_core/program/read_settings.hpp"

#include "common/packing_file.hpp"
#include "dem_core/bonding.hpp"
#include "dem_core/lattice.hpp"
#include "dem_core/program/read_clusters.hpp"
#include "dem_core/program/read_materials.hpp"
#include "dem_core/program/read_table.hpp"
#include "dem_core/program/read_tools.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <string_view>

namespace kerf::dem {

namespace {

const std::map<std::string, LatticeType> lattice_types = {{"chain", LatticeType::chain},
                                                          {"triangular", LatticeType::triangular},
                                                          {"square", LatticeType::square},
                                                          {"cubic", LatticeType::cubic},
                                                          {"fcc", LatticeType::fcc}};
const std::map<std::string, DampingKind> damping_kinds = {
    {"nonviscous", DampingKind::nonviscous}, {"componentwise", DampingKind::componentwise}};
const std::map<std::string, ShearIncrement> shear_increments = {
    {"midpoint", ShearIncrement::midpoint}, {"endpoint", ShearIncrement::endpoint}};
const std::map<std::string, Motion> motions = {
    {"fixed", Motion::fixed}, {"velocity", Motion::velocity}, {"hann", Motion::hann}};

template <int dim> void read_lattice(const Node& node, const Node& radius, Settings<dim>& s) {
  Lattice<dim> lattice;
  lattice.type = node["type"].one_of(lattice_types);
  lattice.spacing = node["spacing"].positive();
  lattice.origin = node["origin"].vector_or_zero<dim>();
  const Node count = node["count"];
  count.must_hold(dim, "numbers");
  for (std::size_t a = 0; a < dim; ++a)
    lattice.count[a] = static_cast<int>(count[a].positive());
  try {
    s.positions = lattice_points(lattice);
  } catch (const std::invalid_argument& error) {
    node.fail(error.what());
  }
  s.radii.assign(s.positions.size(), radius.is_null() ? 0.5 * lattice.spacing : radius.positive());
}

template <int dim> void read_file(const Node& node, Settings<dim>& s) {
  try {
    Packing packing = read_packing(node.text(), dim);
    s.radii = std::move(packing.radii);
    s.positions.resize(s.radii.size());
    for (std::size_t i = 0; i < s.positions.size(); ++i)
      s.positions[i] = Eigen::Map<const Vec<dim>>(&packing.positions[i * dim]);
  } catch (const PackingError& error) {
    node.fail(error.what());
  }
}

Damping read_damping(const Node& node) {
  return {node["kind"].one_of(damping_kinds), node["translation"].share(),
          node["rotation"].share()};
}

template <int dim> std::uint8_t read_components(const Node& node) {
  unsigned components = 0;
  if (node.is_null())
    return static_cast<std::uint8_t>((1u << dim) - 1u);
  for (std::size_t k = 0; k < node.size(); ++k)
    components |= 1u << (node[k].text() == "rotation" ? dim : node[k].axis<dim>());
  return static_cast<std::uint8_t>(components);
}

template <int dim> Prescription<dim> read_prescription(const Node& node) {
  Prescription<dim> p;
  p.box = node["box"].box<dim>();
  p.components = read_components<dim>(node["components"]);
  p.motion = node["motion"].one_of(motions);
  if (p.motion == Motion::velocity && node["velocities"].is_null())
    p.velocity = node["velocity"].vector<dim>();
  if (p.motion == Motion::velocity && !node["velocities"].is_null()) {
    p.motion = Motion::table;
    p.velocities = read_vector_table<dim>(node["velocities"]);
  }
  if (p.motion == Motion::hann) {
    p.amplitude = node["amplitude"].vector<dim>();
    p.duration = node["duration"].positive();
  }
  if (const Node rotation = node["rotation"]; !rotation.is_null()) {
    p.components |= static_cast<std::uint8_t>(1u << dim);
    p.rotation_rate = read_value_or_table(rotation["rate"], rotation["rates"]);
    if constexpr (dim == 3)
      p.axis = rotation["axis"].vector<3>();
    if (!(p.axis.norm() > 0.0))
      rotation["axis"].fail("the axis has no length");
  }
  return p;
}

template <int dim> AppliedForce<dim> read_load(const Node& node) {
  AppliedForce<dim> load{.box = node["box"].box<dim>(), .force = {}};
  if (node["forces"].is_null()) {
    const Vec<dim> force = node["force"].vector<dim>();
    for (int a = 0; a < dim; ++a)
      load.force[static_cast<std::size_t>(a)] = force[a];
  } else {
    load.force = read_vector_table<dim>(node["forces"]);
  }
  const std::map<std::string, bool> distributions = {{"each", false}, {"by_mass", true}};
  load.is_total = !node["distribution"].is_null() && node["distribution"].one_of(distributions);
  return load;
}

template <int dim> InitialCondition<dim> read_initial(const Node& node) {
  InitialCondition<dim> condition;
  if (!node["box"].is_null())
    condition.box = node["box"].box<dim>();
  const std::string kind = node["kind"].text();
  if (kind == "velocity") {
    condition.velocity = node["velocity"].vector<dim>();
  } else if (kind == "pulse") {
    Pulse pulse;
    pulse.amplitude = node["amplitude"].number();
    pulse.center = node["center"].number();
    pulse.length = node["length"].positive();
    pulse.wave_speed = node["wave_speed"].number();
    pulse.spacing = node["spacing"].not_negative_or(0.0);
    pulse.component = node["component"].is_null() ? 0 : node["component"].axis<dim>();
    pulse.axis = node["axis"].is_null() ? 0 : node["axis"].axis<dim>();
    condition.pulse = pulse;
  } else {
    node["kind"].fail(fmt::format("\"{}\" must be one of pulse, velocity", kind));
  }
  return condition;
}

template <int dim> Period<dim> read_period(const Node& node) {
  Period<dim> period;
  for (int a = 0; a < dim; ++a) {
    const Node ends = node[std::string_view("xyz").substr(static_cast<std::size_t>(a), 1)];
    if (ends.is_null())
      continue;
    ends.must_hold(2, "numbers");
    period.length[a] = ends[1].number() - ends[0].number();
    if (!(period.length[a] > 0.0))
      ends.fail("the upper end must lie above the lower one");
  }
  return period;
}

/// As given, or the one that gives the bonds their number.
template <int dim> double read_gap_tolerance(const Node& bonds, const Settings<dim>& s) {
  const Node number = bonds["coordination_number"];
  if (number.is_null())
    return bonds["gap_tolerance"].not_negative_or(s.gap_tolerance);
  if (!s.other_materials.empty())
    number.fail("it is for particles of one material", "give gap_tolerance");
  try {
    return gap_tolerance_for<dim>(number.positive(), s.positions, s.radii, s.period);
  } catch (const std::invalid_argument& error) {
    number.fail(error.what());
  }
}

template <int dim> InSituStress<dim> read_in_situ_stress(const Node& node) {
  InSituStress<dim> stress;
  if (const Node uniform = node["stress"]; !uniform.is_null()) {
    constexpr std::size_t count = dim == 2 ? 3 : 6;
    uniform.must_hold(count, dim == 2 ? "numbers: xx yy xy" : "numbers: xx yy zz yz xz xy");
    for (std::size_t k = 0; k < count; ++k)
      stress.uniform[static_cast<int>(k)] = uniform[k].number();
  }
  if (const Node K0 = node["K0"]; !K0.is_null()) {
    stress.K0 = K0.not_negative_or(0.0);
    stress.surface = node["surface"].number();
    stress.overburden = node["overburden"].not_negative_or(0.0);
  }
  return stress;
}

} // namespace

template <int dim>
Settings<dim> read_settings(const nlohmann::json& table, const nlohmann::json& case_table) {
  const Node node(table, "");
  Settings<dim> s;
  const Node particles = node["particles"];
  if (particles["lattice"].is_null() == particles["file"].is_null())
    particles.fail("either a lattice or a file of particles is needed");
  if (particles["file"].is_null())
    read_lattice(particles["lattice"], particles["radius"], s);
  else
    read_file(particles["file"], s);
  read_materials(node, s);
  s.period = read_period<dim>(Node(case_table, "")["periodic"]);
  const Node kind = node["bonds"]["kind"];
  s.bonds = kind.is_null() || kind.text() != "none";
  s.gap_tolerance = read_gap_tolerance<dim>(node["bonds"], s);
  if (const Node rule = node["bonds"]["shear_increment"]; !rule.is_null())
    s.shear_increment = rule.one_of(shear_increments);
  if (const Node damping = node["damping"]; !damping.is_null())
    s.damping = read_damping(damping);
  for (std::size_t k = 0; k < node["boundary"].size(); ++k)
    s.boundary.push_back(read_prescription<dim>(node["boundary"][k]));
  for (std::size_t k = 0; k < node["loads"].size(); ++k)
    s.applied_forces.push_back(read_load<dim>(node["loads"][k]));
  for (std::size_t k = 0; k < node["initial"].size(); ++k)
    s.initial.push_back(read_initial<dim>(node["initial"][k]));
  s.gravity = node["gravity"].vector_or_zero<dim>();
  s.tools = read_tools<dim>(node["tools"]);
  s.clusters = read_clusters<dim>(node["clusters"], s.positions.size());
  if (const Node stress = node["in_situ_stress"]; !stress.is_null())
    s.in_situ_stress = read_in_situ_stress<dim>(stress);
  if (const Node scaling = node["mass_scaling"]; !scaling.is_null())
    s.mass_scaling = MassScaling{.critical_step = scaling["critical_step"].not_negative_or(0.0),
                                 .factor = scaling["factor"].number_or(1.0)};
  return s;
}

template <int dim> Watch<dim> read_watch(const nlohmann::json& table) {
  const Node node(table, "");
  Watch<dim> watch;
  const Node probes = node["probes"];
  for (std::size_t k = 0; k < probes.size(); ++k)
    watch.probes.push_back({probes[k]["name"].text(), probes[k]["box"].box<dim>()});
  if (!node["domain"].is_null())
    watch.domain = node["domain"].box<dim>();
  return watch;
}

template <int dim> Change<dim> read_change(const Node& node, const Engine<dim>& engine) {
  Change<dim> change;
  if (const Node damping = node["damping"]; !damping.is_null())
    change.damping = read_damping(damping);
  if (const Node gravity = node["gravity"]; !gravity.is_null())
    change.gravity = gravity.vector<dim>();
  if (const Node friction = node["friction"]; !friction.is_null())
    change.friction = friction.not_negative_or(0.0);
  if (const Node gap = node["bond_gap"]; !gap.is_null())
    change.bond_gap = gap.not_negative_or(0.0);
  if (node["boundary"].size() > 0 || node["release"].flag())
    change.boundary.emplace();
  for (std::size_t k = 0; k < node["boundary"].size(); ++k)
    change.boundary->push_back(read_prescription<dim>(node["boundary"][k]));
  for (std::size_t k = 0; k < node["tools"].size(); ++k) {
    const Node tool = node["tools"][k];
    std::size_t index = 0;
    while (index < engine.tools().size() && engine.tool_name(index) != tool["name"].text())
      ++index;
    if (index == engine.tools().size())
      tool["name"].fail(fmt::format("there is no tool \"{}\"", tool["name"].text()));
    const Tool<dim>& now = engine.tools()[index];
    change.tools.emplace_back(index, read_motion<dim>(tool, now.pose().start, now.axis()));
  }
  return change;
}

std::optional<int> read_threads(const nlohmann::json& table) {
  const Node node = Node(table, "")["threads"];
  const auto found = table.find("threads");
  if (found == table.end() || found->is_null() || *found == "auto")
    return std::nullopt;
  if (!found->is_number_integer() || found->get<int>() < 1)
    node.fail("threads must be \"auto\" or a whole number from 1");
  return found->get<int>();
}

template Settings<2> read_settings<2>(const nlohmann::json&, const nlohmann::json&);
template Settings<3> read_settings<3>(const nlohmann::json&, const nlohmann::json&);
template Change<2> read_change<2>(const Node&, const Engine<2>&);
template Change<3> read_change<3>(const Node&, const Engine<3>&);
template Watch<2> read_watch<2>(const nlohmann::json&);
template Watch<3> read_watch<3>(const nlohmann::json&);

} // namespace kerf::dem
