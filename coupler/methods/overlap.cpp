#include "coupler/methods/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace kerf::coupler {
namespace {

template <int dim>
double distance_to_segment(const Vec<dim>& p, const Vec<dim>& a, const Vec<dim>& b) {
  const Vec<dim> edge = b - a;
  const double length2 = edge.squaredNorm();
  const double s = length2 > 0.0 ? std::clamp(edge.dot(p - a) / length2, 0.0, 1.0) : 0.0;
  return (p - a - s * edge).norm();
}

double distance_to_triangle(const Vec<3>& p, const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
  const Vec<3> normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  if (area2 > 0.0) {
    const bool inside = (b - a).cross(p - a).dot(normal) >= 0.0 &&
                        (c - b).cross(p - b).dot(normal) >= 0.0 &&
                        (a - c).cross(p - c).dot(normal) >= 0.0;
    if (inside)
      return std::abs((p - a).dot(normal)) / std::sqrt(area2);
  }
  return std::min({distance_to_segment<3>(p, a, b), distance_to_segment<3>(p, b, c),
                   distance_to_segment<3>(p, c, a)});
}

} // namespace

template <int dim>
std::vector<double>
distance_to_boundary(std::span<const std::uint32_t> faces, std::span<const double> nodes,
                     std::span<const double> points, double far, const Period<dim>& period) {
  constexpr int face_nodes = dim == 2 ? 2 : 4;
  const auto node = [&](std::size_t k) {
    return Vec<dim>(Eigen::Map<const Vec<dim>>(nodes.data() + dim * faces[k]));
  };
  // Points outside the boundary's box by more than `far` need no search.
  Vec<dim> low = Vec<dim>::Constant(std::numeric_limits<double>::max()), high = -low;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    low = low.cwiseMin(node(k));
    high = high.cwiseMax(node(k));
  }
  for (int a = 0; a < dim; ++a)
    if (period.length[a] > 0.0) {
      low[a] = -std::numeric_limits<double>::infinity();
      high[a] = std::numeric_limits<double>::infinity();
    }

  std::vector<double> distance(points.size() / dim, std::numeric_limits<double>::infinity());
  for (std::size_t p = 0; p < distance.size(); ++p) {
    const Vec<dim> x = Eigen::Map<const Vec<dim>>(points.data() + dim * p);
    if (((low - x).array() > far).any() || ((x - high).array() > far).any())
      continue;
    for (std::size_t f = 0; f < faces.size(); f += face_nodes) {
      const Vec<dim> first = x + period.shortest(node(f) - x); // the image nearest to the point
      const auto corner = [&](std::size_t k) {
        return Vec<dim>(first + period.shortest(node(f + k) - node(f)));
      };
      double d;
      if constexpr (dim == 2)
        d = distance_to_segment<2>(x, first, corner(1));
      else
        d = std::min(distance_to_triangle(x, first, corner(1), corner(2)),
                     distance_to_triangle(x, first, corner(2), corner(3)));
      distance[p] = std::min(distance[p], d);
    }
  }
  return distance;
}

void overlap_alpha(std::span<const double> distance, double width, std::span<double> alpha) {
  if (distance.size() != alpha.size())
    throw std::invalid_argument("overlap_alpha: " + std::to_string(distance.size()) +
                                " distances but " + std::to_string(alpha.size()) + " shares");
  if (!(width > 0.0))
    throw std::invalid_argument("overlap_alpha: the width must be positive, it is " +
                                std::to_string(width) + " m");
  for (std::size_t p = 0; p < distance.size(); ++p)
    alpha[p] = std::min(distance[p] / width, 1.0); // eq. 28
}

template std::vector<double> distance_to_boundary<2>(std::span<const std::uint32_t>,
                                                     std::span<const double>,
                                                     std::span<const double>, double,
                                                     const Period<2>&);
template std::vector<double> distance_to_boundary<3>(std::span<const std::uint32_t>,
                                                     std::span<const double>,
                                                     std::span<const double>, double,
                                                     const Period<3>&);

} // namespace kerf::coupler
