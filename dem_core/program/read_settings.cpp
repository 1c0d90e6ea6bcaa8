#include "dem_core/program/read_settings.hpp"

#include "common/packing_file.hpp"
#include "coupler/participant/participant.hpp"
#include "dem_core/bonding.hpp"
#include "dem_core/lattice.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <string_view>

namespace kerf::dem {

namespace {

using coupler::SettingsError;
using nlohmann::json;

/// A value of the table that knows its key, for error messages.
class Node {
public:
  Node(const json& value, std::string key) : value_(&value), key_(std::move(key)) {}

  const std::string& key() const { return key_; }
  std::size_t size() const { return value_->size(); }
  bool is_null() const { return value_->is_null(); }
  [[noreturn]] void fail(const std::string& sentence) const { throw SettingsError(key_, sentence); }

  /// A member; null when it is missing.
  Node operator[](std::string_view name) const {
    static const json missing;
    const auto member = value_->is_object() ? value_->find(name) : value_->end();
    const std::string key = key_.empty() ? std::string(name) : fmt::format("{}.{}", key_, name);
    return {value_->is_object() && member != value_->end() ? *member : missing, key};
  }
  Node operator[](std::size_t index) const {
    return {value_->at(index), fmt::format("{}[{}]", key_, index)};
  }

  double number() const {
    if (!value_->is_number())
      fail(is_null() ? "a number is missing here" : "this must be a number");
    return value_->get<double>();
  }
  double number_or(double other) const { return is_null() ? other : number(); }
  double positive() const {
    const double value = number();
    if (!(value > 0.0))
      fail(fmt::format("{} must be positive", value));
    return value;
  }
  double not_negative_or(double other) const {
    const double value = number_or(other);
    if (!(value >= 0.0))
      fail(fmt::format("{} must not be negative", value));
    return value;
  }
  double share() const {
    const double value = number_or(0.0);
    if (!(value >= 0.0 && value <= 1.0))
      fail(fmt::format("{} must be from 0 to 1", value));
    return value;
  }
  std::string text() const {
    if (!value_->is_string())
      fail(is_null() ? "a word is missing here" : "this must be a word in quotes");
    return value_->get<std::string>();
  }
  /// The value that a word stands for.
  template <class Value> Value one_of(const std::map<std::string, Value>& words) const {
    const auto found = words.find(text());
    if (found != words.end())
      return found->second;
    std::string allowed;
    for (const auto& [word, value] : words)
      allowed += (allowed.empty() ? "" : ", ") + word;
    fail(fmt::format("\"{}\" must be one of {}", text(), allowed));
  }
  void must_hold(std::size_t count, const char* what) const {
    if (!value_->is_array() || value_->size() != count)
      fail(fmt::format("this must be a list of {} {}", count, what));
  }
  template <int dim> Vec<dim> vector() const {
    must_hold(dim, "numbers");
    Vec<dim> vector;
    for (std::size_t a = 0; a < dim; ++a)
      vector[static_cast<int>(a)] = (*this)[a].number();
    return vector;
  }
  template <int dim> Vec<dim> vector_or_zero() const {
    return is_null() ? Vec<dim>(Vec<dim>::Zero()) : vector<dim>();
  }
  template <int dim> Box<dim> box() const {
    must_hold(2, "corners");
    return {(*this)[0].vector<dim>(), (*this)[1].vector<dim>()};
  }
  template <int dim> int axis() const {
    const std::string word = text();
    const auto axis = std::string("xyz").substr(0, dim).find(word);
    if (word.size() != 1 || axis == std::string::npos)
      fail(fmt::format("\"{}\" is not an axis in {}D", word, dim));
    return static_cast<int>(axis);
  }

private:
  const json* value_;
  std::string key_;
};

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

Material read_material(const Node& node) {
  Material m;
  m.density = node["density"].positive();
  const std::map<std::string, int> laws = {
      {"linear", 0}, {"linear_by_size", 1}, {"hertz_mindlin", 2}};
  switch (node["law"].is_null() ? 0 : node["law"].one_of(laws)) {
  case 0:
    m.normal_stiffness = node["normal_stiffness"].positive();
    m.tangential_stiffness = node["tangential_stiffness"].not_negative_or(0.0);
    break;
  case 1:
    m.contact_modulus = node["contact_modulus"].positive();
    m.stiffness_ratio = node["stiffness_ratio"].not_negative_or(0.0);
    break;
  default:
    m.law = NormalLaw::hertz_mindlin;
    m.young_modulus = node["young_modulus"].positive();
    m.poisson_ratio = node["poisson_ratio"].number();
  }
  m.friction = node["friction"].not_negative_or(0.0);
  m.rolling_friction = node["rolling_friction"].not_negative_or(0.0);
  m.restitution = node["restitution"].number_or(1.0);
  m.tensile_strength = node["tensile_strength"].not_negative_or(m.tensile_strength);
  m.shear_strength = node["shear_strength"].not_negative_or(m.shear_strength);
  m.tensile_stress = node["tensile_stress"].not_negative_or(m.tensile_stress);
  m.shear_stress = node["shear_stress"].not_negative_or(m.shear_stress);
  m.bond_radius_ratio = node["bond_radius_ratio"].not_negative_or(0.0);
  return m;
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
  if (p.motion == Motion::velocity)
    p.velocity = node["velocity"].vector<dim>();
  if (p.motion == Motion::hann) {
    p.amplitude = node["amplitude"].vector<dim>();
    p.duration = node["duration"].positive();
  }
  return p;
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
  try {
    return gap_tolerance_for<dim>(number.positive(), s.positions, s.radii, s.period);
  } catch (const std::invalid_argument& error) {
    number.fail(error.what());
  }
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
  s.material = read_material(node["material"]);
  s.period = read_period<dim>(Node(case_table, "")["periodic"]);
  const Node kind = node["bonds"]["kind"];
  s.bonds = s.material.law == NormalLaw::linear && (kind.is_null() || kind.text() != "none");
  s.gap_tolerance = read_gap_tolerance<dim>(node["bonds"], s);
  if (const Node rule = node["bonds"]["shear_increment"]; !rule.is_null())
    s.shear_increment = rule.one_of(shear_increments);
  if (const Node damping = node["damping"]; !damping.is_null()) {
    s.damping.kind = damping["kind"].one_of(damping_kinds);
    s.damping.translation = damping["translation"].share();
    s.damping.rotation = damping["rotation"].share();
  }
  for (std::size_t k = 0; k < node["boundary"].size(); ++k)
    s.boundary.push_back(read_prescription<dim>(node["boundary"][k]));
  for (std::size_t k = 0; k < node["initial"].size(); ++k)
    s.initial.push_back(read_initial<dim>(node["initial"][k]));
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
template Watch<2> read_watch<2>(const nlohmann::json&);
template Watch<3> read_watch<3>(const nlohmann::json&);

} // namespace kerf::dem
