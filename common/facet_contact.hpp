// Where a sphere or disc touches a surface of facets: each face, edge and corner counts once.
#pragma once

#include "common/surface_topology.hpp"
#include "common/vec.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

namespace kerf {

enum class FeatureKind : std::uint8_t { facet, edge, corner };

/// A part of a surface. It keeps its name as long as the topology lives: the key of a history.
struct Feature {
  FeatureKind kind = FeatureKind::facet;
  std::uint32_t index = 0; // of the facet, edge or vertex
  auto operator<=>(const Feature&) const = default;
};

template <int dim> struct FacetContact {
  Feature feature;
  Vec<dim> point;                 // of the surface, nearest to the centre, m
  Vec<dim> normal;                // unit vector from the centre to the surface
  double gap = 0.0;               // m, < 0: pressed together
  std::uint32_t facet = 0;        // one with the feature
  std::array<double, dim> weight; // of its vertices at the point; their sum is one
};

/// Contacts of a sphere with a surface, from the nearest on.
///
/// A feature is touched where the distance from the centre to the surface has a local minimum there
/// below the radius. So a convex edge or corner counts once and not beside its facets, and a
/// concave one not at all: there the two facets count. Both sides of a facet can be touched.
///
/// Every contact pushes the part of the sphere that the tangent planes of nearer contacts leave.
/// In the direction n of a contact at distance d, beside nearer ones with n_a and d_a, that part
/// reaches as far as R = min(radius, d_a / (n_a . n)), so gap = d - R. Coplanar facets count once
/// whether they share vertices or not, the back of a thin plate not beside its front, and the
/// second face of a concave edge grows from nothing as the edge becomes sharper; from an angle of
/// sqrt(2 overlap / radius) on both count in full.
///
/// A centre on the surface itself is pushed to the outside of the facet.
///
/// @param centre    m, in the frame of the vertices
/// @param radius    m, > 0
/// @param vertices  [num_vertices] current positions, m
/// @param near      all facets that the sphere may touch, each once; more do no harm
/// @param contacts  receives the contacts; what it held is dropped, its memory is used again
/// @pre no facet near is degenerate
template <int dim>
void find_contacts(const Vec<dim>& centre, double radius, std::span<const Vec<dim>> vertices,
                   const SurfaceTopology<dim>& topology, std::span<const std::uint32_t> near,
                   std::vector<FacetContact<dim>>& contacts);

/// Marks a contact that continues none.
inline constexpr std::uint32_t no_contact = 0xffffffff;

/// Which contacts of the step before those of now continue, so that friction goes on as the sphere
/// rolls from one feature to the next: the one with the same feature, else one whose feature has
/// been left for one that shares a vertex, with nearly the same normal. None is continued twice.
/// @param before, now  all contacts of the sphere with the surface, in the frame of the vertices
/// @param from         [now] receives the index into before, or no_contact
template <int dim>
void continue_contacts(std::span<const FacetContact<dim>> before,
                       std::span<const FacetContact<dim>> now, const SurfaceTopology<dim>& topology,
                       std::span<std::uint32_t> from);

} // namespace kerf
