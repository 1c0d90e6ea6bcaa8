#include "fem_core/program/output.hpp"

#include "common/checkpoint.hpp"
#include "common/stopwatch.hpp"
#include "fem_core/program/nodal_stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

namespace kerf::fem {
namespace {

template <int dim> std::vector<Column> history_columns(bool has_stages) {
  std::vector<Column> columns = {{"step", "1"},
                                 {"time", "s"},
                                 {"kinetic_energy", "J"},
                                 {"elastic_energy", "J"},
                                 {"hourglass_energy", "J"},
                                 {"plastic_dissipation", "J"},
                                 {"damping_dissipation", "J"},
                                 {"external_work", "J"},
                                 {"interface_work", "J"},
                                 {"unbalanced_force", "1"}};
  add_axes(columns, "momentum", "N s", std::string_view("xyz").substr(0, dim));
  if (has_stages)
    columns.push_back({"stage", "1"});
  return columns;
}

/// The node with the largest component of a velocity [num_nodes][dim].
template <int dim> std::size_t fastest_node(std::span<const double> velocity) {
  const auto fastest = std::max_element(velocity.begin(), velocity.end(), [](double a, double b) {
    return std::abs(a) < std::abs(b);
  });
  return static_cast<std::size_t>(fastest - velocity.begin()) / dim;
}

Cells cells_of(Shape shape) {
  switch (shape) {
  case Shape::tri3:
    return Cells::triangles;
  case Shape::quad4:
    return Cells::quads;
  case Shape::tet4:
    return Cells::tetrahedra;
  case Shape::hex8:
    break;
  }
  return Cells::hexes;
}

} // namespace

template <int dim>
Output<dim>::Output(const Engine<dim>& engine, Guard<dim> guard, const Watch<dim>& watch,
                    std::vector<double> alpha, const std::filesystem::path& run_folder,
                    const std::string& participant)
    : engine_(engine), guard_(std::move(guard)), time_step_(watch.time_step),
      stage_(watch.has_stages ? std::optional<std::size_t>(0) : std::nullopt),
      alpha_(std::move(alpha)), ids_(engine.mesh().num_nodes()),
      frames_(run_folder, participant, dim, engine.step()),
      history_(run_folder / "history" / (participant + ".csv"),
               history_columns<dim>(watch.has_stages), engine.step()),
      sets_(engine, watch, run_folder, participant) {
  if (alpha_.empty())
    alpha_.assign(ids_.size(), 1.0);
  std::iota(ids_.begin(), ids_.end(), 0);
}

template <int dim> void Output<dim>::look() {
  const Stopwatch stopwatch(seconds_);
  try {
    guard_.look();
  } catch (const LostBody&) {
    const std::uint64_t good = engine_.step();
    if (last_frame_.value_or(0) < good && !engine_.first_non_finite())
      write_state(good, static_cast<double>(good) * time_step_);
    throw;
  }
}

template <int dim> void Output<dim>::write_frame(std::uint64_t step, double time) {
  look();
  const Stopwatch stopwatch(seconds_);
  write_state(step, time);
}

template <int dim> void Output<dim>::write_state(std::uint64_t step, double time) {
  const Mesh<dim>& mesh = engine_.mesh();
  const std::vector<double> u = engine_.displacement(), v = engine_.velocity(),
                            mass = engine_.mass(), since_reset = engine_.displacement_since_reset();

  std::vector<double> position(mesh.positions);
  for (std::size_t dof = 0; dof < position.size(); ++dof)
    position[dof] += u[dof];

  // Elements that were left out keep their cells, without energy or stress.
  constexpr std::size_t components = Symmetric<double, dim>::size;
  std::vector<double> energy(mesh.num_elements(), 0.0);
  std::vector<double> stress(mesh.num_elements() * components, 0.0);
  std::map<std::string, std::vector<double>> history;
  for (const std::uint32_t e : engine_.active_elements()) {
    const ElementState<dim> state = engine_.element_state(e);
    energy[e] = state.energy;
    std::copy_n(state.stress.c, components, stress.begin() + e * components);
    const Material& material = engine_.settings().materials[engine_.material_of(e)].material;
    const auto names = history_of(material, engine_.settings().plane);
    for (std::size_t k = 0; k < state.history.size(); ++k)
      history.try_emplace(names[k].name, mesh.num_elements(), 0.0).first->second[e] =
          state.history[k];
  }

  const std::vector<NodalStress> nodal_stress = stress_at_nodes<dim>(engine_, stress);

  // A grid for the elements of each shape; all have all the points.
  std::vector<Grid> grids;
  std::size_t first = 0;
  for (const Block& block : mesh.blocks) {
    const auto part = [&](const std::vector<double>& values, std::size_t columns) {
      return std::span<const double>(values).subspan(first * columns, block.size() * columns);
    };
    Grid& grid = grids.emplace_back(Grid{
        .name = mesh.blocks.size() == 1 ? "mesh" : fmt::format("mesh_{}", name_of(block.shape)),
        .positions = position,
        .points_of = {},
        .cells = cells_of(block.shape),
        .connectivity = block.nodes,
        .point_fields = {{"id", 1, std::span<const std::int64_t>(ids_)},
                         {"displacement", dim, std::span<const double>(u)},
                         {"velocity", dim, std::span<const double>(v)},
                         {"mass", 1, std::span<const double>(mass)},
                         {"alpha", 1, std::span<const double>(alpha_)}},
        .cell_fields = {{"elastic_energy", 1, part(energy, 1)},
                        {"stress", components, part(stress, components)}}});
    if (stage_)
      grid.point_fields.push_back(
          {"displacement_since_reset", dim, std::span<const double>(since_reset)});
    for (const auto& [name, values] : nodal_stress)
      grid.point_fields.push_back({name, components, std::span<const double>(values)});
    for (const auto& [name, values] : history)
      grid.cell_fields.push_back({name, 1, part(values, 1)});
    first += block.size();
  }
  frames_.write(step, time, grids);
  last_frame_ = step;
}

template <int dim> void Output<dim>::write_history(std::uint64_t step, double time) {
  if (engine_.first_non_finite())
    look();
  const Stopwatch stopwatch(seconds_);
  const Energies energies = engine_.energies();
  const Vec<dim> momentum = engine_.momentum();
  std::vector<double> row = {static_cast<double>(step), time,
                             energies.kinetic,          energies.elastic,
                             energies.hourglass,        energies.dissipated,
                             energies.damped,           energies.external_work,
                             energies.interface_work,   engine_.unbalanced_force()};
  row.insert(row.end(), momentum.begin(), momentum.end());
  if (!std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); }))
    throw std::runtime_error(
        fmt::format("the energies are not finite numbers at t = {} s (step {}); node {} is fastest",
                    time, step, fastest_node<dim>(engine_.velocity())));
  if (stage_)
    row.push_back(static_cast<double>(*stage_));
  history_.append(row);
  sets_.write_history(step, time);
}

template <int dim> void Output<dim>::write_checkpoint(const std::filesystem::path& file) {
  const Stopwatch stopwatch(seconds_);
  kerf::write_checkpoint(file, {checkpoint_writer, engine_.step(), engine_.state()});
}

template class Output<2>;
template class Output<3>;

} // namespace kerf::fem
