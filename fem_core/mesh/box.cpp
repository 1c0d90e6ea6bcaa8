#include "fem_core/mesh/box.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/mesh/axis.hpp"
#include "fem_core/mesh/extrusion.hpp"
#include "fem_core/mesh/simplices.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kerf::fem {
namespace {

constexpr const char* axis_name[] = {"x", "y", "z"};
constexpr const char* side_name[] = {"left", "right", "bottom", "top", "back", "front"};

template <int dim> void check(const BoxMesh<dim>& box, const Period<dim>& period) {
  const double parts = box.shape == Shape::tri3 ? 2.0 : box.shape == Shape::tet4 ? 6.0 : 1.0;
  double corners = parts * nodes_of(box.shape);
  for (int a = 0; a < dim; ++a) {
    corners *= static_cast<double>(box.count[a]) + 1.0;
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
    if (box.grading[a] != 1.0)
      throw InputError("mesh.grading",
                       fmt::format("the grading along the periodic axis {} is {}; it must be 1",
                                   axis_name[a], box.grading[a]));
  }
  check_numbering(corners);
}

Mesh<2> make_grid(const std::vector<double>& x, const std::vector<double>& y) {
  Mesh<2> mesh;
  mesh.positions.reserve(2 * x.size() * y.size());
  for (const double b : y)
    for (const double a : x)
      mesh.positions.insert(mesh.positions.end(), {a, b});

  const auto nodes = static_cast<std::uint32_t>(x.size());
  const std::uint32_t columns = nodes - 1, rows = static_cast<std::uint32_t>(y.size()) - 1;
  Block block{.shape = Shape::quad4, .nodes = {}};
  block.nodes.reserve(std::size_t{4} * columns * rows);
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t n = j * nodes + i;
      block.nodes.insert(block.nodes.end(), {n, n + 1, n + nodes + 1, n + nodes});
    }
    mesh.boundary["left"].push_back({j * columns, 0});
    mesh.boundary["right"].push_back({j * columns + columns - 1, 1});
  }
  for (std::uint32_t i = 0; i < columns; ++i) {
    mesh.boundary["bottom"].push_back({i, 2});
    mesh.boundary["top"].push_back({(rows - 1) * columns + i, 3});
  }
  mesh.blocks.push_back(std::move(block));
  return mesh;
}

/// Makes one of the two ends of every periodic axis.
template <int dim>
void join_ends(Mesh<dim>& mesh, const std::array<std::uint32_t, dim>& count,
               const Period<dim>& period) {
  mesh.period = period;
  std::vector<std::uint32_t> joined(mesh.num_nodes());
  std::vector<double> positions;
  for (std::size_t node = 0; node < joined.size(); ++node) {
    std::size_t rest = node, other = 0, stride = 1; // the node at the lower ends
    for (int a = 0; a < dim; ++a) {
      const std::size_t at = rest % (count[a] + std::size_t{1});
      rest /= count[a] + std::size_t{1};
      other += (period.length[a] > 0.0 ? at % count[a] : at) * stride;
      stride *= count[a] + std::size_t{1};
    }
    if (other == node) {
      joined[node] = static_cast<std::uint32_t>(positions.size() / dim);
      const Vec<dim> x = mesh.position(node);
      positions.insert(positions.end(), x.begin(), x.end());
    } else {
      joined[node] = joined[other];
    }
  }
  mesh.positions = std::move(positions);
  for (std::uint32_t& node : mesh.blocks[0].nodes)
    node = joined[node];
  for (int a = 0; a < dim; ++a)
    if (period.length[a] > 0.0) {
      mesh.boundary.erase(side_name[2 * a]);
      mesh.boundary.erase(side_name[2 * a + 1]);
    }
}

} // namespace

template <int dim> Mesh<dim> make_box(const BoxMesh<dim>& box, const Period<dim>& period) {
  check(box, period);
  std::array<std::vector<double>, dim> x;
  for (int a = 0; a < dim; ++a)
    x[a] =
        positions_along({box.origin[a], box.size[a], box.count[a], box.grading[a]}, axis_name[a]);
  Mesh<dim> mesh = [&] {
    if constexpr (dim == 2)
      return make_grid(x[0], x[1]);
    else
      return extrude(make_grid(x[0], x[1]), x[2], "back", "front");
  }();
  mesh = in_shape(std::move(mesh), box.shape); // cut first, so that every period is cut alike
  if ((period.length.array() > 0.0).any())
    join_ends<dim>(mesh, box.count, period);
  return mesh;
}

template Mesh<2> make_box<2>(const BoxMesh<2>&, const Period<2>&);
template Mesh<3> make_box<3>(const BoxMesh<3>&, const Period<3>&);

} // namespace kerf::fem
