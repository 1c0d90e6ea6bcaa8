#include "common/facet_contact.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kerf {

namespace {

/// Rounding of a share of an edge or of a height. A centre on the border between two features may
/// count for both; the second then has no part of the sphere left.
constexpr double slack = 1e-9;

/// Overlaps below this share of the radius are rounding.
constexpr double least_overlap = 1e-12;

/// Position of the foot of x on the line from a (0) to b (1).
template <int dim> double share_along(const Vec<dim>& x, const Vec<dim>& a, const Vec<dim>& b) {
  const Vec<dim> edge = b - a;
  return (x - a).dot(edge) / edge.squaredNorm();
}

/// Position of the foot of x on the height of a triangle, from the edge a b (0) to the tip (1).
double share_of_height(const Vec<3>& x, const Vec<3>& a, const Vec<3>& b, const Vec<3>& tip) {
  const Vec<3> height = tip - a - share_along<3>(tip, a, b) * (b - a);
  return (x - a).dot(height) / height.squaredNorm();
}

/// One sphere in front of a surface. Every feature belongs to the first of its facets, so that it
/// is looked at once.
template <int dim> class Probe {
public:
  Probe(const Vec<dim>& centre, double radius, std::span<const Vec<dim>> vertices,
        const SurfaceTopology<dim>& topology, std::vector<FacetContact<dim>>& contacts)
      : centre_(centre), radius_(radius), vertices_(vertices), topology_(topology),
        contacts_(contacts) {}

  void touch(std::uint32_t f) {
    const Facet<dim>& facet = topology_.facets[f];
    touch_facet(f);
    if constexpr (dim == 3)
      for (const std::uint32_t e : topology_.edges_of_facet[f])
        if (topology_.facets_of_edge[e].front() == f)
          touch_edge(e, f);
    for (const std::uint32_t vertex : facet)
      if (topology_.facets_of_vertex[vertex].front() == f)
        touch_corner(vertex, f);
  }

private:
  Vec<dim> outward_normal(std::uint32_t f) const {
    FacetShape<dim> x;
    for (int k = 0; k < dim; ++k)
      x[k] = vertices_[topology_.facets[f][k]];
    return scaled_normal<dim>(x).normalized();
  }

  /// Weights of the vertices of a facet at the foot of the centre on its plane.
  std::array<double, dim> weights(std::uint32_t f) const {
    const Facet<dim>& v = topology_.facets[f];
    if constexpr (dim == 2) {
      const double share = share_along<2>(centre_, vertices_[v[0]], vertices_[v[1]]);
      return {1.0 - share, share};
    } else {
      const Vec<3>&a = vertices_[v[0]], &b = vertices_[v[1]], &c = vertices_[v[2]];
      const double at_b = share_of_height(centre_, c, a, b);
      const double at_c = share_of_height(centre_, a, b, c);
      return {1.0 - at_b - at_c, at_b, at_c};
    }
  }

  void touch_facet(std::uint32_t f) {
    const Vec<dim> outward = outward_normal(f);
    const double height = (centre_ - vertices_[topology_.facets[f][0]]).dot(outward);
    if (std::abs(height) >= radius_)
      return;
    const std::array<double, dim> weight = weights(f);
    if (*std::min_element(weight.begin(), weight.end()) < -slack)
      return;
    const Vec<dim> normal = height < 0.0 ? outward : Vec<dim>(-outward);
    contacts_.push_back({.feature = {FeatureKind::facet, f},
                         .point = centre_ - height * outward,
                         .normal = normal,
                         .gap = std::abs(height) - radius_,
                         .facet = f,
                         .weight = weight});
  }

  /// An edge is nearest when the centre is beside its ends and inside none of its facets.
  void touch_edge(std::uint32_t e, std::uint32_t f) requires(dim == 3) {
    const auto [first, second] = topology_.edges[e];
    const Vec<3>&a = vertices_[first], &b = vertices_[second];
    const double share = share_along<3>(centre_, a, b);
    const Vec<3> foot = a + share * (b - a);
    if (share < -slack || share > 1.0 + slack || (foot - centre_).norm() >= radius_)
      return;
    for (const std::uint32_t beside : topology_.facets_of_edge[e]) {
      const Facet<3>& v = topology_.facets[beside];
      // Of the three, the one that is not on the edge.
      const std::uint32_t tip = v[0] + v[1] + v[2] - first - second;
      if (share_of_height(centre_, a, b, vertices_[tip]) > slack)
        return;
    }
    std::array<double, 3> weight{};
    for (int k = 0; k < 3; ++k)
      weight[k] = topology_.facets[f][k] == first    ? 1.0 - share
                  : topology_.facets[f][k] == second ? share
                                                     : 0.0;
    add_point({FeatureKind::edge, e}, foot, f, weight);
  }

  /// A corner is nearest when the centre is beyond the ends of all of its edges.
  void touch_corner(std::uint32_t vertex, std::uint32_t f) {
    const Vec<dim>& corner = vertices_[vertex];
    if ((corner - centre_).norm() >= radius_)
      return;
    for (const std::uint32_t e : topology_.edges_of_vertex[vertex]) {
      const auto [first, second] = topology_.edges[e];
      const Vec<dim>& other = vertices_[first == vertex ? second : first];
      if (share_along<dim>(centre_, corner, other) > slack)
        return;
    }
    std::array<double, dim> weight{};
    for (int k = 0; k < dim; ++k)
      weight[k] = topology_.facets[f][k] == vertex ? 1.0 : 0.0;
    add_point({FeatureKind::corner, vertex}, corner, f, weight);
  }

  void add_point(Feature feature, const Vec<dim>& point, std::uint32_t f,
                 const std::array<double, dim>& weight) {
    const Vec<dim> branch = point - centre_;
    const double distance = branch.norm();
    contacts_.push_back({.feature = feature,
                         .point = point,
                         .normal = distance > least_overlap * radius_
                                       ? Vec<dim>(branch / distance)
                                       : Vec<dim>(-outward_normal(f)),
                         .gap = distance - radius_,
                         .facet = f,
                         .weight = weight});
  }

  const Vec<dim>& centre_;
  double radius_;
  std::span<const Vec<dim>> vertices_;
  const SurfaceTopology<dim>& topology_;
  std::vector<FacetContact<dim>>& contacts_;
};

/// Leaves to every contact the part of the sphere that nearer ones do not push, and drops those
/// that are left with none.
template <int dim>
void share_the_sphere(const Vec<dim>& centre, double radius,
                      std::vector<FacetContact<dim>>& contacts) {
  std::sort(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
    return a.gap != b.gap ? a.gap < b.gap : a.feature < b.feature;
  });
  const auto distance = [&](const FacetContact<dim>& contact) {
    return (contact.point - centre).dot(contact.normal);
  };
  auto end = contacts.begin(); // of those that stay
  for (FacetContact<dim>& contact : contacts) {
    double reach = radius;
    for (auto nearer = contacts.begin(); nearer != end; ++nearer)
      if (const double cosine = nearer->normal.dot(contact.normal); cosine > 0.0)
        reach = std::min(reach, distance(*nearer) / cosine);
    contact.gap = distance(contact) - reach;
    if (contact.gap < -least_overlap * radius)
      *end++ = contact;
  }
  contacts.erase(end, contacts.end());
}

template <int dim>
bool share_a_vertex(const Feature& a, const Feature& b, const SurfaceTopology<dim>& topology) {
  const auto vertices = [&](const Feature& feature) -> std::span<const std::uint32_t> {
    switch (feature.kind) {
    case FeatureKind::facet:
      return topology.facets[feature.index];
    case FeatureKind::edge:
      return topology.edges[feature.index];
    case FeatureKind::corner:
      break;
    }
    return {&feature.index, 1};
  };
  return std::ranges::any_of(vertices(a), [&](std::uint32_t vertex) {
    return std::ranges::find(vertices(b), vertex) != vertices(b).end();
  });
}

} // namespace

template <int dim>
void find_contacts(const Vec<dim>& centre, double radius, std::span<const Vec<dim>> vertices,
                   const SurfaceTopology<dim>& topology, std::span<const std::uint32_t> near,
                   std::vector<FacetContact<dim>>& contacts) {
  contacts.clear();
  Probe<dim> probe(centre, radius, vertices, topology, contacts);
  for (const std::uint32_t f : near)
    probe.touch(f);
  share_the_sphere<dim>(centre, radius, contacts);
}

template <int dim>
void continue_contacts(std::span<const FacetContact<dim>> before,
                       std::span<const FacetContact<dim>> now, const SurfaceTopology<dim>& topology,
                       std::span<std::uint32_t> from) {
  assert(from.size() == now.size());
  constexpr double least_cosine = 0.9; // rolling turns the normal by far less in a step
  for (std::size_t k = 0; k < now.size(); ++k) {
    const auto same = std::ranges::find(before, now[k].feature, &FacetContact<dim>::feature);
    from[k] = same == before.end() ? no_contact : static_cast<std::uint32_t>(same - before.begin());
  }
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (from[k] != no_contact)
      continue;
    double best = least_cosine;
    for (std::uint32_t b = 0; b < before.size(); ++b) {
      const double cosine = before[b].normal.dot(now[k].normal);
      const bool is_free = std::ranges::find(from, b) == from.end();
      if (cosine > best && is_free &&
          share_a_vertex<dim>(before[b].feature, now[k].feature, topology)) {
        from[k] = b;
        best = cosine;
      }
    }
  }
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template void find_contacts<dim>(const Vec<dim>&, double, std::span<const Vec<dim>>,             \
                                   const SurfaceTopology<dim>&, std::span<const std::uint32_t>,    \
                                   std::vector<FacetContact<dim>>&);                               \
  template void continue_contacts<dim>(std::span<const FacetContact<dim>>,                         \
                                       std::span<const FacetContact<dim>>,                         \
                                       const SurfaceTopology<dim>&, std::span<std::uint32_t>);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf
