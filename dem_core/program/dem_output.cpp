#include "dem_core/program/dem_output.hpp"

#include "common/checkpoint.hpp"
#include "common/stopwatch.hpp"
#include "dem_core/balance.hpp"
#include "dem_core/program/dem_frame.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

namespace kerf::dem {

namespace {

template <int dim> std::vector<Column> history_columns(bool has_stages) {
  std::vector<Column> columns = {{"step", "1"},
                                 {"time", "s"},
                                 {"kinetic_energy", "J"},
                                 {"elastic_energy", "J"},
                                 {"external_work", "J"},
                                 {"interface_work", "J"},
                                 {"damping_dissipation", "J"},
                                 {"friction_dissipation", "J"},
                                 {"fracture_dissipation", "J"},
                                 {"particles", "1"},
                                 {"bonds", "1"},
                                 {"broken_bonds", "1"},
                                 {"tension_cracks", "1"},
                                 {"shear_cracks", "1"},
                                 {"fragments", "1"},
                                 {"largest_fragment", "1"},
                                 {"unbalanced_force", "1"},
                                 {"kinetic_ratio", "1"},
                                 {"momentum_x", "N s"},
                                 {"momentum_y", "N s"}};
  if (dim == 3)
    columns.push_back({"momentum_z", "N s"});
  if (has_stages)
    columns.push_back({"stage", "1"});
  return columns;
}

} // namespace

template <int dim>
DemOutput<dim>::DemOutput(Engine<dim>& engine, const Watch<dim>& watch,
                          const std::filesystem::path& run_folder, const std::string& name)
    : engine_(engine), frames_(run_folder, name, dim, engine.step()),
      history_(run_folder / "history" / (name + ".csv"), history_columns<dim>(watch.has_stages),
               engine.step()),
      cracks_(run_folder / "history" / (name + "_cracks.csv"), engine.step(), engine.cracks()),
      tools_(engine, run_folder, name), sets_(engine, watch.has_stages, run_folder, name),
      domain_(watch.domain),
      stage_(watch.has_stages ? std::optional<std::size_t>(0) : std::nullopt),
      fragments_(find_fragments(engine.contacts(), engine.particles())) {
  for (const Probe<dim>& probe : watch.probes)
    probes_.emplace_back(run_folder / "history" / (name + "_" + probe.name + ".csv"), probe.box,
                         engine.step());
}

template <int dim> void DemOutput<dim>::write_frame(std::uint64_t step, double time) {
  engine_.compute_own_forces();
  write_cracks();
  check(step, time);
  const Stopwatch stopwatch(seconds_);
  std::vector<Grid> tools;
  tools_.add_grids(tools);
  write_dem_frame(frames_, step, time, engine_, fragments(), tools);
}

template <int dim> void DemOutput<dim>::write_history(std::uint64_t step, double time) {
  check(step, time);
  const Stopwatch stopwatch(seconds_);
  const Energies e = engine_.energies();
  const std::size_t bonds = engine_.bonds();
  std::vector<double> row = {static_cast<double>(step),
                             time,
                             e.kinetic,
                             e.elastic,
                             e.external_work,
                             e.interface_work,
                             e.damping_dissipation,
                             e.friction_dissipation,
                             e.fracture_dissipation,
                             static_cast<double>(engine_.size()),
                             static_cast<double>(bonds),
                             static_cast<double>(engine_.bonds_at_start() - bonds),
                             static_cast<double>(cracks_.tension()),
                             static_cast<double>(cracks_.shear()),
                             static_cast<double>(fragments().count()),
                             fragments().largest_share(),
                             engine_.unbalanced_force(),
                             kinetic_ratio(e)};
  const Vec<dim> momentum = engine_.momentum();
  row.insert(row.end(), momentum.begin(), momentum.end());
  if (stage_)
    row.push_back(static_cast<double>(*stage_));
  history_.append(row);
  tools_.write_history(step, time);
  sets_.write_history(step, time);
  for (ProbeFile<dim>& probe : probes_)
    probe.write(step, time, engine_);
}

template <int dim> void DemOutput<dim>::write_cracks() {
  const Stopwatch stopwatch(seconds_);
  cracks_.write(engine_.cracks(), engine_.particles().ids);
}

template <int dim> void DemOutput<dim>::write_checkpoint(const std::filesystem::path& file) {
  const Stopwatch stopwatch(seconds_);
  kerf::write_checkpoint(file, {checkpoint_writer, engine_.step(), engine_.state()});
}

template <int dim> void DemOutput<dim>::check(std::uint64_t step, double time) const {
  if (const auto lost = engine_.first_not_finite())
    throw std::runtime_error(
        fmt::format("particle {} has no finite position or velocity any more at t = {} s (step {})",
                    engine_.particles().ids[*lost], time, step));
  if (!domain_)
    return;
  if (const auto outside = engine_.first_outside(*domain_)) {
    const Vec<dim> x = engine_.particles().position(*outside);
    throw std::runtime_error(fmt::format("particle {} has left the domain at t = {} s (step {}): "
                                         "it is at ({:.6g}) m",
                                         engine_.particles().ids[*outside], time, step,
                                         fmt::join(x.begin(), x.end(), ", ")));
  }
}

/// They change with the bonds only.
template <int dim> const Fragments& DemOutput<dim>::fragments() {
  const std::pair bonds{engine_.cracks().size(), engine_.bonds_at_start()};
  if (bonds_of_fragments_ != bonds) {
    fragments_ = find_fragments(engine_.contacts(), engine_.particles());
    bonds_of_fragments_ = bonds;
  }
  return fragments_;
}

template class DemOutput<2>;
template class DemOutput<3>;

} // namespace kerf::dem
