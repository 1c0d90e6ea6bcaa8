#include "dem_core/program/dem_output.hpp"

#include "common/stopwatch.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

namespace kerf::dem {

namespace {

template <int dim> std::vector<Column> history_columns() {
  std::vector<Column> columns = {{"step", "1"},
                                 {"time", "s"},
                                 {"kinetic_energy", "J"},
                                 {"elastic_energy", "J"},
                                 {"external_work", "J"},
                                 {"interface_work", "J"},
                                 {"damping_dissipation", "J"},
                                 {"friction_dissipation", "J"},
                                 {"fracture_dissipation", "J"},
                                 {"bonds", "1"},
                                 {"broken_bonds", "1"},
                                 {"momentum_x", "N s"},
                                 {"momentum_y", "N s"}};
  if (dim == 3)
    columns.push_back({"momentum_z", "N s"});
  return columns;
}

/// The numbers of an array of small vectors, which lie one behind the other.
template <class Vector> std::span<const double> flat(const std::vector<Vector>& vectors) {
  static_assert(sizeof(Vector) == Vector::SizeAtCompileTime * sizeof(double));
  if (vectors.empty())
    return {};
  return {vectors.front().data(), vectors.size() * Vector::SizeAtCompileTime};
}

std::vector<std::int64_t> integers(const std::vector<std::uint8_t>& flags) {
  return {flags.begin(), flags.end()};
}

} // namespace

template <int dim>
DemOutput<dim>::DemOutput(Engine<dim>& engine, const std::filesystem::path& run_folder,
                          const std::string& name)
    : engine_(engine), frames_(run_folder, name, dim),
      history_(run_folder / "history" / (name + ".csv"), history_columns<dim>()),
      tools_(engine, run_folder, name) {}

template <int dim> void DemOutput<dim>::write_frame(std::uint64_t step, double time) {
  engine_.compute_own_forces();
  const Stopwatch stopwatch(seconds_);
  const Particles<dim>& p = engine_.particles();
  const Contacts<dim>& c = engine_.contacts();

  std::vector<Vec<dim>> position(p.size());
  std::vector<std::int64_t> id(p.size()), boundary(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    position[i] = p.position(i);
    id[i] = static_cast<std::int64_t>(i);
    boundary[i] = engine_.boundary().of(i) != nullptr ? 1 : 0;
  }
  std::vector<std::uint32_t> pairs;
  for (std::size_t k = 0; k < c.size(); ++k)
    pairs.insert(pairs.end(), {c.first[k], c.second[k]});
  const std::vector<std::int64_t> bonded = integers(c.bonded);
  std::vector<Vec<dim>> tangential_force(c.size());
  for (std::size_t k = 0; k < c.size(); ++k)
    tangential_force[k] = shear_force(c, p, k);
  const auto expanded = [&](const PerContact& constant) {
    std::vector<double> values(c.size());
    for (std::size_t k = 0; k < c.size(); ++k)
      values[k] = constant[k];
    return values;
  };
  const std::vector<double> normal_stiffness = expanded(c.normal_stiffness);
  const std::vector<double> tangential_stiffness = expanded(c.tangential_stiffness);
  const std::vector<double> contact_weight = expanded(c.weight);
  const std::vector<double> weight =
      p.weight.empty() ? std::vector<double>(p.size(), 1.0) : p.weight;

  Grid particles{.name = "particles",
                 .positions = flat(position),
                 .points_of = {},
                 .cells = Cells::points,
                 .connectivity = {},
                 .point_fields = {},
                 .cell_fields = {}};
  particles.point_fields = {{"id", 1, std::span<const std::int64_t>(id)},
                            {"radius", 1, std::span<const double>(p.radius)},
                            {"mass", 1, std::span<const double>(p.mass)},
                            {"displacement", dim, flat(p.displacement)},
                            {"velocity", dim, flat(p.velocity)},
                            {"angular_velocity", rotations<dim>, flat(p.angular_velocity)},
                            {"weight", 1, std::span<const double>(weight)},
                            {"boundary", 1, std::span<const std::int64_t>(boundary)}};
  Grid contacts{.name = "contacts",
                .positions = {},
                .points_of = "particles",
                .cells = Cells::segments,
                .connectivity = pairs,
                .point_fields = {},
                .cell_fields = {}};
  contacts.cell_fields = {
      {"bonded", 1, std::span<const std::int64_t>(bonded)},
      {"normal_force", 1, std::span<const double>(c.normal_force)},
      {"tangential_force", dim, flat(tangential_force)},
      {"normal_stiffness", 1, std::span<const double>(normal_stiffness)},
      {"tangential_stiffness", 1, std::span<const double>(tangential_stiffness)},
      {"weight", 1, std::span<const double>(contact_weight)}};
  std::vector<Grid> grids = {std::move(particles), std::move(contacts)};
  tools_.add_grids(grids);
  frames_.write(step, time, grids);
}

template <int dim> void DemOutput<dim>::write_history(std::uint64_t step, double time) {
  const Stopwatch stopwatch(seconds_);
  if (const auto lost = engine_.first_not_finite())
    throw std::runtime_error(
        fmt::format("particle {} has no finite position or velocity any more at t = {} s (step {})",
                    *lost, time, step));
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
                             static_cast<double>(bonds),
                             static_cast<double>(engine_.bonds_at_start() - bonds)};
  const Vec<dim> momentum = engine_.momentum();
  row.insert(row.end(), momentum.begin(), momentum.end());
  history_.append(row);
  tools_.write_history(step, time);
}

template class DemOutput<2>;
template class DemOutput<3>;

} // namespace kerf::dem
