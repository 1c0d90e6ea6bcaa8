#include "dem_core/packing/power_cells.hpp"

#include "dem_core/neighbours.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::dem {

namespace {

/// Half space n x <= offset.
template <int dim> struct HalfSpace {
  Vec<dim> normal; // unit vector
  double offset;   // m
};

/// Cuts a polygon; where its rim enters or leaves the half space is added to `crossings`.
template <int dim>
std::vector<Vec<dim>> cut_polygon(const std::vector<Vec<dim>>& polygon,
                                  const HalfSpace<dim>& half_space,
                                  std::vector<Vec<dim>>& crossings) {
  std::vector<Vec<dim>> inside;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec<dim>&p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double at_p = half_space.normal.dot(p) - half_space.offset;
    const double at_q = half_space.normal.dot(q) - half_space.offset;
    if (at_p <= 0.0)
      inside.push_back(p);
    if ((at_p <= 0.0) != (at_q <= 0.0)) {
      inside.push_back(p + at_p / (at_p - at_q) * (q - p));
      crossings.push_back(inside.back());
    }
  }
  return inside;
}

/// A convex body around the origin: one polygon in 2D, one for each face in 3D.
template <int dim> class Cell {
public:
  explicit Cell(double half_width);

  void cut(const HalfSpace<dim>& half_space) {
    std::vector<Vec<dim>> crossings;
    for (auto& face : faces_)
      face = cut_polygon<dim>(face, half_space, crossings);
    std::erase_if(faces_, [](const auto& face) { return face.size() < 3; });
    if constexpr (dim == 3)
      close(half_space, crossings);
  }

  double volume() const {
    double sum = 0.0;
    for (const auto& face : faces_)
      for (std::size_t k = 1; k + 1 < face.size(); ++k)
        sum += cone(face[0], face[k], face[k + 1]);
    return sum;
  }

  double farthest_corner() const {
    double squared = 0.0;
    for (const auto& face : faces_)
      for (const Vec<dim>& corner : face)
        squared = std::max(squared, corner.squaredNorm());
    return std::sqrt(squared);
  }

private:
  /// Area of a triangle; volume between a triangle and the origin, which is inside.
  static double cone(const Vec<dim>& a, const Vec<dim>& b, const Vec<dim>& c) {
    if constexpr (dim == 2)
      return 0.5 * std::abs(moment<2>(b - a, c - a)[0]);
    else
      return std::abs(a.dot(b.cross(c))) / 6.0;
  }

  /// The new face, its corners in their order around it.
  void close(const HalfSpace<dim>& half_space, std::vector<Vec<dim>>& corners) {
    if (corners.size() < 3)
      return;
    Vec<dim> center = Vec<dim>::Zero();
    for (const Vec<dim>& corner : corners)
      center += corner / static_cast<double>(corners.size());
    const Vec<dim> u = half_space.normal.unitOrthogonal(), v = half_space.normal.cross(u);
    const auto angle = [&](const Vec<dim>& corner) {
      return std::atan2(v.dot(corner - center), u.dot(corner - center));
    };
    std::sort(corners.begin(), corners.end(),
              [&](const Vec<dim>& p, const Vec<dim>& q) { return angle(p) < angle(q); });
    faces_.push_back(std::move(corners));
  }

  std::vector<std::vector<Vec<dim>>> faces_;
};

template <> Cell<2>::Cell(double h) : faces_{{{-h, -h}, {h, -h}, {h, h}, {-h, h}}} {}

template <> Cell<3>::Cell(double h) {
  for (int a = 0; a < 3; ++a)
    for (const double side : {-h, h}) {
      auto& face = faces_.emplace_back();
      for (const auto& [s, t] : {std::pair(-h, -h), {h, -h}, {h, h}, {-h, h}}) {
        Vec<3> corner;
        corner[a] = side;
        corner[(a + 1) % 3] = s;
        corner[(a + 2) % 3] = t;
        face.push_back(corner);
      }
    }
}

} // namespace

template <int dim>
PowerCells power_cells(std::span<const Vec<dim>> position, std::span<const double> radius) {
  const std::size_t count = radius.size();
  const double longest_tangent = 1.5 * *std::max_element(radius.begin(), radius.end());
  std::vector<std::vector<std::uint32_t>> near(count);
  for (const Pair& pair : find_pairs<dim>(position, radius, 2.0 * longest_tangent, {})) {
    near[pair.first].push_back(pair.second);
    near[pair.second].push_back(pair.first);
  }
  PowerCells cells{std::vector<double>(count, 0.0), std::vector<std::uint8_t>(count, 0)};
#pragma omp parallel for schedule(dynamic, 64)
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<HalfSpace<dim>> half_spaces;
    for (const std::uint32_t j : near[i]) {
      const Vec<dim> branch = position[j] - position[i];
      const double d = branch.norm();
      half_spaces.push_back(
          {branch / d, 0.5 * (d + (radius[i] * radius[i] - radius[j] * radius[j]) / d)});
    }
    std::sort(half_spaces.begin(), half_spaces.end(),
              [](const auto& a, const auto& b) { return a.offset < b.offset; });
    const double farthest = std::hypot(radius[i], longest_tangent);
    Cell<dim> cell(1.5 * farthest);
    for (const auto& half_space : half_spaces) {
      if (half_space.offset > cell.farthest_corner())
        break;
      cell.cut(half_space);
    }
    cells.is_closed[i] = cell.farthest_corner() <= farthest;
    cells.volume[i] = cell.volume();
  }
  return cells;
}

template PowerCells power_cells<2>(std::span<const Vec<2>>, std::span<const double>);
template PowerCells power_cells<3>(std::span<const Vec<3>>, std::span<const double>);

} // namespace kerf::dem
