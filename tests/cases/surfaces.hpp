// Small surfaces that several tests start from.
#pragma once

#include "common/surface.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace kerf::cases {

/// Surface of the box from the origin to a corner; each face of two triangles.
inline Surface<3> box_surface(const Vec<3>& size) {
  Surface<3> box;
  for (int corner = 0; corner < 8; ++corner) // bit a: on the upper side of axis a
    box.vertices.emplace_back((corner & 1) * size[0], (corner >> 1 & 1) * size[1],
                              (corner >> 2) * size[2]);
  box.facets = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return box;
}

/// Closed polygon of points that go counter-clockwise.
inline Surface<2> polygon(std::vector<Vec<2>> points) {
  Surface<2> polygon{std::move(points), {}};
  const auto count = static_cast<std::uint32_t>(polygon.vertices.size());
  for (std::uint32_t i = 0; i < count; ++i)
    polygon.facets.push_back({i, (i + 1) % count});
  return polygon;
}

/// Grid of points (u, v), 0 to 1 in steps of 1 / cells, of two triangles a cell.
/// @param position  where a point is, m; (u, v) -> (u, v, 0) is seen from its outside from above
inline Surface<3> sheet(std::uint32_t cells,
                        const std::function<Vec<3>(double u, double v)>& position) {
  Surface<3> sheet;
  const std::uint32_t row = cells + 1;
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i)
      sheet.vertices.push_back(
          position(i / static_cast<double>(cells), j / static_cast<double>(cells)));
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t corner = j * row + i;
      sheet.facets.push_back({corner, corner + 1, corner + row + 1});
      sheet.facets.push_back({corner, corner + row + 1, corner + row});
    }
  return sheet;
}

/// The same sequence everywhere, uniform in [lower, upper].
class Random {
public:
  explicit Random(std::uint32_t seed) : bits_(seed) {}
  double uniform(double lower, double upper) {
    return lower + (upper - lower) * (static_cast<double>(bits_()) / 4294967295.0);
  }
  template <int dim> Vec<dim> point(double lower, double upper) {
    Vec<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = uniform(lower, upper);
    return x;
  }

private:
  std::mt19937 bits_;
};

} // namespace kerf::cases
