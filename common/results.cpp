#include "common/results.hpp"

#include "common/atomic_file.hpp"
#include "common/hdf5_handle.hpp"
#include "common/results_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace kerf {
namespace {

using hdf5::Handle;

std::size_t size_of(const Field& field) {
  return std::visit([](const auto& data) { return data.size(); }, field.data);
}

void check_fields(const Grid& grid, const std::vector<Field>& fields, std::size_t count) {
  for (const Field& field : fields)
    if (field.components == 0 || size_of(field) != count * field.components)
      throw std::invalid_argument(fmt::format("{}/{} has {} values; {} x {} are needed", grid.name,
                                              field.name, size_of(field), count, field.components));
}

/// @throws std::invalid_argument when an array does not fit its grid
std::vector<Layout> check_grids(std::span<const Grid> grids, std::size_t dimension) {
  std::vector<Layout> layouts;
  for (const Grid& grid : grids) {
    Layout layout{&grid, grid.name + "/position", grid.positions.size() / dimension, 0,
                  points_per_cell(grid.cells)};
    if (grid.positions.size() % dimension != 0)
      throw std::invalid_argument(grid.name + ": positions are not whole points");
    if (!grid.points_of.empty()) {
      const auto owner = std::find_if(layouts.begin(), layouts.end(), [&](const Layout& other) {
        return other.grid->name == grid.points_of;
      });
      if (owner == layouts.end() || !grid.positions.empty())
        throw std::invalid_argument(
            fmt::format("{} cannot use the points of {}", grid.name, grid.points_of));
      layout.position = owner->position;
      layout.num_points = owner->num_points;
    }
    const bool has_cells = grid.cells != Cells::points;
    if ((!has_cells && !grid.connectivity.empty()) ||
        grid.connectivity.size() % layout.corners != 0)
      throw std::invalid_argument(grid.name + ": the connectivity does not fit the kind of cells");
    layout.num_cells = has_cells ? grid.connectivity.size() / layout.corners : layout.num_points;
    for (const std::uint32_t point : grid.connectivity)
      if (point >= layout.num_points)
        throw std::invalid_argument(
            fmt::format("{}: a cell has point {} of {}", grid.name, point, layout.num_points));
    check_fields(grid, grid.point_fields, layout.num_points);
    check_fields(grid, grid.cell_fields, layout.num_cells);
    layouts.push_back(layout);
  }
  return layouts;
}

/// A property list under which HDF5 notes no times, so that equal data give equal files.
Handle without_times(hid_t kind) {
  Handle list(H5Pcreate(kind), H5Pclose, "cannot make an HDF5 property list");
  hdf5::check(H5Pset_obj_track_times(list, false), "cannot switch off the times of HDF5");
  return list;
}

/// Writes [rows][columns], or [rows] for one column.
void write_array(hid_t file, const std::string& name, std::size_t rows, std::size_t columns,
                 hid_t memory_type, hid_t file_type, const void* data) {
  const std::string what = "cannot write the data set " + name;
  const hsize_t extent[] = {rows, columns};
  const Handle properties = without_times(H5P_DATASET_CREATE);
  const Handle space(H5Screate_simple(columns == 1 ? 1 : 2, extent, nullptr), H5Sclose, what);
  const Handle set(
      H5Dcreate2(file, name.c_str(), file_type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
      H5Dclose, what);
  if (rows != 0)
    hdf5::check(H5Dwrite(set, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), what);
}

void write_array(hid_t file, const std::string& name, std::size_t columns,
                 std::span<const double> data) {
  write_array(file, name, data.size() / columns, columns, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE,
              data.data());
}

void write_array(hid_t file, const std::string& name, std::size_t columns,
                 std::span<const std::int64_t> data) {
  write_array(file, name, data.size() / columns, columns, H5T_NATIVE_INT64, H5T_STD_I64LE,
              data.data());
}

/// Vectors of a plane with a third component of zero.
template <class Number> std::vector<Number> padded(std::span<const Number> vectors) {
  std::vector<Number> result;
  result.reserve(vectors.size() / 2 * 3);
  for (std::size_t i = 0; i < vectors.size(); i += 2)
    result.insert(result.end(), {vectors[i], vectors[i + 1], Number{}});
  return result;
}

/// @param dimension  of the case; in 2D what has two components is a vector
template <class Number>
void write_field(hid_t group, const std::string& name, std::size_t components,
                 std::span<const Number> data, std::size_t dimension) {
  if (components == 2 && dimension == 2)
    write_array(group, name, 3, std::span<const Number>(padded(data)));
  else
    write_array(group, name, components, data);
}

/// Viewers want cells for points too: one for each.
void write_cells(hid_t group, const Layout& layout) {
  std::vector<std::uint32_t> cells(layout.grid->connectivity.begin(),
                                   layout.grid->connectivity.end());
  if (layout.grid->cells == Cells::points) {
    cells.resize(layout.num_points);
    std::iota(cells.begin(), cells.end(), 0U);
  }
  write_array(group, "cells", layout.num_cells, layout.corners, H5T_NATIVE_UINT32, H5T_STD_U32LE,
              cells.data());
}

void write_frame(const std::filesystem::path& path, std::uint64_t step, double time,
                 const std::vector<Layout>& layouts, std::size_t dimension) {
  const std::string what = "cannot write " + path.string();
  const hdf5::Library library;
  const Handle file_properties = without_times(H5P_FILE_CREATE);
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, file_properties, H5P_DEFAULT), H5Fclose, what);
  const auto whole_step = static_cast<std::int64_t>(step);
  write_array(file, "step", 1, std::span(&whole_step, 1));
  write_array(file, "time", 1, std::span<const double>(&time, 1));
  for (const Layout& layout : layouts) {
    const Grid& grid = *layout.grid;
    const Handle group_properties = without_times(H5P_GROUP_CREATE);
    const Handle group(
        H5Gcreate2(file, grid.name.c_str(), H5P_DEFAULT, group_properties, H5P_DEFAULT), H5Gclose,
        what);
    if (grid.points_of.empty())
      write_field(group, "position", dimension, grid.positions, dimension);
    write_cells(group, layout);
    for (const std::vector<Field>* fields : {&grid.point_fields, &grid.cell_fields})
      for (const Field& field : *fields)
        std::visit(
            [&](const auto& data) {
              write_field(group, field.name, field.components, data, dimension);
            },
            field.data);
  }
  file.close(what);
}

} // namespace

FrameWriter::FrameWriter(std::filesystem::path run_folder, std::string participant, int dimension,
                         std::uint64_t first_step)
    : run_folder_(std::move(run_folder)), participant_(std::move(participant)),
      dimension_(static_cast<std::size_t>(dimension)) {
  if (dimension != 2 && dimension != 3)
    throw std::invalid_argument(fmt::format("a frame has 2 or 3 dimensions, not {}", dimension));
  if (first_step != 0)
    cut(first_step);
}

void FrameWriter::cut(std::uint64_t first_step) {
  std::ifstream file(run_folder_ / (participant_ + ".xdmf"), std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  entries_ = read_index(text.str());
  if (entries_.empty()) // the run writes no frames
    return;
  entries_.erase(entries_.lower_bound(first_step), entries_.end());
  write_index();
  for (const FrameFile& frame : list_frames(run_folder_, participant_))
    if (frame.step >= first_step)
      std::filesystem::remove(frame.path);
}

void FrameWriter::write(std::uint64_t step, double time, std::span<const Grid> grids) {
  const std::vector<Layout> layouts = check_grids(grids, dimension_);
  const std::string file = fmt::format("frames/{}_{:09}.h5", participant_, step);
  write_atomically(run_folder_ / file, [&](const std::filesystem::path& temporary) {
    write_frame(temporary, step, time, layouts, dimension_);
  });
  entries_[step] = index_entry(file, step, time, layouts, dimension_);
  write_index();
}

void FrameWriter::write_index() const {
  write_text(run_folder_ / (participant_ + ".xdmf"), index_text(participant_, entries_));
}

} // namespace kerf
