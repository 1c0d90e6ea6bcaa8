// What a rigid tool looks like: a plane or a surface of facets, in the frame of the body.
#pragma once

#include "common/facet_contact.hpp"
#include "common/facet_grid.hpp"
#include "common/surface.hpp"
#include "common/surface_topology.hpp"

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace kerf::dem {

/// All space behind a plane is solid.
template <int dim> struct Plane {
  Vec<dim> point;  // one of the plane, m
  Vec<dim> normal; // into free space, of any length
};

/// Points, normals and features are those of the body at the start; see Pose.
template <int dim> class ToolShape {
public:
  /// @throws std::invalid_argument when a number is not finite or the normal is zero
  explicit ToolShape(const Plane<dim>& plane);
  /// @throws std::invalid_argument with what find_fault() says
  explicit ToolShape(const Surface<dim>& surface);

  /// Lists the facets within reach of a centre, or more; a plane is facet 0. See FacetGrid.
  /// @param reach  m
  /// @param found  receives the facets; what it held is dropped, its memory is used again
  void near(const Vec<dim>& centre, double reach, std::vector<std::uint32_t>& found) const;

  /// Contacts of a sphere with the facets near it, see kerf::find_contacts(). A plane has one at
  /// most; its normal points into the solid, however deep the centre is.
  void find_contacts(const Vec<dim>& centre, double radius, std::span<const std::uint32_t> near,
                     std::vector<FacetContact<dim>>& contacts) const;

  /// Which contacts before those of now go on with, see kerf::continue_contacts().
  void continue_contacts(std::span<const FacetContact<dim>> before,
                         std::span<const FacetContact<dim>> now,
                         std::span<std::uint32_t> from) const;

  /// The facets, for output; nothing for a plane.
  const Surface<dim>* surface() const;

private:
  struct Facets {
    explicit Facets(const Surface<dim>& s) : surface(s), topology(s), grid(s) {}
    Surface<dim> surface;
    SurfaceTopology<dim> topology;
    FacetGrid<dim> grid;
  };
  std::variant<Plane<dim>, Facets> shape_;
};

} // namespace kerf::dem
