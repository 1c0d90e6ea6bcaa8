#include "dem_core/lattice.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

namespace kerf::dem {

namespace {

template <int dim> void check(const Lattice<dim>& lattice) {
  const bool only_3d = lattice.type == LatticeType::cubic || lattice.type == LatticeType::fcc;
  const bool only_2d =
      lattice.type == LatticeType::triangular || lattice.type == LatticeType::square;
  if ((dim == 2 && only_3d) || (dim == 3 && only_2d))
    throw std::invalid_argument(fmt::format("this lattice does not exist in {}D", dim));
  if (!(lattice.spacing > 0.0) || !std::isfinite(lattice.spacing))
    throw std::invalid_argument(fmt::format("spacing {} m must be positive", lattice.spacing));
  for (int a = 0; a < dim; ++a) {
    const int count = lattice.count[static_cast<std::size_t>(a)];
    if (count < 1)
      throw std::invalid_argument(fmt::format("count {} along axis {} must be positive", count, a));
    if (lattice.type == LatticeType::chain && a > 0 && count != 1)
      throw std::invalid_argument(fmt::format("a chain has one particle along axis {}", a));
  }
}

/// Calls use(index) for every index of a grid, x fastest.
template <int dim, class Use> void for_each_index(const std::array<int, dim>& count, Use use) {
  std::array<int, dim> index{};
  for (;;) {
    use(index);
    std::size_t a = 0;
    while (a < dim && ++index[a] == count[a])
      index[a++] = 0;
    if (a == dim)
      return;
  }
}

template <int dim> Vec<dim> to_vector(const std::array<int, dim>& index) {
  Vec<dim> vector;
  for (int a = 0; a < dim; ++a)
    vector[a] = index[static_cast<std::size_t>(a)];
  return vector;
}

} // namespace

template <int dim> std::vector<Vec<dim>> lattice_points(const Lattice<dim>& lattice) {
  check(lattice);
  const double d = lattice.spacing;
  std::vector<Vec<dim>> points;
  for_each_index<dim>(lattice.count, [&](const std::array<int, dim>& index) {
    Vec<dim> point = d * to_vector<dim>(index);
    if constexpr (dim == 2) {
      if (lattice.type == LatticeType::triangular)
        point = {d * (index[0] + 0.5 * (index[1] % 2)), d * (0.5 * std::numbers::sqrt3 * index[1])};
    } else if (lattice.type == LatticeType::fcc) {
      const double half = d / std::numbers::sqrt2; // half an edge of the cube
      const Vec<3> corner = lattice.origin + 2.0 * half * to_vector<3>(index);
      for (const Vec<3>& offset :
           {Vec<3>(0, 0, 0), Vec<3>(1, 1, 0), Vec<3>(1, 0, 1), Vec<3>(0, 1, 1)})
        points.push_back(corner + half * offset);
      return;
    }
    points.push_back(lattice.origin + point);
  });
  return points;
}

template std::vector<Vec<2>> lattice_points<2>(const Lattice<2>&);
template std::vector<Vec<3>> lattice_points<3>(const Lattice<3>&);

} // namespace kerf::dem
