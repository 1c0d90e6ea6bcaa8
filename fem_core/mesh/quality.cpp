#include "fem_core/mesh/quality.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/mesh/coincidence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace kerf::fem {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <int dim> using Corners = Eigen::Matrix<double, dim, Eigen::Dynamic, 0, dim, 8>;
template <int dim> using Square = Eigen::Matrix<double, dim, dim>;

/// dN_a/dxi of a quad or a hex, at each of its corners and then at each of its Gauss points.
template <int dim> struct Slopes {
  static constexpr int num_nodes = 1 << dim;
  using Matrix = Eigen::Matrix<double, num_nodes, dim>;
  std::array<Matrix, num_nodes> at_corner, at_point;

  Slopes() {
    for (int k = 0; k < num_nodes; ++k) {
      at_corner[k] = at(corner(k));
      at_point[k] = at(corner(k) / std::numbers::sqrt3);
    }
  }

private:
  /// A corner of the square or cube [-1, 1]^dim, in VTK's order.
  static Vec<dim> corner(int a) {
    const double x = (a % 4 == 1 || a % 4 == 2) ? 1.0 : -1.0, y = a % 4 < 2 ? -1.0 : 1.0;
    if constexpr (dim == 2)
      return {x, y};
    else
      return {x, y, a < 4 ? -1.0 : 1.0};
  }

  static Matrix at(const Vec<dim>& xi) {
    Matrix slopes;
    for (int a = 0; a < num_nodes; ++a)
      for (int i = 0; i < dim; ++i) {
        slopes(a, i) = 0.5 * corner(a)[i];
        for (int j = 0; j < dim; ++j)
          slopes(a, i) *= i == j ? 1.0 : 0.5 * (1.0 + corner(a)[j] * xi[j]);
      }
    return slopes;
  }
};

struct Measures {
  double jacobian, scaled_jacobian, shortest_edge, longest_edge;
};

template <int dim> void measure_cell(const Corners<dim>& corners, Measures& measures) {
  static const Slopes<dim> slopes;
  const Eigen::Matrix<double, dim, (1 << dim)> x = corners;
  for (int k = 0; k < (1 << dim); ++k) {
    const Square<dim> J = x * slopes.at_corner[k], at_point = x * slopes.at_point[k];
    const double det = J.determinant();
    measures.jacobian = std::min({measures.jacobian, det, at_point.determinant()});
    measures.scaled_jacobian = std::min(measures.scaled_jacobian, det / J.colwise().norm().prod());
  }
}

template <int dim> void measure_simplex(const Corners<dim>& x, Measures& measures) {
  const double regular = dim == 2 ? 0.5 * std::numbers::sqrt3 : 0.5 * std::numbers::sqrt2;
  const double det = (x.template rightCols<dim>().colwise() - x.col(0)).determinant();
  measures.jacobian = det;
  for (int a = 0; a <= dim; ++a) {
    double edges = 1.0;
    for (int b = 0; b <= dim; ++b)
      edges *= a == b ? 1.0 : (x.col(b) - x.col(a)).norm();
    measures.scaled_jacobian = std::min(measures.scaled_jacobian, det / edges / regular);
  }
}

template <int dim> Measures measure(const Mesh<dim>& mesh, std::size_t element) {
  const Corners<dim> x = mesh.corners(element);
  const Shape shape = mesh.shape_of(element);
  Measures measures{infinity, infinity, infinity, 0.0};
  if (x.cols() == dim + 1)
    measure_simplex<dim>(x, measures);
  else
    measure_cell<dim>(x, measures);
  for (int side = 0; side < sides_of(shape); ++side) {
    const std::span<const std::uint8_t> nodes = side_nodes(shape, side);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double edge = (x.col(nodes[(k + 1) % nodes.size()]) - x.col(nodes[k])).norm();
      measures.shortest_edge = std::min(measures.shortest_edge, edge);
      measures.longest_edge = std::max(measures.longest_edge, edge);
    }
  }
  return measures;
}

template <int dim> std::string region_of(const Mesh<dim>& mesh, std::uint32_t element) {
  for (const auto& [tag, members] : mesh.regions)
    if (std::binary_search(members.begin(), members.end(), element))
      return tag;
  return "";
}

template <int dim> std::string place(const Mesh<dim>& mesh, std::size_t node) {
  const Vec<dim> x = mesh.position(node);
  return fmt::format("({:.6g})", fmt::join(x.begin(), x.end(), ", "));
}

template <int dim> void check_nodes(const Mesh<dim>& mesh, const std::string& key) {
  std::vector<bool> is_used(mesh.num_nodes());
  for (const Block& block : mesh.blocks)
    for (const std::uint32_t node : block.nodes)
      is_used[node] = true;
  for (std::size_t node = 0; node < mesh.num_nodes(); ++node) {
    if (!mesh.position(node).allFinite())
      throw InputError(
          key, fmt::format("node {} is at {}; give it a position", node, place(mesh, node)));
    if (!is_used[node])
      throw InputError(key, fmt::format("node {} at {} belongs to no element; take it out of the "
                                        "mesh",
                                        node, place(mesh, node)));
  }
}

} // namespace

template <int dim> Quality<dim> quality_of(const Mesh<dim>& mesh) {
  Quality<dim> quality;
  quality.jacobian.value = quality.scaled_jacobian.value = quality.shortest_edge = infinity;
  const auto keep = [](Worst& worst, double value, std::size_t element) {
    worst = {value, static_cast<std::uint32_t>(element), ""};
  };
  for (std::size_t e = 0; e < mesh.num_elements(); ++e) {
    const Measures measures = measure(mesh, e);
    const double aspect_ratio = measures.longest_edge / measures.shortest_edge;
    if (!(measures.jacobian >= quality.jacobian.value))
      keep(quality.jacobian, measures.jacobian, e);
    if (!(measures.scaled_jacobian >= quality.scaled_jacobian.value))
      keep(quality.scaled_jacobian, measures.scaled_jacobian, e);
    if (!(aspect_ratio <= quality.aspect_ratio.value))
      keep(quality.aspect_ratio, aspect_ratio, e);
    quality.shortest_edge = std::min(quality.shortest_edge, measures.shortest_edge);
    quality.longest_edge = std::max(quality.longest_edge, measures.longest_edge);
  }
  for (Worst* worst : {&quality.jacobian, &quality.scaled_jacobian, &quality.aspect_ratio})
    worst->region = region_of(mesh, worst->element);
  const Eigen::Map<const Eigen::Matrix<double, dim, Eigen::Dynamic>> x(
      mesh.positions.data(), dim, static_cast<Eigen::Index>(mesh.num_nodes()));
  quality.extent = {x.rowwise().minCoeff(), x.rowwise().maxCoeff()};
  return quality;
}

template <int dim> Quality<dim> check_mesh(const Mesh<dim>& mesh, const std::string& key) {
  if (mesh.num_elements() == 0)
    throw InputError(key, "the mesh has no elements");
  check_nodes(mesh, key);
  const Quality<dim> quality = quality_of(mesh);
  if (const auto& [value, element, region] = quality.jacobian; !(value > 0.0)) {
    std::vector<std::string> corners;
    for (const std::uint32_t node : mesh.nodes_of_element(element))
      corners.push_back(fmt::format("{} at {}", node, place(mesh, node)));
    throw InputError(
        key, fmt::format("element {} ({}, {}) has a Jacobian of {:.3g} {}, which must be positive: "
                         "it is folded or its nodes are in a wrong order; its nodes are {}. Move "
                         "them, or mesh this part finer",
                         element, name_of(mesh.shape_of(element)),
                         region.empty() ? "in no region" : "region \"" + region + "\"", value,
                         dim == 2 ? "m²" : "m³", fmt::join(corners, ", ")));
  }
  if (const auto pair = coincident_nodes(mesh, 1e-6 * quality.shortest_edge, quality.shortest_edge))
    throw InputError(key,
                     fmt::format("nodes {} and {} are both at {}: elements that meet there are "
                                 "not joined. Merge them, in Gmsh with Coherence Mesh, or "
                                 "part them",
                                 pair->first, pair->second, place(mesh, pair->first)));
  return quality;
}

template <int dim>
std::optional<std::string> doubt_of_unit(const Quality<dim>& quality, double travelled) {
  const double size = (quality.extent.upper - quality.extent.lower).maxCoeff();
  const std::string fix =
      "if it is not in metres, give mesh.scale, for example 1e-3 for millimetres";
  if (size > 1e5 || size < 1e-6)
    return fmt::format("the mesh is {:.3g} m long; {}", size, fix);
  if (travelled < quality.shortest_edge)
    return fmt::format("in the whole run a wave travels {:.3g} m, less than the shortest edge of "
                       "the mesh, {:.3g} m; {}",
                       travelled, quality.shortest_edge, fix);
  return std::nullopt;
}

template Quality<2> quality_of<2>(const Mesh<2>&);
template Quality<3> quality_of<3>(const Mesh<3>&);
template Quality<2> check_mesh<2>(const Mesh<2>&, const std::string&);
template Quality<3> check_mesh<3>(const Mesh<3>&, const std::string&);
template std::optional<std::string> doubt_of_unit<2>(const Quality<2>&, double);
template std::optional<std::string> doubt_of_unit<3>(const Quality<3>&, double);

} // namespace kerf::fem
