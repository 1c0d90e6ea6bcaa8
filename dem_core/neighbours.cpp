#include "dem_core/neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace kerf::dem {

namespace {

constexpr std::size_t particles_per_task = 1024;

/// Particles of similar size in a grid of cells, each at least as wide as the farthest distance at
/// which two of them count. Cells are found by a hash, so that a particle that flies away costs no
/// memory.
template <int dim> class Level {
public:
  using Index = std::array<std::int64_t, dim>;
  struct Resident {
    Index cell;
    std::uint32_t particle;
  };

  Level(double smallest_width, const Period<dim>& period) : period_(period) {
    for (int a = 0; a < dim; ++a) {
      const double length = period.length[a];
      count_[a] = length > 0.0
                      ? std::clamp<std::int64_t>(
                            static_cast<std::int64_t>(std::min(length / smallest_width, 1e6)), 1,
                            std::int64_t{1} << 20)
                      : 0;
      width_[a] = length > 0.0 ? length / static_cast<double>(count_[a]) : smallest_width;
    }
  }

  double width() const noexcept { return width_.minCoeff(); }

  /// Takes in the particles, which keep their order inside a cell.
  void fill(std::span<const std::uint32_t> particles, std::span<const Vec<dim>> position) {
    std::size_t buckets = 16;
    while (buckets < particles.size())
      buckets *= 2;
    mask_ = buckets - 1;
    offset_.assign(buckets + 1, 0);
    std::vector<Resident> unsorted(particles.size());
    for (std::size_t k = 0; k < particles.size(); ++k) {
      unsorted[k] = {cell_of(position[particles[k]]), particles[k]};
      ++offset_[bucket(unsorted[k].cell) + 1];
    }
    for (std::size_t b = 0; b < buckets; ++b)
      offset_[b + 1] += offset_[b];
    residents_.resize(particles.size());
    std::vector<std::uint32_t> next(offset_.begin(), offset_.end() - 1);
    for (const Resident& resident : unsorted)
      residents_[next[bucket(resident.cell)]++] = resident;
  }

  /// Calls visit(j) for every particle whose cell touches the box of half the given edge around x;
  /// nobody twice.
  template <class Visit> void visit(const Vec<dim>& x, double reach, Visit visit) const {
    Index low, high;
    for (int a = 0; a < dim; ++a) {
      low[a] = cell_along(x[a] - reach, a);
      high[a] = cell_along(x[a] + reach, a);
      if (count_[a] > 0)
        high[a] = std::min(high[a], low[a] + count_[a] - 1);
    }
    Index cell = low;
    for (;;) {
      visit_cell(wrapped(cell), visit);
      int a = 0;
      while (a < dim && ++cell[a] > high[a]) {
        cell[a] = low[a];
        ++a;
      }
      if (a == dim)
        return;
    }
  }

private:
  std::int64_t cell_along(double x, int a) const {
    // What is farther away than this shares the outermost cell.
    return static_cast<std::int64_t>(std::clamp(std::floor(x / width_[a]), -1e15, 1e15));
  }
  Index wrapped(Index cell) const {
    for (int a = 0; a < dim; ++a)
      if (count_[a] > 0) {
        cell[a] %= count_[a];
        if (cell[a] < 0)
          cell[a] += count_[a];
      }
    return cell;
  }
  Index cell_of(const Vec<dim>& x) const {
    Index cell;
    for (int a = 0; a < dim; ++a)
      cell[a] = cell_along(x[a], a);
    return wrapped(cell);
  }
  std::size_t bucket(const Index& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t i : cell)
      hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u;
    return (hash >> 20) & mask_;
  }
  template <class Visit> void visit_cell(const Index& cell, Visit visit) const {
    const std::size_t b = bucket(cell);
    for (std::uint32_t e = offset_[b]; e < offset_[b + 1]; ++e)
      if (residents_[e].cell == cell)
        visit(residents_[e].particle);
  }

  Period<dim> period_;
  Vec<dim> width_;
  Index count_{}; // cells of a period; 0: does not repeat
  std::size_t mask_ = 0;
  std::vector<std::uint32_t> offset_;
  std::vector<Resident> residents_;
};

/// Levels of doubling size, so that small particles do not crowd the cells of large ones.
template <int dim> class Levels {
public:
  Levels(std::span<const Vec<dim>> position, std::span<const double> radius, double reach,
         const Period<dim>& period) {
    const auto [least, most] = std::minmax_element(radius.begin(), radius.end());
    smallest_ = *least;
    std::vector<std::vector<std::uint32_t>> members(level_of(*most) + 1);
    for (std::uint32_t i = 0; i < position.size(); ++i)
      if (position[i].allFinite())
        members[level_of(radius[i])].push_back(i);
    for (std::size_t l = 0; l < members.size(); ++l) {
      if (members[l].empty())
        continue;
      double largest = 0.0;
      for (const std::uint32_t i : members[l])
        largest = std::max(largest, radius[i]);
      levels_.push_back({l, largest, Level<dim>(2.0 * largest + reach, period)});
      levels_.back().cells.fill(members[l], position);
    }
  }

  /// Calls visit(j) for everybody of the size of particle i or larger who may be near it.
  template <class Visit>
  void visit(const Vec<dim>& x, double radius, double reach, Visit visit) const {
    const std::size_t own = level_of(radius);
    for (const Entry& level : levels_)
      if (level.number >= own)
        level.cells.visit(x, radius + level.largest + reach,
                          [&](std::uint32_t j) { visit(j, level.number > own); });
  }

private:
  std::size_t level_of(double radius) const {
    return static_cast<std::size_t>(std::max(0, std::ilogb(radius / smallest_)));
  }
  struct Entry {
    std::size_t number;
    double largest; // radius, m
    Level<dim> cells;
  };
  double smallest_ = 0.0; // radius, m
  std::vector<Entry> levels_;
};

template <int dim> void check_period(const Period<dim>& period, double distance) {
  for (int a = 0; a < dim; ++a)
    if (period.length[a] > 0.0 && period.length[a] < 2.0 * distance)
      throw std::invalid_argument(
          fmt::format("the period of {} m along {} must be at least {} m, twice the distance at "
                      "which particles may touch",
                      period.length[a], "xyz"[a], 2.0 * distance));
}

/// All pairs in ascending order: counted into rows by their first, then each row is sorted.
std::vector<Pair> sorted(const std::vector<std::vector<Pair>>& parts, std::size_t particles) {
  std::vector<std::uint32_t> offset(particles + 1, 0);
  std::size_t count = 0;
  for (const std::vector<Pair>& part : parts) {
    count += part.size();
    for (const Pair& pair : part)
      ++offset[pair.first + 1];
  }
  for (std::size_t i = 0; i < particles; ++i)
    offset[i + 1] += offset[i];
  std::vector<Pair> pairs(count);
  std::vector<std::uint32_t> next(offset.begin(), offset.end() - 1);
  for (const std::vector<Pair>& part : parts)
    for (const Pair& pair : part)
      pairs[next[pair.first]++] = pair;
  const auto rows = static_cast<std::int64_t>(particles);
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < rows; ++i)
    std::sort(pairs.begin() + offset[i], pairs.begin() + offset[i + 1]);
  return pairs;
}

} // namespace

template <int dim>
std::vector<Pair> find_pairs(std::span<const Vec<dim>> position, std::span<const double> radius,
                             double reach, const Period<dim>& period) {
  if (radius.empty())
    return {};
  check_period(period, 2.0 * *std::max_element(radius.begin(), radius.end()) + reach);
  const Levels<dim> levels(position, radius, reach, period);
  const auto tasks =
      static_cast<std::int64_t>((position.size() + particles_per_task - 1) / particles_per_task);
  std::vector<std::vector<Pair>> found(tasks);
#pragma omp parallel for schedule(dynamic) if (tasks > 1)
  for (std::int64_t t = 0; t < tasks; ++t) {
    const std::size_t begin = static_cast<std::size_t>(t) * particles_per_task;
    const std::size_t end = std::min(position.size(), begin + particles_per_task);
    for (std::size_t at = begin; at < end; ++at) {
      const auto i = static_cast<std::uint32_t>(at);
      if (!position[i].allFinite())
        continue;
      levels.visit(position[i], radius[i], reach, [&](std::uint32_t j, bool is_larger) {
        if (!is_larger && j <= i) // found from the other one
          return;
        const double limit = radius[i] + radius[j] + reach;
        if (period.shortest(position[j] - position[i]).squaredNorm() <=
                limit * limit * (1 + 1e-12) &&
            period.shortest(position[j] - position[i]).norm() - (radius[i] + radius[j]) <= reach)
          found[t].push_back({std::min(i, j), std::max(i, j)});
      });
    }
  }
  return sorted(found, position.size());
}

template <int dim> bool Skin<dim>::is_worn(std::span<const Aligned<Vec<dim>>> displacement) {
  if (bound_ <= 0.5 * width_)
    return false;
  double farthest2 = 0.0; // m²
  const auto count = static_cast<std::int64_t>(displacement.size());
#pragma omp parallel for schedule(static) reduction(max : farthest2)
  for (std::int64_t i = 0; i < count; ++i)
    farthest2 = std::max(farthest2, (displacement[i] - displacement_[i]).squaredNorm());
  bound_ = std::sqrt(farthest2);
  return bound_ > 0.5 * width_;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template std::vector<Pair> find_pairs<dim>(std::span<const Vec<dim>>, std::span<const double>,   \
                                             double, const Period<dim>&);                          \
  template class Skin<dim>;
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
