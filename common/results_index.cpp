#include "common/results_index.hpp"

#include <fmt/format.h>

namespace kerf {
namespace {

constexpr const char* real = R"(NumberType="Float" Precision="8")";
constexpr const char* integer = R"(NumberType="Int" Precision="8")";
constexpr const char* index = R"(NumberType="UInt" Precision="4")";

std::string data_item(const std::string& file, const std::string& path, std::size_t rows,
                      std::size_t columns, const char* type) {
  const std::string shape =
      columns == 1 ? fmt::format("{}", rows) : fmt::format("{} {}", rows, columns);
  return fmt::format(R"(<DataItem Dimensions="{}" {} Format="HDF">{}:/{}</DataItem>)", shape, type,
                     file, path);
}

std::string attribute(const std::string& file, const Field& field, const std::string& grid,
                      const char* center, std::size_t count, std::size_t dimension) {
  const bool is_vector = field.components == dimension;
  const std::size_t columns = is_vector ? 3 : field.components;
  const char* kind = columns == 1 ? "Scalar" : is_vector ? "Vector" : "Matrix";
  const char* type = field.data.index() == 0 ? real : integer;
  return fmt::format(
      "        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n",
      field.name, kind, center, data_item(file, grid + "/" + field.name, count, columns, type));
}

std::string topology(const std::string& file, const Layout& layout) {
  std::string kind;
  switch (layout.grid->cells) {
  case Cells::points:
    kind = R"("Polyvertex" NodesPerElement="1")";
    break;
  case Cells::segments:
    kind = R"("Polyline" NodesPerElement="2")";
    break;
  case Cells::quads:
    kind = R"("Quadrilateral")";
    break;
  case Cells::hexes:
    kind = R"("Hexahedron")";
    break;
  case Cells::triangles:
    kind = R"("Triangle")";
    break;
  case Cells::tetrahedra:
    kind = R"("Tetrahedron")";
    break;
  }
  return fmt::format(
      "        <Topology TopologyType={} NumberOfElements=\"{}\">{}</Topology>\n", kind,
      layout.num_cells,
      data_item(file, layout.grid->name + "/cells", layout.num_cells, layout.corners, index));
}

} // namespace

std::size_t points_per_cell(Cells cells) {
  constexpr std::size_t count[] = {1, 2, 4, 8, 3, 4};
  return count[static_cast<std::size_t>(cells)];
}

std::string index_entry(const std::string& file, std::uint64_t step, double time,
                        const std::vector<Layout>& layouts, std::size_t dimension) {
  std::string text = fmt::format("    <Grid Name=\"step {}\" GridType=\"Collection\" "
                                 "CollectionType=\"Spatial\">\n      <Time Value=\"{}\"/>\n",
                                 step, time);
  for (const Layout& layout : layouts) {
    if (layout.num_cells == 0)
      continue;
    const Grid& grid = *layout.grid;
    text += fmt::format("      <Grid Name=\"{}\" GridType=\"Uniform\">\n", grid.name);
    text += topology(file, layout);
    text += fmt::format("        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                        data_item(file, layout.position, layout.num_points, 3, real));
    for (const Field& field : grid.point_fields)
      text += attribute(file, field, grid.name, "Node", layout.num_points, dimension);
    for (const Field& field : grid.cell_fields)
      text += attribute(file, field, grid.name, "Cell", layout.num_cells, dimension);
    text += "      </Grid>\n";
  }
  return text + "    </Grid>\n";
}

std::string index_text(const std::string& participant,
                       const std::map<std::uint64_t, std::string>& entries) {
  std::string text = fmt::format("<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n"
                                 "  <Grid Name=\"{}\" GridType=\"Collection\" "
                                 "CollectionType=\"Temporal\">\n",
                                 participant);
  for (const auto& [step, entry] : entries)
    text += entry;
  return text + "  </Grid>\n</Domain>\n</Xdmf>\n";
}

std::map<std::uint64_t, std::string> read_index(const std::string& text) {
  const std::string begin = "\n    <Grid Name=\"step ", end = "\n    </Grid>\n";
  std::map<std::uint64_t, std::string> entries;
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    const std::size_t last = text.find(end, at);
    if (last == std::string::npos)
      break;
    const std::uint64_t step = std::stoull(text.substr(at + begin.size(), 20));
    entries[step] = text.substr(at + 1, last + end.size() - (at + 1));
    at = last + end.size() - 1;
  }
  return entries;
}

} // namespace kerf
