#include "dem_core/program/stages.hpp"

#include "dem_core/program/read_settings.hpp"
#include "dem_core/program/settings_node.hpp"

#include <spdlog/spdlog.h>

#include <stdexcept>
#include <utility>

namespace kerf::dem {

template <int dim>
Stages<dim>::Stages(const nlohmann::json& table, Engine<dim>& engine,
                    std::vector<Probe<dim>> probes)
    : engine_(engine), probes_(std::move(probes)) {
  const Node node(table, "");
  const Node stages = node["stages"];
  for (std::size_t s = 0; s < stages.size(); ++s) {
    Stage& stage = stages_.emplace_back();
    for (std::size_t k = 0; k < stages[s]["changes"].size(); ++k)
      stage.changes.push_back(read_change<dim>(stages[s]["changes"][k], engine_));
    stage.conditions = read_conditions<dim>(stages[s]["stop"], engine_, probes_);
  }
  conditions_ = read_conditions<dim>(node["stop"], engine_, probes_);
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
    for (Change<dim> change : stages_[s].changes) {
      change.bond_gap.reset(); // bonds are part of the state
      engine_.change(change);
    }
}

template <int dim>
std::optional<Met> Stages<dim>::met(std::size_t stage, std::uint64_t begin) const {
  const std::uint64_t step = engine_.step() - 1; // integrate() has counted it
  if (auto met = find_met<dim>(conditions_, step, 0, engine_, probes_))
    return met;
  if (stage >= stages_.size())
    return std::nullopt;
  return find_met<dim>(stages_[stage].conditions, step, begin, engine_, probes_);
}

template class Stages<2>;
template class Stages<3>;

} // namespace kerf::dem
