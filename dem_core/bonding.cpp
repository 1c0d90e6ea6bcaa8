#include "dem_core/bonding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kerf::dem {

namespace {

/// Gaps over r_i + r_j of the pairs, negative where they overlap.
template <int dim>
std::vector<double> gaps_of(std::span<const Pair> pairs, std::span<const Vec<dim>> position,
                            std::span<const double> radius, const Period<dim>& period) {
  std::vector<double> gaps(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    gaps[k] = period.shortest(position[j] - position[i]).norm() / (radius[i] + radius[j]) - 1.0;
  }
  return gaps;
}

/// All pairs with a gap of at most `tolerance`, and more when the radii differ.
template <int dim>
std::vector<Pair> pairs_up_to(double tolerance, std::span<const Vec<dim>> position,
                              std::span<const double> radius, const Period<dim>& period) {
  const double largest = *std::max_element(radius.begin(), radius.end());
  return find_pairs<dim>(position, radius, 2.0 * tolerance * largest, period);
}

} // namespace

template <int dim>
std::vector<Pair> bonded_pairs(std::span<const Vec<dim>> position, std::span<const double> radius,
                               double gap_tolerance, const Period<dim>& period) {
  std::vector<Pair> pairs = pairs_up_to<dim>(gap_tolerance, position, radius, period);
  std::erase_if(pairs, [&](const Pair& pair) {
    const auto [i, j] = pair;
    const double touching = radius[i] + radius[j];
    return period.shortest(position[j] - position[i]).norm() - touching > gap_tolerance * touching;
  });
  return pairs;
}

template <int dim>
double gap_tolerance_for(double coordination_number, std::span<const Vec<dim>> position,
                         std::span<const double> radius, const Period<dim>& period) {
  constexpr double together = 1e-9;
  const double particles = static_cast<double>(radius.size());
  const auto wanted = static_cast<std::size_t>(std::llround(0.5 * coordination_number * particles));
  for (double reach = 0.1; reach < 3.0; reach *= 2.0) {
    std::vector<double> gaps =
        gaps_of<dim>(pairs_up_to<dim>(reach, position, radius, period), position, radius, period);
    std::sort(gaps.begin(), gaps.end());
    if (wanted == 0 || wanted > gaps.size() || gaps[wanted - 1] > reach)
      continue;
    const double tolerance = gaps[wanted - 1] + together;
    if (tolerance < 0.0) {
      const auto touching = std::upper_bound(gaps.begin(), gaps.end(), 0.0) - gaps.begin();
      throw std::invalid_argument(fmt::format(
          "the coordination number {} is below {:.3f}, that of the particles which touch",
          coordination_number, 2.0 * static_cast<double>(touching) / particles));
    }
    return tolerance;
  }
  throw std::invalid_argument(fmt::format("no gap gives {} particles a coordination number of {}",
                                          particles, coordination_number));
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template std::vector<Pair> bonded_pairs<dim>(std::span<const Vec<dim>>, std::span<const double>, \
                                               double, const Period<dim>&);                        \
  template double gap_tolerance_for<dim>(double, std::span<const Vec<dim>>,                        \
                                         std::span<const double>, const Period<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
