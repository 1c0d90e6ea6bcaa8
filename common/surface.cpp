#include "common/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace kerf {

namespace {

/// Least height of a facet over its longest edge.
constexpr double least_height = 1e-9;

template <int dim> std::string text(const Vec<dim>& x) {
  return dim == 2 ? fmt::format("({}, {})", x[0], x[1])
                  : fmt::format("({}, {}, {})", x[0], x[1], x[dim - 1]);
}

template <int dim> double longest_edge(const FacetShape<dim>& x) {
  double longest = 0.0;
  for (int k = 0; k < dim; ++k)
    longest = std::max(longest, (x[(k + 1) % dim] - x[k]).norm());
  return longest;
}

template <int dim> bool is_degenerate(const FacetShape<dim>& x) {
  const double longest = longest_edge<dim>(x);
  if constexpr (dim == 2)
    return !(longest > 0.0);
  else
    return !(scaled_normal<dim>(x).norm() > least_height * longest * longest);
}

} // namespace

template <int dim> std::optional<SurfaceFault> find_fault(const Surface<dim>& surface) {
  if (surface.facets.empty())
    return SurfaceFault{std::nullopt, "the surface has no facets"};
  for (std::size_t i = 0; i < surface.vertices.size(); ++i)
    if (!surface.vertices[i].allFinite())
      return SurfaceFault{std::nullopt, fmt::format("vertex {} at {} m is not finite", i,
                                                    text<dim>(surface.vertices[i]))};
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    for (const std::uint32_t vertex : surface.facets[f])
      if (vertex >= surface.vertices.size())
        return SurfaceFault{f, fmt::format("facet {} needs vertex {}, but there are {}", f, vertex,
                                           surface.vertices.size())};
    const FacetShape<dim> x = surface.shape(f);
    if (is_degenerate<dim>(x))
      return SurfaceFault{f, fmt::format("facet {} with a corner at {} m has no {}", f,
                                         text<dim>(x[0]), dim == 2 ? "length" : "area")};
  }
  return std::nullopt;
}

template <int dim> Surface<dim> merge_vertices(const Surface<dim>& surface) {
  const auto before = [](const Vec<dim>& a, const Vec<dim>& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::map<Vec<dim>, std::uint32_t, decltype(before)> number(before);
  Surface<dim> merged;
  merged.facets = surface.facets;
  for (Facet<dim>& facet : merged.facets)
    for (std::uint32_t& vertex : facet) {
      const Vec<dim>& x = surface.vertices[vertex];
      const auto [entry, is_new] =
          number.try_emplace(x, static_cast<std::uint32_t>(merged.vertices.size()));
      if (is_new)
        merged.vertices.push_back(x);
      vertex = entry->second;
    }
  return merged;
}

template <int dim> Box<dim> bounding_box(const Surface<dim>& surface) {
  Box<dim> box{surface.vertices.front(), surface.vertices.front()};
  for (const Vec<dim>& x : surface.vertices) {
    box.lower = box.lower.cwiseMin(x);
    box.upper = box.upper.cwiseMax(x);
  }
  return box;
}

template <int dim> double area(const Surface<dim>& surface) {
  double sum = 0.0;
  for (std::size_t f = 0; f < surface.facets.size(); ++f)
    sum += scaled_normal<dim>(surface.shape(f)).norm();
  return sum / (dim - 1); // the normal of a triangle has twice its area
}

template <int dim> double enclosed_volume(const Surface<dim>& surface) {
  // Divergence theorem with the field x / dim; x from a vertex, so that digits are kept far away.
  const Vec<dim> origin = surface.vertices.front();
  double sum = 0.0;
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const FacetShape<dim> x = surface.shape(f);
    sum += (x[0] - origin).dot(scaled_normal<dim>(x));
  }
  return sum / (dim * (dim - 1));
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template std::optional<SurfaceFault> find_fault<dim>(const Surface<dim>&);                       \
  template Surface<dim> merge_vertices<dim>(const Surface<dim>&);                                  \
  template Box<dim> bounding_box<dim>(const Surface<dim>&);                                        \
  template double area<dim>(const Surface<dim>&);                                                  \
  template double enclosed_volume<dim>(const Surface<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf
