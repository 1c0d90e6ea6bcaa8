// A surface of flat facets: segments in 2D, triangles in 3D.
#pragma once

#include "common/vec.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kerf {

/// Vertices of a facet. Seen from outside they go counter-clockwise in 3D; in 2D the body is on the
/// left of the way from the first to the second.
template <int dim> using Facet = std::array<std::uint32_t, dim>;

/// Positions of the vertices of a facet, m.
template <int dim> using FacetShape = std::array<Vec<dim>, dim>;

template <int dim> struct Surface {
  std::vector<Vec<dim>> vertices; // m
  std::vector<Facet<dim>> facets;

  FacetShape<dim> shape(std::size_t facet) const {
    FacetShape<dim> x;
    for (int k = 0; k < dim; ++k)
      x[k] = vertices[facets[facet][k]];
    return x;
  }
};

/// Normal whose length is that of a segment in m, or twice the area of a triangle in m²; outward.
template <int dim> Vec<dim> scaled_normal(const FacetShape<dim>& x) {
  if constexpr (dim == 2)
    return {x[1][1] - x[0][1], x[0][0] - x[1][0]};
  else
    return (x[1] - x[0]).cross(x[2] - x[0]);
}

struct SurfaceFault {
  std::optional<std::size_t> facet; // that is wrong; none: a vertex or the whole
  std::string sentence;             // names the facet or the vertex
};

/// What keeps a surface from being used: no facets, a coordinate that is not finite, a facet of a
/// vertex that is not there, or a facet without extent (its height is below 1e-9 of its longest
/// edge). The first fault, or nothing.
template <int dim> std::optional<SurfaceFault> find_fault(const Surface<dim>& surface);

/// Makes one of all vertices with equal coordinates and drops those without a facet; the order of
/// first use in the facets stays.
template <int dim> Surface<dim> merge_vertices(const Surface<dim>& surface);

/// @pre there is a vertex
template <int dim> Box<dim> bounding_box(const Surface<dim>& surface);

/// Area in m², or length in 2D in m.
template <int dim> double area(const Surface<dim>& surface);

/// Volume in m³, or area in 2D in m², that a closed surface encloses; negative when its normals
/// point inwards.
template <int dim> double enclosed_volume(const Surface<dim>& surface);

} // namespace kerf
