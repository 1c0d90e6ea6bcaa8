#include "common/surface_file.hpp"

#include <fmt/format.h>

namespace kerf {

template <int dim>
Surface<dim> read_surface(const std::filesystem::path& path, std::string_view physical_name) {
  const std::filesystem::path ending = path.extension();
  if (ending == ".msh")
    return read_gmsh_surface<dim>(path, physical_name);
  if (!physical_name.empty())
    throw FileError(
        fmt::format("{} is no Gmsh mesh and has no group \"{}\"", path.string(), physical_name));
  if constexpr (dim == 2) {
    if (ending == ".txt")
      return read_polyline(path);
  } else {
    if (ending == ".stl")
      return read_stl(path);
  }
  throw FileError(fmt::format("{} is no surface in {}D: its name must end in {}", path.string(),
                              dim, dim == 2 ? ".txt or .msh" : ".stl or .msh"));
}

Surface<2> read_polyline(const std::filesystem::path& path) {
  TextFile file(path, '#');
  Surface<2> surface;
  std::vector<std::size_t> line;
  while (file.next()) {
    if (file.words().size() != 2)
      file.fail(fmt::format("a line must hold 2 values, x y, but this one holds {}",
                            file.words().size()));
    surface.vertices.emplace_back(file.number(0), file.number(1));
    if (const auto last = static_cast<std::uint32_t>(surface.vertices.size() - 1); last > 0) {
      surface.facets.push_back({last - 1, last});
      line.push_back(file.line_number());
    }
  }
  return finish_surface(path, surface, line);
}

template <int dim>
Surface<dim> finish_surface(const std::filesystem::path& path, const Surface<dim>& surface,
                            std::span<const std::size_t> line) {
  if (const auto fault = find_fault(surface)) {
    const bool has_line = fault->facet && *fault->facet < line.size();
    throw FileError(
        has_line ? fmt::format("{}:{}: {}", path.string(), line[*fault->facet], fault->sentence)
                 : fmt::format("{}: {}", path.string(), fault->sentence));
  }
  return merge_vertices(surface);
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template Surface<dim> read_surface<dim>(const std::filesystem::path&, std::string_view);         \
  template Surface<dim> finish_surface<dim>(const std::filesystem::path&, const Surface<dim>&,     \
                                            std::span<const std::size_t>);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf
