#include "fem_core/mesh/simplices.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/mesh/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace kerf::fem {
namespace {

template <int dim> inline constexpr std::size_t children = dim == 2 ? 2 : 6; // of a cell

using Triangle = std::array<int, 3>; // local nodes of the quad

/// Diagonals of unequal length are told apart by more than round-off can make of equal ones.
template <int dim> std::array<Triangle, 2> triangles(const Mesh<dim>& mesh, std::size_t cell) {
  const auto x = mesh.corners(cell);
  const double first = (x.col(2) - x.col(0)).norm(), second = (x.col(3) - x.col(1)).norm();
  if (second < (1.0 - 1e-6) * first)
    return {{{0, 1, 3}, {1, 2, 3}}};
  return {{{0, 1, 2}, {0, 2, 3}}};
}

void append_tets(std::span<const std::uint32_t> hex, Triangle t, std::vector<std::uint32_t>& out) {
  const auto is_less = [&](int a, int b) {
    return hex[static_cast<std::size_t>(a)] < hex[static_cast<std::size_t>(b)];
  };
  const bool is_odd = (is_less(t[1], t[0]) != is_less(t[2], t[0])) != is_less(t[2], t[1]);
  std::sort(t.begin(), t.end(), is_less);
  const auto [a, b, c] = t;
  for (std::array<int, 4> tet :
       {std::array{a, b, c, c + 4}, {a, b, c + 4, b + 4}, {a, a + 4, b + 4, c + 4}}) {
    if (is_odd) // then a, b, c go clockwise
      std::swap(tet[2], tet[3]);
    for (const int node : tet)
      out.push_back(hex[static_cast<std::size_t>(node)]);
  }
}

/// Sides of the children of a cell that lie in one of its sides.
template <int dim>
void append_faces(const Mesh<dim>& mesh, const Mesh<dim>& cut, const Face& face,
                  std::vector<Face>& out) {
  const std::vector<std::uint32_t> parent = mesh.nodes_of_face(face);
  const auto is_in_parent = [&](std::uint32_t node) {
    return std::find(parent.begin(), parent.end(), node) != parent.end();
  };
  for (std::size_t k = 0; k < children<dim>; ++k)
    for (int side = 0; side < sides_of(cut.blocks[0].shape); ++side) {
      const Face child{static_cast<std::uint32_t>(face.element * children<dim> + k),
                       static_cast<std::uint8_t>(side)};
      const std::vector<std::uint32_t> nodes = cut.nodes_of_face(child);
      if (std::all_of(nodes.begin(), nodes.end(), is_in_parent))
        out.push_back(child);
    }
}

} // namespace

template <int dim> Mesh<dim> in_shape(Mesh<dim> mesh, Shape shape) {
  constexpr Shape whole = dim == 2 ? Shape::quad4 : Shape::hex8;
  assert(mesh.blocks.size() == 1 && mesh.blocks[0].shape == whole);
  if (dimension_of(shape) != dim)
    throw InputError("mesh.shape",
                     fmt::format("\"{}\" is not an element of {}D; give {}", name_of(shape), dim,
                                 dim == 2 ? "quad4 or tri3" : "hex8 or tet4"));
  if (shape == whole)
    return mesh;

  const std::size_t cells = mesh.num_elements();
  const std::size_t corners = children<dim> * (dim + 1) * cells;
  check_numbering(static_cast<double>(corners));
  Mesh<dim> cut;
  Block block{.shape = shape, .nodes = {}};
  block.nodes.reserve(corners);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::span<const std::uint32_t> nodes = mesh.nodes_of_element(cell);
    for (const Triangle& triangle : triangles(mesh, cell))
      if constexpr (dim == 3)
        append_tets(nodes, triangle, block.nodes);
      else
        for (const int a : triangle)
          block.nodes.push_back(nodes[static_cast<std::size_t>(a)]);
  }
  cut.blocks.push_back(std::move(block));
  for (const auto& [tag, faces] : mesh.boundary)
    for (const Face& face : faces)
      append_faces(mesh, cut, face, cut.boundary[tag]);
  for (const auto& [tag, members] : mesh.regions)
    for (const std::uint32_t cell : members)
      for (std::size_t k = 0; k < children<dim>; ++k)
        cut.regions[tag].push_back(static_cast<std::uint32_t>(cell * children<dim> + k));
  cut.positions = std::move(mesh.positions);
  cut.node_sets = std::move(mesh.node_sets);
  cut.period = mesh.period;
  return cut;
}

template Mesh<2> in_shape<2>(Mesh<2>, Shape);
template Mesh<3> in_shape<3>(Mesh<3>, Shape);

} // namespace kerf::fem
