#include "fem_core/program/read_mesh.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/mesh/box.hpp"
#include "fem_core/mesh/disc.hpp"
#include "fem_core/mesh/quality.hpp"
#include "fem_core/mesh/simplices.hpp"
#include "fem_core/mesh/tunnel.hpp"
#include "fem_core/program/mesh_file.hpp"

#include <algorithm>
#include <limits>

namespace kerf::fem {
namespace {

using coupler::SettingsError;

std::uint32_t as_count(const Table& mesh, const std::string& key, std::uint64_t count) {
  if (count > std::numeric_limits<std::uint32_t>::max())
    throw SettingsError(mesh.path(key), fmt::format("{} are too many elements", count));
  return static_cast<std::uint32_t>(count);
}

template <int dim> std::array<std::uint32_t, dim> read_count(const Table& mesh) {
  const std::vector<std::uint64_t> counts = mesh.counts("count", dim);
  std::array<std::uint32_t, dim> result;
  for (std::size_t a = 0; a < dim; ++a)
    result[a] = as_count(mesh, "count", counts[a]);
  return result;
}

template <int dim> Shape read_shape(const Table& mesh) {
  if (!mesh.has("shape"))
    return dim == 2 ? Shape::quad4 : Shape::hex8;
  const std::string name = mesh.text("shape");
  for (const Shape shape : {Shape::tri3, Shape::quad4, Shape::tet4, Shape::hex8})
    if (name == name_of(shape))
      return shape;
  throw SettingsError(mesh.path("shape"),
                      fmt::format("\"{}\" must be tri3, quad4, tet4 or hex8", name));
}

std::optional<double> optional_number(const Table& mesh, const std::string& key) {
  return mesh.has(key) ? std::optional(mesh.number(key)) : std::nullopt;
}

template <int dim>
Mesh<dim> read_box(const Table& mesh, const std::string& type, const Period<dim>& period) {
  BoxMesh<dim> box{.origin = mesh.vector<dim>("origin"),
                   .size = mesh.vector<dim>("size"),
                   .shape = read_shape<dim>(mesh)};
  if (type == "bar") {
    box.count.fill(1);
    box.count[0] = as_count(mesh, "elements", mesh.count("elements"));
  } else {
    box.count = read_count<dim>(mesh);
    if (mesh.has("grading"))
      box.grading = mesh.vector<dim>("grading");
  }
  return make_box(box, period);
}

template <int dim> Mesh<dim> read_disc(const Table& mesh, const std::string& type) {
  const std::array<std::uint32_t, dim> count = read_count<dim>(mesh);
  const Vec<dim> center = mesh.vector<dim>("center");
  const DiscMesh disc{.center = center.template head<2>(),
                      .radius = mesh.number("radius"),
                      .inner_radius = type == "ring" ? mesh.number("inner_radius") : 0.0,
                      .radial = count[0],
                      .around = count[1],
                      .grading = mesh.number("radial_grading", 1.0)};
  if constexpr (dim == 2)
    return make_disc(disc);
  else
    return make_cylinder(disc,
                         {.origin = center[2], .length = mesh.number("length"), .count = count[2]});
}

template <int dim> Mesh<dim> read_tunnel(const Table& mesh) {
  const std::array<std::uint32_t, dim> count = read_count<dim>(mesh);
  const Vec<dim> origin = mesh.vector<dim>("origin"), size = mesh.vector<dim>("size");
  TunnelMesh tunnel{.origin = origin.template head<2>(),
                    .size = size.template head<2>(),
                    .radius = mesh.number("radius"),
                    .radial = count[0],
                    .around = count[1],
                    .grading = optional_number(mesh, "radial_grading"),
                    .excavation = mesh.flag("excavation", false)};
  if (mesh.has("center")) {
    const Vec<dim> center = mesh.vector<dim>("center");
    if (dim == 3 && center[dim - 1] != origin[dim - 1])
      throw SettingsError(mesh.path("center"),
                          "it is at the lower end of the tunnel: give it the z of origin");
    tunnel.center = center.template head<2>();
  }
  if constexpr (dim == 2)
    return make_tunnel(tunnel);
  else
    return make_tunnel(tunnel, {.origin = origin[2], .length = size[2], .count = count[2]});
}

} // namespace

template <int dim> Period<dim> read_period(const Table& case_settings) {
  Period<dim> period;
  if (!case_settings.has("periodic"))
    return period;
  const Table periodic = case_settings.table("periodic");
  for (int axis = 0; axis < dim; ++axis)
    if (const std::string name(1, "xyz"[axis]); periodic.has(name)) {
      const std::vector<double> ends = periodic.numbers(name, 2);
      period.length[axis] = ends[1] - ends[0];
    }
  return period;
}

template <int dim> Mesh<dim> read_mesh(const Table& participant, const Period<dim>& period) {
  const Table table = participant.table("mesh");
  const std::string type = table.text("type");
  if (type == "box" || type == "bar")
    return read_box(table, type, period);
  if ((period.length.array() > 0.0).any())
    throw SettingsError(table.path("type"), fmt::format("\"{}\" cannot be periodic", type));

  if (type == "file") {
    Mesh<dim> mesh = read_mesh_file<dim>({.path = table.text("file"),
                                          .scale = table.number("scale", 1.0),
                                          .element_size = optional_number(table, "element_size")});
    check_mesh(mesh, "mesh.file");
    return mesh;
  }
  if (type == "tunnel")
    return in_shape(read_tunnel<dim>(table), read_shape<dim>(table));
  if (type == (dim == 2 ? "disc" : "cylinder") || type == "ring")
    return in_shape(read_disc<dim>(table, type), read_shape<dim>(table));
  throw SettingsError(table.path("type"),
                      fmt::format("\"{}\" must be box, bar, {}, ring, tunnel or file", type,
                                  dim == 2 ? "disc" : "cylinder"));
}

template Period<2> read_period<2>(const Table&);
template Period<3> read_period<3>(const Table&);
template Mesh<2> read_mesh<2>(const Table&, const Period<2>&);
template Mesh<3> read_mesh<3>(const Table&, const Period<3>&);

} // namespace kerf::fem
