#include "dem_core/packing/closed_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace kerf::dem {

namespace {

/// What two neighbouring facets share, in the direction of one of them: a vertex in 2D (the second
/// number says whether the segment ends there), an edge in 3D.
using Rim = std::pair<std::uint32_t, std::uint32_t>;

template <int dim> std::array<Rim, dim> rims(const Facet<dim>& f) {
  if constexpr (dim == 2)
    return {Rim{f[0], 0}, Rim{f[1], 1}};
  else
    return {Rim{f[0], f[1]}, Rim{f[1], f[2]}, Rim{f[2], f[0]}};
}

template <int dim> Rim opposite(const Rim& rim) {
  return dim == 2 ? Rim{rim.first, 1 - rim.second} : Rim{rim.second, rim.first};
}

/// Which part of a triangle is nearest: the inside, the edge after a corner, or a corner.
struct Part {
  enum { inside, edge, corner } kind;
  std::size_t index;
};

/// Nearest point of the triangle a b c; C. Ericson, Real-Time Collision Detection (2005), 5.1.5.
std::pair<Vec<3>, Part> nearest_on_triangle(const Vec<3>& p, const Vec<3>& a, const Vec<3>& b,
                                            const Vec<3>& c) {
  const Vec<3> ab = b - a, ac = c - a;
  const double d1 = ab.dot(p - a), d2 = ac.dot(p - a);
  if (d1 <= 0.0 && d2 <= 0.0)
    return {a, {Part::corner, 0}};
  const double d3 = ab.dot(p - b), d4 = ac.dot(p - b);
  if (d3 >= 0.0 && d4 <= d3)
    return {b, {Part::corner, 1}};
  const double d5 = ab.dot(p - c), d6 = ac.dot(p - c);
  if (d6 >= 0.0 && d5 <= d6)
    return {c, {Part::corner, 2}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0)
    return {a + d1 / (d1 - d3) * ab, {Part::edge, 0}};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6)
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), {Part::edge, 1}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0)
    return {a + d2 / (d2 - d6) * ac, {Part::edge, 2}};
  return {a + (vb * ab + vc * ac) / (va + vb + vc), {Part::inside, 0}};
}

std::pair<Vec<2>, Part> nearest_on_segment(const Vec<2>& p, const Vec<2>& a, const Vec<2>& b) {
  const double share = (p - a).dot(b - a) / (b - a).squaredNorm();
  if (share <= 0.0)
    return {a, {Part::corner, 0}};
  if (share >= 1.0)
    return {b, {Part::corner, 1}};
  return {a + share * (b - a), {Part::inside, 0}};
}

/// Squared distance of a point to a box; zero inside.
template <int dim>
double squared_distance(const Vec<dim>& point, const Vec<dim>& lower, const Vec<dim>& upper) {
  return (lower - point).cwiseMax(point - upper).cwiseMax(0.0).squaredNorm();
}

} // namespace

template <int dim> struct ClosedSurface<dim>::Nearest {
  double squared_distance = std::numeric_limits<double>::infinity(); // m²
  Vec<dim> point, outward;
};

template <int dim>
ClosedSurface<dim>::ClosedSurface(std::vector<Vec<dim>> vertices, std::vector<Facet<dim>> facets)
    : vertices_(std::move(vertices)), facets_(std::move(facets)) {
  check_closed();
  turn_outwards();
  build_tree(0, static_cast<std::uint32_t>(facets_.size()));
  make_normals();
}

template <int dim> void ClosedSurface<dim>::check_closed() const {
  if (facets_.size() <= dim)
    throw std::invalid_argument(fmt::format("{} facets do not close a surface", facets_.size()));
  std::map<Rim, std::uint32_t> owner;
  for (std::uint32_t f = 0; f < facets_.size(); ++f) {
    for (const std::uint32_t vertex : facets_[f])
      if (vertex >= vertices_.size() || !vertices_[vertex].allFinite())
        throw std::invalid_argument(fmt::format("facet {} has no vertex {}", f, vertex));
    if (!(normal(facets_[f]).norm() > 0.0))
      throw std::invalid_argument(fmt::format("facet {} has no extent", f));
    for (const Rim& rim : rims<dim>(facets_[f]))
      if (const auto [other, is_new] = owner.emplace(rim, f); !is_new)
        throw std::invalid_argument(
            fmt::format("facets {} and {} share {} in the same direction: the surface touches "
                        "itself, or one of them is turned over",
                        other->second, f, dim == 2 ? "a vertex" : "an edge"));
  }
  for (const auto& [rim, f] : owner)
    if (!owner.contains(opposite<dim>(rim)))
      throw std::invalid_argument(fmt::format(
          "the surface is not closed: facet {} has no neighbour at {}", f,
          dim == 2 ? fmt::format("vertex {}", rim.first)
                   : fmt::format("the edge of vertices {} and {}", rim.first, rim.second)));
}

template <int dim> Vec<dim> ClosedSurface<dim>::normal(const Facet<dim>& f) const {
  if constexpr (dim == 2) {
    const Vec<2> along = vertices_[f[1]] - vertices_[f[0]];
    return {along[1], -along[0]};
  } else {
    return (vertices_[f[1]] - vertices_[f[0]]).cross(vertices_[f[2]] - vertices_[f[0]]);
  }
}

template <int dim> void ClosedSurface<dim>::turn_outwards() {
  // Divergence theorem, around a corner of the surface so that no digits are lost far away.
  const double facet_share = dim == 2 ? 2.0 : 6.0;
  for (const Facet<dim>& facet : facets_)
    volume_ += normal(facet).dot(vertices_[facet[0]] - vertices_[facets_[0][0]]) / facet_share;
  if (volume_ < 0.0)
    for (Facet<dim>& facet : facets_)
      std::swap(facet[0], facet[1]);
  volume_ = std::abs(volume_);
  if (!(volume_ > 0.0))
    throw std::invalid_argument("the surface encloses nothing");
}

template <int dim> void ClosedSurface<dim>::build_tree(std::uint32_t first, std::uint32_t last) {
  Vec<dim> lower = vertices_[facets_[first][0]], upper = lower;
  for (std::uint32_t f = first; f < last; ++f)
    for (const std::uint32_t vertex : facets_[f]) {
      lower = lower.cwiseMin(vertices_[vertex]);
      upper = upper.cwiseMax(vertices_[vertex]);
    }
  const std::size_t node = tree_.size();
  tree_.push_back({lower, upper, first, last, 0});
  if (last - first <= 4)
    return;
  int axis = 0;
  (upper - lower).maxCoeff(&axis);
  const auto middle = first + (last - first) / 2;
  const auto center = [&](const Facet<dim>& facet) {
    double sum = 0.0;
    for (const std::uint32_t vertex : facet)
      sum += vertices_[vertex][axis];
    return sum;
  };
  std::sort(facets_.begin() + first, facets_.begin() + last,
            [&](const auto& f, const auto& g) { return center(f) < center(g); });
  build_tree(first, middle);
  tree_[node].second_part = static_cast<std::uint32_t>(tree_.size());
  build_tree(middle, last);
}

template <int dim> void ClosedSurface<dim>::make_normals() {
  vertex_normals_.assign(vertices_.size(), Vec<dim>::Zero());
  std::map<Rim, Vec<dim>> rim_normals;
  for (const Facet<dim>& facet : facets_) {
    const Vec<dim> n = normal(facet).normalized();
    facet_normals_.push_back(n);
    for (std::size_t k = 0; k < dim; ++k) {
      double angle = 1.0; // of the facet at its corner
      if constexpr (dim == 3) {
        const Vec<3> p = vertices_[facet[k]];
        const Vec<3> a = vertices_[facet[(k + 1) % 3]] - p, b = vertices_[facet[(k + 2) % 3]] - p;
        angle = std::atan2(a.cross(b).norm(), a.dot(b));
        rim_normals[rims<3>(facet)[k]] = n;
      }
      vertex_normals_[facet[k]] += angle * n;
    }
  }
  if constexpr (dim == 3)
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      auto& edges = edge_normals_.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
        edges[k] = facet_normals_[f] + rim_normals.at(opposite<3>(rims<3>(facets_[f])[k]));
    }
}

template <int dim>
void ClosedSurface<dim>::search_facet(const Vec<dim>& point, std::uint32_t f,
                                      Nearest& nearest) const {
  const Facet<dim>& facet = facets_[f];
  const auto [closest, part] = [&] {
    if constexpr (dim == 2)
      return nearest_on_segment(point, vertices_[facet[0]], vertices_[facet[1]]);
    else
      return nearest_on_triangle(point, vertices_[facet[0]], vertices_[facet[1]],
                                 vertices_[facet[2]]);
  }();
  const double squared = (point - closest).squaredNorm();
  if (squared >= nearest.squared_distance)
    return;
  nearest.squared_distance = squared;
  nearest.point = closest;
  nearest.outward = part.kind == Part::inside   ? facet_normals_[f]
                    : part.kind == Part::corner ? vertex_normals_[facet[part.index]]
                                                : edge_normals_[f][part.index];
}

template <int dim> Wall<dim> ClosedSurface<dim>::wall(const Vec<dim>& point) const {
  Nearest nearest;
  std::array<std::uint32_t, 64> waiting; // a balanced tree over 2^32 facets is not as deep
  std::size_t count = 0;
  const auto distance = [&](std::uint32_t node) {
    return squared_distance<dim>(point, tree_[node].lower, tree_[node].upper);
  };
  waiting[count++] = 0;
  while (count > 0) {
    const std::uint32_t index = waiting[--count];
    const Node& node = tree_[index];
    if (distance(index) >= nearest.squared_distance)
      continue;
    if (node.second_part == 0) {
      for (std::uint32_t f = node.first; f < node.last; ++f)
        search_facet(point, f, nearest);
      continue;
    }
    const bool first_is_nearer = distance(index + 1) <= distance(node.second_part);
    waiting[count++] = first_is_nearer ? node.second_part : index + 1;
    waiting[count++] = first_is_nearer ? index + 1 : node.second_part;
  }
  const Vec<dim> away = point - nearest.point;
  const double length = std::sqrt(nearest.squared_distance);
  const bool is_outside = away.dot(nearest.outward) > 0.0;
  if (length < 1e-12 * (tree_.front().upper - tree_.front().lower).norm()) // no direction is left
    return {is_outside ? -length : length, -nearest.outward.normalized()};
  return is_outside ? Wall<dim>{-length, -away / length} : Wall<dim>{length, away / length};
}

template class ClosedSurface<2>;
template class ClosedSurface<3>;

} // namespace kerf::dem
