#include "fem_core/program/read_settings.hpp"

#include "common/nearest.hpp"
#include "fem_core/program/read_materials.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace kerf::fem {

using coupler::SettingsError;

namespace {

template <int dim> int read_axis(const Table& table, const std::string& key) {
  const std::string name = table.text(key);
  for (int axis = 0; axis < dim; ++axis)
    if (name == std::string(1, "xyz"[axis]))
      return axis;
  throw SettingsError(table.path(key),
                      fmt::format("\"{}\" must be {}", name, dim == 2 ? "x or y" : "x, y or z"));
}

template <int dim> std::optional<Box<dim>> read_box(const Table& table) {
  if (!table.has("box"))
    return std::nullopt;
  const auto [lower, upper] = table.corners<dim>("box");
  return Box<dim>{lower, upper};
}

/// The library reports an unknown tag too, but does not guess what was meant.
template <int dim>
void check_tag(const Mesh<dim>& mesh, const std::string& tag, const std::string& key) {
  std::vector<std::string> tags = {"all"};
  for (const auto& [name, faces] : mesh.boundary)
    tags.push_back(name);
  if (std::find(tags.begin(), tags.end(), tag) != tags.end())
    return;
  const std::string meant = nearest(tag, tags);
  throw SettingsError(key,
                      fmt::format("the mesh has no tag \"{}\"; {} tags are {}", tag,
                                  meant.empty() ? "its" : "did you mean \"" + meant + "\"? Its",
                                  fmt::join(tags, ", ")));
}

template <int dim> BoundarySetting<dim> read_boundary(const Table& table, const Mesh<dim>& mesh) {
  BoundarySetting<dim> setting;
  if (table.has("tag")) {
    setting.tag = table.text("tag");
    check_tag(mesh, setting.tag, table.path("tag"));
  }
  setting.box = read_box<dim>(table);

  setting.components.fill(!table.has("components"));
  if (table.has("components"))
    for (const std::string& name : table.texts("components")) {
      const std::size_t axis = std::string("xyz").find(name);
      if (name.size() != 1 || axis >= dim)
        throw SettingsError(
            table.path("components"),
            fmt::format("\"{}\" must be {}", name, dim == 2 ? "x or y" : "x, y or z"));
      setting.components[axis] = true;
    }

  const std::string motion = table.text("motion");
  if (motion == "fixed") {
    setting.motion = Motion::fixed;
  } else if (motion == "velocity") {
    setting.motion = Motion::velocity;
    setting.velocity = table.vector<dim>("velocity");
  } else if (motion == "hann") {
    setting.motion = Motion::hann;
    setting.amplitude = table.vector<dim>("amplitude");
    setting.duration = table.number("duration");
  } else {
    throw SettingsError(table.path("motion"),
                        fmt::format("\"{}\" must be fixed, velocity or hann", motion));
  }
  return setting;
}

template <int dim> InitialSetting<dim> read_initial(const Table& table) {
  InitialSetting<dim> setting;
  setting.box = read_box<dim>(table);
  const std::string kind = table.text("kind");
  if (kind == "velocity")
    setting.velocity = InitialVelocity<dim>{table.vector<dim>("velocity")};
  else if (kind == "pulse")
    setting.pulse = InitialPulse{.amplitude = table.number("amplitude"),
                                 .center = table.number("center"),
                                 .length = table.number("length"),
                                 .wave_speed = table.number("wave_speed"),
                                 .spacing = table.number("spacing", 0.0),
                                 .component = read_axis<dim>(table, "component"),
                                 .axis = read_axis<dim>(table, "axis")};
  else
    throw SettingsError(table.path("kind"), fmt::format("\"{}\" must be velocity or pulse", kind));
  return setting;
}

} // namespace

template <int dim> Settings<dim> read_settings(const Table& participant, const Mesh<dim>& mesh) {
  Settings<dim> settings;
  settings.materials = read_materials(participant, mesh);
  settings.plane = read_plane(participant);
  for (const Table& table : participant.list("boundary"))
    settings.boundary.push_back(read_boundary(table, mesh));
  for (const Table& table : participant.list("initial"))
    settings.initial.push_back(read_initial<dim>(table));
  if (participant.has("gravity"))
    settings.gravity = participant.vector<dim>("gravity");
  if (participant.has("damping")) {
    const Table damping = participant.table("damping");
    settings.mass_damping = damping.number("mass", 0.0);
    settings.local_damping = damping.number("local", 0.0);
  }
  return settings;
}

std::optional<int> read_threads(const Table& participant) {
  if (!participant.has("threads") || participant.is_text("threads", "auto"))
    return std::nullopt;
  const std::uint64_t threads = participant.count("threads");
  if (threads > std::numeric_limits<int>::max())
    throw SettingsError("threads", fmt::format("{} threads are too many", threads));
  return static_cast<int>(threads);
}

template Settings<2> read_settings<2>(const Table&, const Mesh<2>&);
template Settings<3> read_settings<3>(const Table&, const Mesh<3>&);

} // namespace kerf::fem
