#include "dem_core/program/set_output.hpp"

#include <array>
#include <string_view>
#include <vector>

namespace kerf::dem {

namespace {

template <int dim> std::vector<Column> boundary_columns() {
  const std::string_view axes = std::string_view("xyz").substr(0, dim);
  std::vector<Column> columns = {
      {"step", "1"}, {"time", "s"}, {"boundary", "1"}, {"particles", "1"}};
  add_axes(columns, "displacement", "m", axes);
  add_axes(columns, "force", "N", axes);
  add_axes(columns, "moment", "N m", dim == 2 ? "z" : "xyz");
  columns.insert(columns.end(), {{"power", "W"}, {"work", "J"}});
  return columns;
}

template <int dim> std::vector<Column> load_columns() {
  std::vector<Column> columns = {{"step", "1"}, {"time", "s"}, {"load", "1"}, {"particles", "1"}};
  add_axes(columns, "force", "N", std::string_view("xyz").substr(0, dim));
  columns.insert(columns.end(), {{"power", "W"}, {"work", "J"}});
  return columns;
}

template <int dim> std::vector<Column> cluster_columns() {
  const std::string_view axes = std::string_view("xyz").substr(0, dim);
  const std::string_view turns = dim == 2 ? "z" : "xyz";
  std::vector<Column> columns = {
      {"step", "1"}, {"time", "s"}, {"cluster", "1"}, {"particles", "1"}};
  add_axes(columns, "position", "m", axes);
  add_axes(columns, "velocity", "m/s", axes);
  add_axes(columns, "angular_velocity", "rad/s", turns);
  add_axes(columns, "force", "N", axes);
  add_axes(columns, "moment", "N m", turns);
  columns.insert(columns.end(), {{"power", "W"}, {"work", "J"}});
  return columns;
}

std::vector<double> begin_row(std::uint64_t step, double time, std::size_t set,
                              std::size_t particles) {
  return {static_cast<double>(step), time, static_cast<double>(set),
          static_cast<double>(particles)};
}

template <class Vector> void append(std::vector<double>& row, const Vector& vector) {
  for (const double value : vector)
    row.push_back(value);
}

} // namespace

template <int dim>
SetOutput<dim>::SetOutput(const Engine<dim>& engine, bool has_stages,
                          const std::filesystem::path& run_folder, const std::string& participant)
    : engine_(engine) {
  const auto file = [&](const char* what) {
    return run_folder / "history" / (participant + "_" + what + ".csv");
  };
  if (has_stages || !engine.boundary().sets().empty()) // which a stage may bring
    boundary_.emplace(file("boundary"), boundary_columns<dim>(), engine.step());
  if (engine.applied_forces().size() > 0)
    loads_.emplace(file("loads"), load_columns<dim>(), engine.step());
  if (engine.clusters().size() > 0)
    clusters_.emplace(file("clusters"), cluster_columns<dim>(), engine.step());
}

template <int dim> void SetOutput<dim>::write_history(std::uint64_t step, double time) {
  for (std::size_t k = 0; k < engine_.boundary().sets().size(); ++k) {
    const Reaction<dim> reaction = engine_.reaction(k);
    const RunningWork& work = engine_.reactions().work_of(k);
    auto row = begin_row(step, time, k, engine_.boundary().sets()[k].particles.size());
    append(row, reaction.displacement);
    append(row, reaction.force);
    append(row, reaction.moment);
    append(row, std::array{work.power(), work.work()});
    boundary_->append(row);
  }
  for (std::size_t k = 0; k < engine_.applied_forces().size(); ++k) {
    const RunningWork& work = engine_.applied_forces().work_of(k);
    auto row = begin_row(step, time, k, engine_.applied_forces().particles(k).size());
    append(row, engine_.applied_forces().total(k, time));
    append(row, std::array{work.power(), work.work()});
    loads_->append(row);
  }
  for (std::size_t k = 0; k < engine_.clusters().size(); ++k) {
    const Cluster<dim>& cluster = engine_.clusters().all()[k];
    auto row = begin_row(step, time, k, cluster.members.size());
    append(row, Vec<dim>(cluster.start + cluster.displacement_before));
    append(row, cluster.velocity);
    append(row, cluster.rate);
    append(row, cluster.load.force);
    append(row, cluster.load.moment);
    append(row, std::array{cluster.load_work.power(), cluster.load_work.work()});
    clusters_->append(row);
  }
}

template class SetOutput<2>;
template class SetOutput<3>;

} // namespace kerf::dem
