#include "fem_core/program/set_output.hpp"

#include <string_view>

namespace kerf::fem {
namespace {

template <int dim> constexpr std::string_view axes = std::string_view("xyz").substr(0, dim);

template <int dim> std::vector<Column> boundary_columns() {
  std::vector<Column> columns = {{"step", "1"}, {"time", "s"}, {"boundary", "1"}, {"nodes", "1"}};
  add_axes(columns, "displacement", "m", axes<dim>);
  add_axes(columns, "force", "N", axes<dim>);
  return columns;
}

template <int dim> std::vector<Column> load_columns() {
  std::vector<Column> columns = {{"step", "1"}, {"time", "s"}, {"load", "1"}, {"nodes", "1"}};
  add_axes(columns, "force", "N", axes<dim>);
  return columns;
}

template <int dim> std::vector<Column> wall_columns() {
  std::vector<Column> columns = {{"step", "1"}, {"time", "s"}};
  add_axes(columns, "position", "m", axes<dim>);
  add_axes(columns, "velocity", "m/s", axes<dim>);
  add_axes(columns, "force", "N", axes<dim>);
  return columns;
}

template <int dim> std::vector<Column> probe_columns() {
  std::vector<Column> columns = {{"step", "1"}, {"time", "s"}};
  add_axes(columns, "displacement", "m", axes<dim>);
  add_axes(columns, "velocity", "m/s", axes<dim>);
  for (const char* pair : std::initializer_list<const char*>{"xx", "yy", "zz"})
    columns.push_back({std::string("stress_") + pair, "Pa"});
  if (dim == 3)
    columns.insert(columns.end(), {{"stress_yz", "Pa"}, {"stress_xz", "Pa"}});
  columns.push_back({"stress_xy", "Pa"});
  return columns;
}

template <class Vector> void append(std::vector<double>& row, const Vector& vector) {
  for (const double value : vector)
    row.push_back(value);
}

} // namespace

template <int dim>
SetOutput<dim>::SetOutput(const Engine<dim>& engine, const Watch<dim>& watch,
                          const std::filesystem::path& run_folder, const std::string& participant)
    : engine_(engine), watch_(watch) {
  const auto file = [&](const std::string& what, std::vector<Column> columns) {
    return History(run_folder / "history" / (participant + "_" + what + ".csv"), std::move(columns),
                   engine.step());
  };
  if (watch_.has_stages || !engine.settings().boundary.empty()) // which a stage may bring
    boundary_.emplace(file("boundary", boundary_columns<dim>()));
  if (watch_.has_stages || !engine.settings().loads.empty())
    loads_.emplace(file("loads", load_columns<dim>()));
  for (const std::string& wall : watch_.walls)
    walls_.push_back(file(wall, wall_columns<dim>()));
  for (const Probe<dim>& probe : watch_.probes)
    probes_.push_back(file(probe.name, probe_columns<dim>()));
}

template <int dim> void SetOutput<dim>::write_history(std::uint64_t step, double time) {
  if (!engine_.settings().loads.empty())
    write_loads(step, time);
  write_walls(step, time);
  if (engine_.settings().boundary.empty() && probes_.empty())
    return;
  const std::vector<double> u = displacement_of_step(engine_, watch_.time_step),
                            v = engine_.velocity();
  if (!engine_.settings().boundary.empty())
    write_boundary(step, time, u);
  for (std::size_t k = 0; k < probes_.size(); ++k) {
    const Probe<dim>& probe = watch_.probes[k];
    std::vector<double> row = {static_cast<double>(step), time};
    append(row, at_probe<dim>(probe, engine_.mesh(), u));
    append(row, at_probe<dim>(probe, engine_.mesh(), v));
    append(row, std::span<const double>(stress_at(probe, engine_).c));
    probes_[k].append(row);
  }
}

template <int dim>
void SetOutput<dim>::write_boundary(std::uint64_t step, double time,
                                    std::span<const double> displacement) {
  const std::size_t size = engine_.settings().boundary.size();
  constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> last(size, none); // entries ascend by node
  std::vector<double> count(size, 0.0);
  std::vector<Vec<dim>> sum(size, Vec<dim>::Zero());
  for (const Prescribed& entry : engine_.boundary().entries())
    if (const std::size_t k = engine_.boundary().setting_of(entry); last[k] != entry.node) {
      last[k] = entry.node;
      count[k] += 1.0;
      sum[k] += Eigen::Map<const Vec<dim>>(&displacement[std::size_t{entry.node} * dim]);
    }
  for (std::size_t k = 0; k < size; ++k) {
    std::vector<double> row = {static_cast<double>(step), time, static_cast<double>(k), count[k]};
    append(row, Vec<dim>(sum[k] / count[k]));
    append(row, engine_.reaction(k));
    boundary_->append(row);
  }
}

template <int dim> void SetOutput<dim>::write_loads(std::uint64_t step, double time) {
  for (std::size_t k = 0; k < engine_.settings().loads.size(); ++k) {
    std::vector<double> row = {static_cast<double>(step), time, static_cast<double>(k),
                               static_cast<double>(engine_.loads().num_nodes(k))};
    append(row, engine_.load(k));
    loads_->append(row);
  }
}

template <int dim> void SetOutput<dim>::write_walls(std::uint64_t step, double time) {
  for (std::size_t k = 0; k < walls_.size(); ++k) {
    const WallSetting<dim>& wall = engine_.settings().walls[k];
    std::vector<double> row = {static_cast<double>(step), time};
    append(row, Vec<dim>(wall.point + wall.velocity.integral(time) * wall.normal));
    append(row, Vec<dim>(wall.velocity.mean(time, time + watch_.time_step) * wall.normal));
    append(row, Vec<dim>(Vec<dim>::Zero() - engine_.wall_force(k))); // and no -0
    walls_[k].append(row);
  }
}

template class SetOutput<2>;
template class SetOutput<3>;

} // namespace kerf::fem
