#include "dem_core/program/tool_output.hpp"

#include <string_view>

namespace kerf::dem {

namespace {

template <int dim> std::vector<Column> columns() {
  std::vector<Column> columns = {{"step", "1"}, {"time", "s"}};
  const std::string_view axes = std::string_view("xyz").substr(0, dim);
  add_axes(columns, "position", "m", axes);
  add_axes(columns, "velocity", "m/s", axes);
  columns.push_back({"angle", "rad"});
  add_axes(columns, "force", "N", axes);
  add_axes(columns, "moment", "N m", dim == 2 ? "z" : "xyz");
  columns.insert(columns.end(), {{"power", "W"}, {"work", "J"}, {"contacts", "1"}});
  return columns;
}

} // namespace

template <int dim>
ToolOutput<dim>::ToolOutput(const Engine<dim>& engine, const std::filesystem::path& run_folder,
                            const std::string& participant)
    : engine_(engine) {
  for (std::size_t k = 0; k < engine_.tools().size(); ++k)
    histories_.emplace_back(run_folder / "history" /
                                (participant + "_" + engine_.tool_name(k) + ".csv"),
                            columns<dim>(), engine_.step());
}

template <int dim> void ToolOutput<dim>::add_grids(std::vector<Grid>& grids) {
  faces_.clear();
  faces_.reserve(engine_.tools().size()); // the grids look into it
  for (std::size_t k = 0; k < engine_.tools().size(); ++k) {
    const Tool<dim>& tool = engine_.tools()[k];
    const Surface<dim>* surface = tool.shape().surface();
    if (surface == nullptr)
      continue;
    Face& face = faces_.emplace_back();
    face.name = "tool_" + engine_.tool_name(k);
    for (const Vec<dim>& vertex : surface->vertices)
      face.position.push_back(tool.pose().to_space(vertex));
    for (const Facet<dim>& facet : surface->facets)
      face.connectivity.insert(face.connectivity.end(), facet.begin(), facet.end());
    grids.push_back({.name = face.name,
                     .positions = {face.position.front().data(), face.position.size() * dim},
                     .points_of = {},
                     .cells = dim == 2 ? Cells::segments : Cells::triangles,
                     .connectivity = face.connectivity,
                     .point_fields = {},
                     .cell_fields = {}});
  }
}

template <int dim> void ToolOutput<dim>::write_history(std::uint64_t step, double time) {
  for (std::size_t k = 0; k < histories_.size(); ++k) {
    const Tool<dim>& tool = engine_.tools()[k];
    std::vector<double> row = {static_cast<double>(step), time};
    const auto add = [&](const auto& vector) {
      row.insert(row.end(), vector.begin(), vector.end());
    };
    add(tool.pose().reference);
    add(tool.velocity().translation);
    row.push_back(tool.angle());
    add(tool.load().force);
    add(tool.load().moment);
    row.insert(row.end(),
               {tool.power(), tool.work(), static_cast<double>(engine_.wall_contacts()[k].size())});
    histories_[k].append(row);
  }
}

template class ToolOutput<2>;
template class ToolOutput<3>;

} // namespace kerf::dem
