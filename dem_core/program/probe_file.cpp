#include "dem_core/program/probe_file.hpp"

#include <array>
#include <string>
#include <vector>

namespace kerf::dem {

namespace {

template <int dim> std::vector<Column> columns() {
  using Names = std::vector<std::string>;
  const Names axes = dim == 2 ? Names{"x", "y"} : Names{"x", "y", "z"};
  const Names pairs =
      dim == 2 ? Names{"xx", "yy", "xy"} : Names{"xx", "yy", "zz", "yz", "xz", "xy"};
  std::vector<Column> columns = {{"step", "1"}, {"time", "s"}, {"particles", "1"}};
  for (const std::string& pair : pairs)
    columns.push_back({"stress_" + pair, "Pa"});
  for (const std::string& pair : pairs)
    columns.push_back({"strain_" + pair, "1"});
  for (const std::string& axis : axes)
    columns.push_back({"velocity_" + axis, "m/s"});
  columns.push_back({"coordination_number", "1"});
  columns.push_back({"solid_fraction", "1"});
  return columns;
}

} // namespace

template <int dim>
ProbeFile<dim>::ProbeFile(const std::filesystem::path& path, const Box<dim>& box,
                          std::uint64_t first_step)
    : box_(box), file_(path, columns<dim>(), first_step) {}

template <int dim>
void ProbeFile<dim>::write(std::uint64_t step, double time, const Engine<dim>& engine) {
  const Reading<dim> reading =
      read_probe(box_, engine.period(), engine.contacts(), engine.particles());
  std::vector<double> row = {static_cast<double>(step), time,
                             static_cast<double>(reading.particles)};
  const auto append = [&](const auto& values) {
    for (const double value : values)
      row.push_back(value);
  };
  append(reading.stress);
  append(reading.strain);
  append(reading.velocity);
  append(std::array{reading.coordination_number, reading.solid_fraction});
  file_.append(row);
}

template class ProbeFile<2>;
template class ProbeFile<3>;

} // namespace kerf::dem
