#include "fem_core/program/stages.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/program/read_boundary.hpp"
#include "fem_core/program/read_settings.hpp"

#include <spdlog/spdlog.h>

#include <tuple>

namespace kerf::fem {
namespace {

template <int dim> Change<dim> read_change(const Table& table, const Mesh<dim>& mesh) {
  Change<dim> change;
  if (table.has("gravity"))
    change.gravity = table.vector<dim>("gravity");
  if (table.has("damping"))
    std::tie(change.mass_damping, change.local_damping, change.kinetic_damping) =
        read_damping(table.table("damping"));
  if (const std::vector<Table> list = table.list("boundary");
      !list.empty() || table.flag("release", false))
    change.boundary = read_boundary(list, mesh);
  if (const std::vector<Table> list = table.list("loads");
      !list.empty() || table.flag("unload", false))
    change.loads = read_loads(list, mesh);
  if (table.has("remove"))
    change.remove = table.texts("remove");
  for (const std::string& region : change.remove)
    check_region(mesh, region, table.path("remove"));
  change.reset_displacement = table.flag("reset_displacement", false);
  return change;
}

std::vector<Table> of_participant(const std::vector<Table>& list, const std::string& name) {
  std::vector<Table> own;
  for (const Table& table : list)
    if (!table.has("participant") || table.is_text("participant", name))
      own.push_back(table);
  return own;
}

/// What the engine would refuse in the middle of the run is refused before it.
template <int dim> void check(const Change<dim>& change, const Engine<dim>& engine) {
  if (change.boundary)
    Boundary<dim>(engine.mesh(), *change.boundary);
  if (change.loads)
    Loads<dim>(engine.mesh(), *change.loads,
               engine.settings().plane == Plane::axisymmetric ? Space::axisymmetric : Space::plane);
}

} // namespace

template <int dim>
Stages<dim>::Stages(const Table& participant, const std::string& name, Engine<dim>& engine,
                    const Watch<dim>& watch)
    : engine_(engine) {
  for (const Table& table : participant.list("stages")) {
    Stage& stage = stages_.emplace_back();
    for (const Table& change : of_participant(table.list("changes"), name))
      try {
        stage.changes.push_back(read_change(change, engine.mesh()));
        check(stage.changes.back(), engine);
      } catch (const InputError& error) {
        throw coupler::SettingsError(change.path(error.key()), error.what());
      }
    stage.conditions = read_conditions(of_participant(table.list("stop"), name), watch);
  }
  conditions_ = read_conditions(of_participant(participant.list("stop"), name), watch);
}

template <int dim> void Stages<dim>::begin(std::size_t stage) {
  if (stage >= stages_.size())
    return;
  spdlog::info("stage {} begins at step {}", stage, engine_.step());
  for (const Change<dim>& change : stages_[stage].changes)
    engine_.change(change);
}

template <int dim> void Stages<dim>::adopt(std::size_t stage) {
  for (std::size_t s = 0; s < stages_.size() && s <= stage; ++s)
    for (const Change<dim>& change : stages_[s].changes)
      engine_.change(change);
}

template <int dim>
std::optional<Met> Stages<dim>::met(std::size_t stage, std::uint64_t begin,
                                    const Watch<dim>& watch) const {
  const std::uint64_t step = engine_.step() - 1; // integrate() has counted it
  const auto find = [&](std::span<const Condition> conditions, std::uint64_t first) {
    return find_met(conditions, step, first, watch.time_step,
                    [&](const Condition& c) { return value_of(c, engine_, watch); });
  };
  if (auto met = find(conditions_, 0))
    return met;
  return stage < stages_.size() ? find(stages_[stage].conditions, begin) : std::nullopt;
}

template class Stages<2>;
template class Stages<3>;

} // namespace kerf::fem
