#include "dem_core/neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace kerf::dem {

namespace {

/// A grid of cells, each at least as wide as the distance of a pair. Only occupied cells are
/// stored, so that a particle that flies away costs no memory.
template <int dim> class Cells {
public:
  using Index = std::array<std::int64_t, dim>;

  Cells(double width, const Period<dim>& period) : period_(period) {
    for (int a = 0; a < dim; ++a) {
      const double length = period.length[a];
      count_[a] =
          length > 0.0
              ? std::max<std::int64_t>(1, static_cast<std::int64_t>(std::min(length / width, 1e6)))
              : 0;
      width_[a] = length > 0.0 ? length / static_cast<double>(count_[a]) : width;
    }
  }

  Index cell_of(const Vec<dim>& x) const {
    Index index;
    for (int a = 0; a < dim; ++a) {
      // What is farther away than the key can tell shares the outermost cell.
      const double cell = std::clamp(std::floor(x[a] / width_[a]), -limit, limit);
      index[a] = wrap(static_cast<std::int64_t>(cell), a);
    }
    return index;
  }

  std::int64_t wrap(std::int64_t cell, int a) const {
    if (count_[a] == 0)
      return cell;
    const std::int64_t rest = cell % count_[a];
    return rest < 0 ? rest + count_[a] : rest;
  }

  /// Keys of a cell and all that touch it, each once.
  std::vector<std::uint64_t> around(const Index& cell) const {
    std::vector<std::uint64_t> keys;
    Index index;
    const int all = dim == 2 ? 9 : 27;
    for (int offset = 0; offset < all; ++offset) {
      for (int a = 0, rest = offset; a < dim; ++a, rest /= 3)
        index[a] = wrap(cell[a] + rest % 3 - 1, a);
      keys.push_back(key(index));
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    return keys;
  }

  static std::uint64_t key(const Index& index) {
    std::uint64_t value = 0;
    for (const std::int64_t i : index)
      value = value << 21 | static_cast<std::uint64_t>(i + (std::int64_t{1} << 20));
    return value;
  }

private:
  static constexpr double limit = 1e6; // below 2^20, half the range of a key
  Period<dim> period_;
  Vec<dim> width_;
  Index count_{};
};

template <int dim> void check_period(const Period<dim>& period, double distance) {
  for (int a = 0; a < dim; ++a)
    if (period.length[a] > 0.0 && period.length[a] < 2.0 * distance)
      throw std::invalid_argument(
          fmt::format("the period of {} m along {} must be at least {} m, twice the distance at "
                      "which particles may touch",
                      period.length[a], "xyz"[a], 2.0 * distance));
}

} // namespace

template <int dim>
std::vector<Pair> find_pairs(std::span<const Vec<dim>> position, std::span<const double> radius,
                             double reach, const Period<dim>& period) {
  std::vector<Pair> pairs;
  if (radius.empty())
    return pairs;
  const double farthest = 2.0 * *std::max_element(radius.begin(), radius.end()) + reach;
  check_period(period, farthest);

  const Cells<dim> cells(farthest, period);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted; // key of the cell, particle
  for (std::uint32_t i = 0; i < position.size(); ++i)
    if (position[i].allFinite())
      sorted.emplace_back(Cells<dim>::key(cells.cell_of(position[i])), i);
  std::sort(sorted.begin(), sorted.end());

  for (auto cell = sorted.begin(); cell != sorted.end();) {
    const auto end = std::find_if(cell, sorted.end(),
                                  [&](const auto& entry) { return entry.first != cell->first; });
    for (const std::uint64_t key : cells.around(cells.cell_of(position[cell->second]))) {
      auto other = std::lower_bound(sorted.begin(), sorted.end(), std::pair(key, 0u));
      for (; other != sorted.end() && other->first == key; ++other)
        for (auto own = cell; own != end; ++own) {
          const std::uint32_t i = own->second, j = other->second;
          if (i >= j)
            continue;
          const double distance = period.shortest(position[j] - position[i]).norm();
          if (distance - (radius[i] + radius[j]) <= reach)
            pairs.push_back({i, j});
        }
    }
    cell = end;
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

template <int dim> bool Skin<dim>::is_worn(std::span<const Vec<dim>> displacement) const {
  const double limit = 0.25 * width_ * width_;
  double farthest = 0.0;
  const auto count = static_cast<std::int64_t>(displacement.size());
#pragma omp parallel for schedule(static) reduction(max : farthest)
  for (std::int64_t i = 0; i < count; ++i)
    farthest = std::max(farthest, (displacement[i] - displacement_[i]).squaredNorm());
  return farthest > limit;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template std::vector<Pair> find_pairs<dim>(std::span<const Vec<dim>>, std::span<const double>,   \
                                             double, const Period<dim>&);                          \
  template class Skin<dim>;
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
