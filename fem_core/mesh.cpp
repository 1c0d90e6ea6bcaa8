#include "fem_core/mesh.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace kerf::fem {
namespace {

constexpr const char* axis_name[] = {"x", "y", "z"};

template <int dim> struct Side {
  const char* tag;
  int axis;
  int upper; // 1 at the upper end of the axis
  std::array<int, face_nodes<dim>> corners;
};

template <int dim> constexpr auto sides() {
  if constexpr (dim == 2)
    return std::array<Side<2>, 4>{{{"left", 0, 0, {3, 0}},
                                   {"right", 0, 1, {1, 2}},
                                   {"bottom", 1, 0, {0, 1}},
                                   {"top", 1, 1, {2, 3}}}};
  else
    return std::array<Side<3>, 6>{{{"left", 0, 0, {0, 4, 7, 3}},
                                   {"right", 0, 1, {1, 2, 6, 5}},
                                   {"bottom", 1, 0, {0, 1, 5, 4}},
                                   {"top", 1, 1, {3, 7, 6, 2}},
                                   {"back", 2, 0, {0, 3, 2, 1}},
                                   {"front", 2, 1, {4, 5, 6, 7}}}};
}

template <int dim> void check(const BoxMesh<dim>& box, const Period<dim>& period) {
  double corners = element_nodes<dim>; // as a real number, which cannot overflow
  for (int a = 0; a < dim; ++a) {
    if (!(box.size[a] > 0.0 && std::isfinite(box.size[a]) && std::isfinite(box.origin[a])))
      throw InputError("mesh.size", fmt::format("the size along {} is {} m; it must be positive",
                                                axis_name[a], box.size[a]));
    if (box.count[a] == 0)
      throw InputError("mesh.count",
                       fmt::format("there must be at least one element along {}", axis_name[a]));
    corners *= static_cast<double>(box.count[a] + 1);
    if (period.length[a] == 0.0)
      continue;
    if (!(std::abs(box.size[a] - period.length[a]) <= 1e-9 * period.length[a]))
      throw InputError("mesh.size",
                       fmt::format("the size along the periodic axis {} is {} m; it must be the "
                                   "period, {} m",
                                   axis_name[a], box.size[a], period.length[a]));
    if (box.count[a] < 3)
      throw InputError("mesh.count", fmt::format("there are {} elements along the periodic axis "
                                                 "{}; there must be at least three",
                                                 box.count[a], axis_name[a]));
  }
  if (corners > std::numeric_limits<std::uint32_t>::max())
    throw InputError("mesh.count", "the mesh has more corners than 32 bits can number");
}

} // namespace

template <int dim> Mesh<dim> make_box(const BoxMesh<dim>& box, const Period<dim>& period) {
  check(box, period);

  // Counts along each axis; a missing third axis has one layer of nodes and of elements.
  std::array<std::size_t, 3> cells = {1, 1, 1};
  std::array<std::size_t, 3> nodes = {1, 1, 1};
  for (int a = 0; a < dim; ++a) {
    cells[a] = box.count[a];
    nodes[a] = period.length[a] > 0.0 ? cells[a] : cells[a] + 1;
  }

  Mesh<dim> mesh;
  mesh.period = period;
  mesh.positions.reserve(nodes[0] * nodes[1] * nodes[2] * dim);
  std::array<std::size_t, 3> at;
  for (at[2] = 0; at[2] < nodes[2]; ++at[2])
    for (at[1] = 0; at[1] < nodes[1]; ++at[1])
      for (at[0] = 0; at[0] < nodes[0]; ++at[0])
        for (int a = 0; a < dim; ++a) // divided last: the upper end is met exactly
          mesh.positions.push_back(box.origin[a] + box.size[a] * static_cast<double>(at[a]) /
                                                       static_cast<double>(cells[a]));

  mesh.elements.reserve(cells[0] * cells[1] * cells[2] * element_nodes<dim>);
  for (const Side<dim>& side : sides<dim>())
    if (period.length[side.axis] == 0.0)
      mesh.boundary[side.tag] = {};
  for (at[2] = 0; at[2] < cells[2]; ++at[2])
    for (at[1] = 0; at[1] < cells[1]; ++at[1])
      for (at[0] = 0; at[0] < cells[0]; ++at[0]) {
        std::array<std::uint32_t, element_nodes<dim>> corners;
        for (int c = 0; c < element_nodes<dim>; ++c) {
          std::array<std::size_t, 3> node = {0, 0, 0};
          for (int a = 0; a < dim; ++a)
            node[a] = (at[a] + static_cast<std::size_t>(corner_side(c, a))) % nodes[a];
          corners[c] =
              static_cast<std::uint32_t>((node[2] * nodes[1] + node[1]) * nodes[0] + node[0]);
        }
        mesh.elements.insert(mesh.elements.end(), corners.begin(), corners.end());
        for (const Side<dim>& side : sides<dim>())
          if (period.length[side.axis] == 0.0 &&
              at[side.axis] == (side.upper ? cells[side.axis] - 1 : 0))
            for (const int c : side.corners)
              mesh.boundary[side.tag].push_back(corners[c]);
      }
  return mesh;
}

template <int dim>
std::vector<std::uint32_t> nodes_with_tag(const Mesh<dim>& mesh, const std::string& tag,
                                          const std::string& key) {
  if (tag == "all") {
    std::vector<std::uint32_t> nodes(mesh.num_nodes());
    std::iota(nodes.begin(), nodes.end(), 0u);
    return nodes;
  }
  const auto found = mesh.boundary.find(tag);
  if (found == mesh.boundary.end()) {
    std::vector<std::string> tags = {"all"};
    for (const auto& [name, faces] : mesh.boundary)
      tags.push_back(name);
    throw InputError(key, fmt::format("the mesh has no tag \"{}\"; its tags are {}", tag,
                                      fmt::join(tags, ", ")));
  }
  std::vector<std::uint32_t> nodes = found->second;
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

template Mesh<2> make_box<2>(const BoxMesh<2>&, const Period<2>&);
template Mesh<3> make_box<3>(const BoxMesh<3>&, const Period<3>&);
template std::vector<std::uint32_t> nodes_with_tag<2>(const Mesh<2>&, const std::string&,
                                                      const std::string&);
template std::vector<std::uint32_t> nodes_with_tag<3>(const Mesh<3>&, const std::string&,
                                                      const std::string&);

} // namespace kerf::fem
