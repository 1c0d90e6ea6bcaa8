#include "common/spatial_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kerf {

namespace {

/// Puts dim - 1 zeros between the bits of a number below 2^21.
std::uint64_t spread(std::uint64_t bits, int dim) {
  std::uint64_t result = 0;
  for (int b = 0; b < 21; ++b)
    result |= (bits >> b & 1u) << (b * dim);
  return result;
}

} // namespace

template <int dim> std::vector<std::uint32_t> spatial_order(std::span<const Vec<dim>> positions) {
  Vec<dim> lower = Vec<dim>::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  for (const Vec<dim>& x : positions)
    if (x.allFinite()) {
      lower = lower.cwiseMin(x);
      upper = upper.cwiseMax(x);
    }
  // About one point a cell; equal cells in all directions keep the blocks round.
  const double edge = (upper - lower).maxCoeff();
  double volume = 1.0;
  for (int a = 0; a < dim; ++a)
    volume *= std::max(upper[a] - lower[a], 1e-3 * edge);
  const double cell = std::max(
      std::pow(volume / static_cast<double>(std::max<std::size_t>(1, positions.size())), 1.0 / dim),
      edge / 2e6);

  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    std::uint64_t key = 0;
    if (!positions[i].allFinite())
      key = std::numeric_limits<std::uint64_t>::max();
    else if (cell > 0.0)
      for (int a = 0; a < dim; ++a)
        key |= spread(static_cast<std::uint64_t>((positions[i][a] - lower[a]) / cell), dim) << a;
    keys[i] = {key, i};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order(keys.size());
  for (std::size_t k = 0; k < keys.size(); ++k)
    order[k] = keys[k].second;
  return order;
}

template std::vector<std::uint32_t> spatial_order<2>(std::span<const Vec<2>>);
template std::vector<std::uint32_t> spatial_order<3>(std::span<const Vec<3>>);

} // namespace kerf
