#include "dem_core/program/read_materials.hpp"

#include "dem_core/program/read_selection.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace kerf::dem {

namespace {

/// What a table does not give stays as it is in `m`.
Material read_material(const Node& node, Material m) {
  const std::map<std::string, std::tuple<NormalLaw, const char*, double Material::*>> laws = {
      {"linear", {NormalLaw::linear, "normal_stiffness", &Material::normal_stiffness}},
      {"linear_by_size", {NormalLaw::linear, "contact_modulus", &Material::contact_modulus}},
      {"hertz_mindlin", {NormalLaw::hertz_mindlin, "young_modulus", &Material::young_modulus}}};
  if (!node["normal_stiffness"].is_null()) {
    m.normal_stiffness = node["normal_stiffness"].positive();
    m.tangential_stiffness = node["tangential_stiffness"].not_negative_or(0.0);
    m.contact_modulus = m.stiffness_ratio = 0.0;
  }
  if (!node["contact_modulus"].is_null()) {
    m.contact_modulus = node["contact_modulus"].positive();
    m.stiffness_ratio = node["stiffness_ratio"].not_negative_or(0.0);
    m.normal_stiffness = m.tangential_stiffness = 0.0;
  }
  if (!node["young_modulus"].is_null()) {
    m.young_modulus = node["young_modulus"].positive();
    m.poisson_ratio = node["poisson_ratio"].number();
  }
  if (const Node law = node["law"]; !law.is_null()) {
    const auto [kind, key, constant] = law.one_of(laws);
    m.law = kind;
    if (!(m.*constant > 0.0))
      node[key].fail("a number is missing here", fmt::format("law = \"{}\" needs it", law.text()));
  }
  m.friction = node["friction"].not_negative_or(m.friction);
  m.rolling_friction = node["rolling_friction"].not_negative_or(m.rolling_friction);
  m.restitution = node["restitution"].number_or(m.restitution);
  m.tensile_strength = node["tensile_strength"].not_negative_or(m.tensile_strength);
  m.shear_strength = node["shear_strength"].not_negative_or(m.shear_strength);
  m.tensile_stress = node["tensile_stress"].not_negative_or(m.tensile_stress);
  m.shear_stress = node["shear_stress"].not_negative_or(m.shear_stress);
  m.bond_radius_ratio = node["bond_radius_ratio"].not_negative_or(m.bond_radius_ratio);
  return m;
}

Material read_whole_material(const Node& node) {
  Material m;
  m.density = node["density"].positive();
  return read_material(node, m);
}

/// The particles of a material, by box, ids or the numbers of a file.
template <int dim> std::vector<std::uint32_t> select(const Node& node, const Settings<dim>& s) {
  const auto count = static_cast<std::uint32_t>(s.positions.size());
  std::vector<std::uint32_t> particles;
  if (!node["box"].is_null()) {
    const Box<dim> box = node["box"].box<dim>();
    for (std::uint32_t i = 0; i < count; ++i)
      if (box.contains(s.positions[i]))
        particles.push_back(i);
  } else if (!node["ids"].is_null()) {
    particles = read_ids(node["ids"]);
    for (std::size_t k = 0; k < particles.size(); ++k)
      if (particles[k] >= count)
        node["ids"][k].fail(fmt::format("there is no particle {}", particles[k]),
                            fmt::format("give numbers from 0 to {}", count - 1));
  } else {
    auto groups = read_groups(node["file"], count);
    particles = std::move(groups[node["number"].number()]);
  }
  if (particles.empty())
    node.fail(fmt::format("no particle is of the material \"{}\"", node["name"].text()),
              "let its box, ids or file have some");
  return particles;
}

} // namespace

template <int dim> void read_materials(const Node& participant, Settings<dim>& s) {
  const Node own = participant["material"], list = participant["materials"];
  s.material = read_whole_material(own);
  std::vector<std::string> names = {own["name"].is_null() ? "default" : own["name"].text()};
  for (std::size_t k = 0; k < list.size(); ++k) {
    s.other_materials.push_back(read_whole_material(list[k]));
    names.push_back(list[k]["name"].text());
    s.material_of.resize(s.positions.size());
    for (const std::uint32_t i : select(list[k], s)) // the later one counts
      s.material_of[i] = static_cast<std::uint8_t>(k + 1);
  }
  if (names.size() > 256)
    list.fail(fmt::format("{} materials are too many", list.size()), "give at most 255");

  const auto index_of = [&](const Node& node) {
    const auto found = std::find(names.begin(), names.end(), node.text());
    if (found == names.end())
      node.fail(fmt::format("there is no material \"{}\"", node.text()),
                fmt::format("name one of {}", fmt::join(names, ", ")));
    return static_cast<std::size_t>(found - names.begin());
  };
  const auto material = [&](std::size_t k) {
    return k == 0 ? s.material : s.other_materials[k - 1];
  };
  const Node pairs = participant["pairs"];
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Node between = pairs[k]["between"];
    const std::size_t first = index_of(between[0]), second = index_of(between[1]);
    MaterialPair pair;
    pair.first = static_cast<std::uint8_t>(first);
    pair.second = static_cast<std::uint8_t>(second);
    pair.of_first = read_material(pairs[k], material(first));
    pair.of_second = read_material(pairs[k], material(second));
    pair.bonds = pairs[k]["bonds"].is_null() || pairs[k]["bonds"].flag();
    s.pairs.push_back(std::move(pair));
  }
}

template void read_materials<2>(const Node&, Settings<2>&);
template void read_materials<3>(const Node&, Settings<3>&);

} // namespace kerf::dem
