#include "fem_core/program/read_settings.hpp"

#include "fem_core/program/read_boundary.hpp"
#include "fem_core/program/read_materials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

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

template <int dim> InSituStress<dim> read_in_situ_stress(const Table& table) {
  InSituStress<dim> in_situ;
  if (table.has("stress")) {
    const std::vector<double> stress = table.numbers("stress", Symmetric<double, dim>::size);
    for (std::size_t k = 0; k < stress.size(); ++k)
      in_situ.stress[static_cast<int>(k)] = stress[k];
  }
  if (table.has("K0")) {
    in_situ.K0 = table.number("K0");
    in_situ.surface = table.number("surface");
    in_situ.overburden = table.number("overburden", 0.0);
  }
  return in_situ;
}

/// The velocity ½ V (1 - cos(2 pi t / T)) of the solid, in straight pieces.
TimeTable hann(double velocity, double duration) {
  constexpr int pieces = 256; // which miss the pulse by V (pi / 256)² / 4 = 4e-5 V at most
  std::vector<double> times, values;
  for (int k = 0; k <= pieces; ++k) {
    const double s = std::sin(std::numbers::pi * k / pieces);
    times.push_back(duration * k / pieces);
    values.push_back(k == pieces ? 0.0 : velocity * s * s);
  }
  return TimeTable(std::move(times), std::move(values));
}

template <int dim>
IncomingWave<dim> read_wave(const Table& table, const Mesh<dim>& mesh,
                            const std::string& boundary) {
  IncomingWave<dim> wave;
  wave.direction = table.vector<dim>("direction");
  wave.polarization =
      table.has("polarization") ? table.vector<dim>("polarization") : wave.direction;
  wave.velocity = table.has("velocities")
                      ? table.time_table("velocities")
                      : hann(table.number("velocity"), table.number("duration"));
  if (table.has("origin")) {
    wave.origin = table.vector<dim>("origin");
    return wave;
  }
  const auto nodes = nodes_with_tag(mesh, boundary, table.path("origin"));
  wave.origin = mesh.position(*std::ranges::min_element(
      nodes, {}, [&](std::uint32_t a) { return wave.direction.dot(mesh.position(a)); }));
  return wave;
}

template <int dim> AbsorbingSetting<dim> read_absorbing(const Table& table, const Mesh<dim>& mesh) {
  AbsorbingSetting<dim> setting;
  setting.tag = read_tag(table, mesh);
  if (table.has("wave"))
    setting.wave = read_wave(table.table("wave"), mesh, setting.tag);
  return setting;
}

template <int dim> WallSetting<dim> read_wall(const Table& table, const Mesh<dim>& mesh) {
  WallSetting<dim> wall;
  wall.tag = read_tag(table, mesh);
  wall.point = table.vector<dim>("point");
  wall.normal = table.vector<dim>("normal").stableNormalized(); // zero stays zero
  wall.velocity = table.has("velocities") ? table.time_table("velocities")
                                          : TimeTable(table.number("velocity", 0.0));
  wall.friction = table.number("friction", 0.0);
  return wall;
}

} // namespace

template <int dim> Settings<dim> read_settings(const Table& participant, const Mesh<dim>& mesh) {
  Settings<dim> settings;
  settings.materials = read_materials(participant, mesh);
  settings.plane = read_plane(participant);
  settings.boundary = read_boundary(participant.list("boundary"), mesh);
  for (const Table& table : participant.list("initial"))
    settings.initial.push_back(read_initial<dim>(table));
  settings.loads = read_loads(participant.list("loads"), mesh);
  for (const Table& table : participant.list("absorbing"))
    settings.absorbing.push_back(read_absorbing(table, mesh));
  for (const Table& table : participant.list("walls"))
    settings.walls.push_back(read_wall(table, mesh));
  if (participant.has("in_situ_stress"))
    settings.in_situ_stress = read_in_situ_stress<dim>(participant.table("in_situ_stress"));
  if (participant.has("gravity"))
    settings.gravity = participant.vector<dim>("gravity");
  if (participant.has("damping"))
    std::tie(settings.mass_damping, settings.local_damping, settings.kinetic_damping) =
        read_damping(participant.table("damping"));
  if (participant.has("mass_scaling")) {
    const Table scaling = participant.table("mass_scaling");
    settings.mass_scaling = MassScaling{.critical_step = scaling.number("critical_step", 0.0),
                                        .factor = scaling.number("factor", 1.0)};
  }
  return settings;
}

std::tuple<double, double, bool> read_damping(const Table& damping) {
  return {damping.number("mass", 0.0), damping.number("local", 0.0),
          damping.flag("kinetic", false)};
}

template <int dim> Watch<dim> read_watch(const Table& participant, const Mesh<dim>& mesh) {
  Watch<dim> watch;
  watch.probes = read_probes(participant.list("probes"), mesh);
  for (const Table& wall : participant.list("walls"))
    watch.walls.push_back(wall.text("name"));
  watch.has_stages = !participant.list("stages").empty();
  return watch;
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
template Watch<2> read_watch<2>(const Table&, const Mesh<2>&);
template Watch<3> read_watch<3>(const Table&, const Mesh<3>&);

} // namespace kerf::fem
