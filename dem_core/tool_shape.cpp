#include "dem_core/tool_shape.hpp"

#include <stdexcept>

namespace kerf::dem {

namespace {

template <int dim> const Surface<dim>& checked(const Surface<dim>& surface) {
  if (const auto fault = find_fault(surface))
    throw std::invalid_argument(fault->sentence);
  return surface;
}

template <int dim> Plane<dim> checked(const Plane<dim>& plane) {
  if (!plane.point.allFinite() || !plane.normal.allFinite() || !(plane.normal.norm() > 0.0))
    throw std::invalid_argument("a plane needs a finite point and a normal that is not zero");
  return {plane.point, plane.normal.normalized()};
}

template <int dim> double height(const Plane<dim>& plane, const Vec<dim>& x) {
  return (x - plane.point).dot(plane.normal);
}

} // namespace

template <int dim> ToolShape<dim>::ToolShape(const Plane<dim>& plane) : shape_(checked(plane)) {}

template <int dim>
ToolShape<dim>::ToolShape(const Surface<dim>& surface) : shape_(Facets(checked(surface))) {}

template <int dim>
void ToolShape<dim>::near(const Vec<dim>& centre, double reach,
                          std::vector<std::uint32_t>& found) const {
  if (const auto* facets = std::get_if<Facets>(&shape_)) {
    facets->grid.near(centre, reach, found);
    return;
  }
  found.clear();
  if (height(std::get<Plane<dim>>(shape_), centre) <= reach)
    found.push_back(0);
}

template <int dim>
void ToolShape<dim>::find_contacts(const Vec<dim>& centre, double radius,
                                   std::span<const std::uint32_t> near,
                                   std::vector<FacetContact<dim>>& contacts) const {
  if (const auto* facets = std::get_if<Facets>(&shape_)) {
    kerf::find_contacts<dim>(centre, radius, facets->surface.vertices, facets->topology, near,
                             contacts);
    return;
  }
  contacts.clear();
  const auto& plane = std::get<Plane<dim>>(shape_);
  const double h = height(plane, centre);
  if (!near.empty() && h < radius)
    contacts.push_back({.feature = {FeatureKind::facet, 0},
                        .point = centre - h * plane.normal,
                        .normal = -plane.normal,
                        .gap = h - radius,
                        .facet = 0,
                        .weight = {1.0}});
}

template <int dim>
void ToolShape<dim>::continue_contacts(std::span<const FacetContact<dim>> before,
                                       std::span<const FacetContact<dim>> now,
                                       std::span<std::uint32_t> from) const {
  if (const auto* facets = std::get_if<Facets>(&shape_))
    kerf::continue_contacts<dim>(before, now, facets->topology, from);
  else if (!now.empty())
    from[0] = before.empty() ? no_contact : 0;
}

template <int dim> const Surface<dim>* ToolShape<dim>::surface() const {
  const auto* facets = std::get_if<Facets>(&shape_);
  return facets ? &facets->surface : nullptr;
}

template class ToolShape<2>;
template class ToolShape<3>;

} // namespace kerf::dem
