#include "fem_core/program/read_boundary.hpp"

#include "common/nearest.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace kerf::fem {

using coupler::SettingsError;

namespace {

template <int dim> std::array<bool, dim> read_components(const Table& table) {
  std::array<bool, dim> components{};
  for (const std::string& name : table.texts("components")) {
    const std::size_t axis = std::string("xyz").find(name);
    if (name.size() != 1 || axis >= dim)
      throw SettingsError(table.path("components"), fmt::format("\"{}\" must be {}", name,
                                                                dim == 2 ? "x or y" : "x, y or z"));
    components[axis] = true;
  }
  return components;
}

template <int dim> BoundarySetting<dim> read_motion(const Table& table, const Mesh<dim>& mesh) {
  BoundarySetting<dim> setting;
  if (table.has("tag"))
    setting.tag = read_tag(table, mesh);
  setting.box = read_box<dim>(table);
  setting.components.fill(true);
  if (table.has("components"))
    setting.components = read_components<dim>(table);

  using enum Motion;
  table.text("motion"); // which must be there
  setting.motion = table.one_of<Motion>("motion", fixed,
                                        {{"fixed", fixed},
                                         {"symmetry", symmetry},
                                         {"velocity", velocity},
                                         {"displacement", displacement_table},
                                         {"hann", hann}});
  if (setting.motion == velocity && table.has("velocities")) {
    setting.motion = velocity_table;
    setting.table = table.time_tables<dim>("velocities");
  } else if (setting.motion == velocity) {
    setting.velocity = table.vector<dim>("velocity");
  } else if (setting.motion == displacement_table) {
    setting.table = table.time_tables<dim>("displacements");
    for (std::size_t a = 0; a < dim; ++a)
      if (setting.components[a] && setting.table[a].value(0.0) != 0.0)
        throw SettingsError(table.path("displacements"),
                            fmt::format("at t = 0 it is {} m along {}; it must begin with zero",
                                        setting.table[a].value(0.0), "xyz"[a]));
  } else if (setting.motion == hann) {
    setting.amplitude = table.vector<dim>("amplitude");
    setting.duration = table.number("duration");
  }
  return setting;
}

/// A vector, or a table of it.
template <int dim>
std::array<TimeTable, dim> read_value(const Table& table, const std::string& key) {
  if (table.has(key + "s"))
    return table.time_tables<dim>(key + "s");
  const Vec<dim> value = table.vector<dim>(key);
  std::array<TimeTable, dim> constant;
  std::copy(value.begin(), value.end(), constant.begin());
  return constant;
}

template <int dim> LoadSetting<dim> read_load(const Table& table, const Mesh<dim>& mesh) {
  LoadSetting<dim> load;
  if (table.has("tag"))
    load.tag = read_tag(table, mesh);
  load.box = read_box<dim>(table);
  if (table.has("force") || table.has("forces")) {
    load.value = read_value<dim>(table, "force");
  } else if (table.has("traction") || table.has("tractions")) {
    load.kind = LoadKind::traction;
    load.value = read_value<dim>(table, "traction");
  } else {
    load.kind = LoadKind::pressure;
    load.value[0] = table.has("pressures") ? table.time_table("pressures")
                                           : TimeTable(table.number("pressure"));
  }
  return load;
}

/// The library reports an unknown tag too, but does not guess what was meant.
/// @param what  "tag"
void check_known(const std::string& name, const std::vector<std::string>& known, const char* what,
                 const std::string& key) {
  if (std::ranges::find(known, name) != known.end())
    return;
  if (known.empty())
    throw SettingsError(
        key, fmt::format("the mesh has no {0} \"{1}\", and no other\ngive a mesh with {0}s", what,
                         name));
  const std::string meant = nearest(name, known);
  throw SettingsError(key,
                      fmt::format("the mesh has no {} \"{}\"; {} {}s are {}", what, name,
                                  meant.empty() ? "its" : "did you mean \"" + meant + "\"? Its",
                                  what, fmt::join(known, ", ")));
}

} // namespace

template <int dim> std::optional<Box<dim>> read_box(const Table& table) {
  if (!table.has("box"))
    return std::nullopt;
  const auto [lower, upper] = table.corners<dim>("box");
  return Box<dim>{lower, upper};
}

template <int dim> std::string read_tag(const Table& table, const Mesh<dim>& mesh) {
  const std::string tag = table.text("tag");
  std::set<std::string> known = {"all"};
  for (const auto& [name, faces] : mesh.boundary)
    known.insert(name);
  for (const auto* sets : {&mesh.regions, &mesh.node_sets})
    for (const auto& [name, members] : *sets)
      known.insert(name);
  check_known(tag, {known.begin(), known.end()}, "tag", table.path("tag"));
  return tag;
}

template <int dim>
void check_region(const Mesh<dim>& mesh, const std::string& region, const std::string& key) {
  std::vector<std::string> known;
  for (const auto& [name, elements] : mesh.regions)
    known.push_back(name);
  check_known(region, known, "region", key);
}

template <int dim>
std::vector<BoundarySetting<dim>> read_boundary(const std::vector<Table>& list,
                                                const Mesh<dim>& mesh) {
  std::vector<BoundarySetting<dim>> settings;
  for (const Table& table : list)
    settings.push_back(read_motion(table, mesh));
  return settings;
}

template <int dim>
std::vector<LoadSetting<dim>> read_loads(const std::vector<Table>& list, const Mesh<dim>& mesh) {
  std::vector<LoadSetting<dim>> settings;
  for (const Table& table : list)
    settings.push_back(read_load(table, mesh));
  return settings;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template std::optional<Box<dim>> read_box(const Table&);                                         \
  template std::string read_tag(const Table&, const Mesh<dim>&);                                   \
  template void check_region(const Mesh<dim>&, const std::string&, const std::string&);            \
  template std::vector<BoundarySetting<dim>> read_boundary(const std::vector<Table>&,              \
                                                           const Mesh<dim>&);                      \
  template std::vector<LoadSetting<dim>> read_loads(const std::vector<Table>&, const Mesh<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::fem
