#include "fem_core/program/output.hpp"

#include "common/checkpoint.hpp"
#include "common/stopwatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace kerf::fem {
namespace {

template <int dim> std::vector<Column> history_columns() {
  std::vector<Column> columns = {{"step", "1"},           {"time", "s"},
                                 {"kinetic_energy", "J"}, {"elastic_energy", "J"},
                                 {"external_work", "J"},  {"interface_work", "J"}};
  for (int axis = 0; axis < dim; ++axis)
    columns.push_back({fmt::format("momentum_{}", "xyz"[axis]), "N s"});
  return columns;
}

/// The node with the largest component of a velocity [num_nodes][dim].
template <int dim> std::size_t fastest_node(std::span<const double> velocity) {
  const auto fastest = std::max_element(velocity.begin(), velocity.end(), [](double a, double b) {
    return std::abs(a) < std::abs(b);
  });
  return static_cast<std::size_t>(fastest - velocity.begin()) / dim;
}

/// A stress in Voigt's order: xx, yy, xy; or xx, yy, zz, yz, xz, xy.
template <int dim> void append_voigt(const Tensor<dim>& stress, std::vector<double>& out) {
  for (int i = 0; i < dim; ++i)
    out.push_back(stress(i, i));
  if constexpr (dim == 3) {
    out.push_back(stress(1, 2));
    out.push_back(stress(0, 2));
  }
  out.push_back(stress(0, 1));
}

} // namespace

template <int dim>
Output<dim>::Output(const Engine<dim>& engine, std::vector<double> alpha,
                    const std::filesystem::path& run_folder, const std::string& participant)
    : engine_(engine), alpha_(std::move(alpha)), ids_(engine.mesh().num_nodes()),
      frames_(run_folder, participant, dim, engine.step()),
      history_(run_folder / "history" / (participant + ".csv"), history_columns<dim>(),
               engine.step()) {
  if (alpha_.empty())
    alpha_.assign(ids_.size(), 1.0);
  std::iota(ids_.begin(), ids_.end(), 0);
}

template <int dim> void Output<dim>::write_frame(std::uint64_t step, double time) {
  const Stopwatch stopwatch(seconds_);
  check_finite(step, time);
  const Mesh<dim>& mesh = engine_.mesh();
  const Elements<dim>& elements = engine_.elements();
  const std::span<const double> u = engine_.displacement();

  std::vector<double> position(mesh.positions);
  for (std::size_t dof = 0; dof < position.size(); ++dof)
    position[dof] += u[dof];

  // Elements that were left out keep their cells, without energy or stress.
  constexpr std::size_t stress_components = dim == 2 ? 3 : 6;
  std::vector<double> energy(mesh.num_elements(), 0.0);
  std::vector<double> stress;
  stress.reserve(mesh.num_elements() * stress_components);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    stress.resize(elements.number[e] * stress_components, 0.0);
    energy[elements.number[e]] = element_energy(elements, engine_.material(), u, e);
    append_voigt<dim>(element_stress(elements, engine_.material(), u, e), stress);
  }
  stress.resize(mesh.num_elements() * stress_components, 0.0);

  const Grid grid{.name = "mesh",
                  .positions = position,
                  .points_of = {},
                  .cells = dim == 2 ? Cells::quads : Cells::hexes,
                  .connectivity = mesh.elements,
                  .point_fields = {{"id", 1, std::span<const std::int64_t>(ids_)},
                                   {"displacement", dim, u},
                                   {"velocity", dim, engine_.velocity()},
                                   {"mass", 1, engine_.mass()},
                                   {"alpha", 1, std::span<const double>(alpha_)}},
                  .cell_fields = {{"elastic_energy", 1, std::span<const double>(energy)},
                                  {"stress", stress_components, std::span<const double>(stress)}}};
  frames_.write(step, time, std::span(&grid, 1));
}

template <int dim> void Output<dim>::write_history(std::uint64_t step, double time) {
  const Stopwatch stopwatch(seconds_);
  check_finite(step, time);
  const Energies energies = engine_.energies();
  const Vec<dim> momentum = engine_.momentum();
  std::vector<double> row = {static_cast<double>(step), time,
                             energies.kinetic,          energies.elastic,
                             energies.external_work,    energies.interface_work};
  row.insert(row.end(), momentum.begin(), momentum.end());
  if (!std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); }))
    throw std::runtime_error(
        fmt::format("the energies are not finite numbers at t = {} s (step {}); node {} is fastest",
                    time, step, fastest_node<dim>(engine_.velocity())));
  history_.append(row);
}

template <int dim> void Output<dim>::write_checkpoint(const std::filesystem::path& file) {
  const Stopwatch stopwatch(seconds_);
  kerf::write_checkpoint(file, {checkpoint_writer, engine_.step(), engine_.state()});
}

template <int dim> void Output<dim>::check_finite(std::uint64_t step, double time) const {
  if (const auto node = engine_.first_non_finite())
    throw std::runtime_error(fmt::format(
        "the motion of node {} is not a finite number at t = {} s (step {})", *node, time, step));
}

template class Output<2>;
template class Output<3>;

} // namespace kerf::fem
