#include "dem_core/neighbours.hpp"

#include "dem_core/particle_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace kerf::dem {

namespace {

/// What find_pairs() is asked for.
template <int dim> struct Query {
  std::span<const Vec<dim>> position; // m
  std::span<const double> radius;     // m
  double reach;                       // m
  const Period<dim>& period;
};

/// Particles of which the largest is less than twice the smallest, so that small ones do not crowd
/// the cells of large ones.
template <int dim> struct Level {
  double largest; // radius, m
  ParticleRows<dim> rows;
};

/// From small to large.
template <int dim> std::vector<Level<dim>> levels_of(const Query<dim>& query) {
  const double smallest = *std::min_element(query.radius.begin(), query.radius.end());
  std::vector<std::vector<std::uint32_t>> members;
  for (std::uint32_t i = 0; i < query.radius.size(); ++i) {
    if (!query.position[i].allFinite())
      continue;
    const auto number =
        static_cast<std::size_t>(std::max(0, std::ilogb(query.radius[i] / smallest)));
    if (number >= members.size())
      members.resize(number + 1);
    members[number].push_back(i);
  }
  std::vector<Level<dim>> levels;
  for (const std::vector<std::uint32_t>& own : members) {
    double largest = 0.0;
    for (const std::uint32_t i : own)
      largest = std::max(largest, query.radius[i]);
    const double width = std::max(2.0 * largest + query.reach, largest);
    if (!own.empty())
      levels.push_back({largest, ParticleRows<dim>(own, query.position, query.radius, width,
                                                   1e15 * smallest, query.period)});
  }
  return levels;
}

/// Finds the pairs between two levels, or within one.
template <int dim> class Search {
public:
  using Rows = ParticleRows<dim>;
  using Row = typename Rows::Row;

  Search(const Query<dim>& query, const Level<dim>& from, const Level<dim>& to,
         std::vector<Pair>& found)
      : query_(query), from_(from.rows), to_(to.rows), found_(found) {
    // Coordinates of images are off by a few roundings of the period.
    const double rounding = 1e-15 * query.period.length.maxCoeff();
    const double longest = std::max(0.0, from.largest + to.largest + query.reach);
    farthest_ = longest * (1.0 + 1e-9) + rounding;
    doubt_ = farthest_ * (1e-9 * farthest_ + 4.0 * rounding);
  }

  /// Finds those of one row. Two images of rows of one level meet once, from the side where the
  /// other is the later one.
  void find(const Row& row) {
    const bool is_one_level = &from_ == &to_;
    const int images = query_.period.length[0] > 0.0 ? 1 : 0; // along x, on either side
    to_.visit_near(from_.bounds(row), farthest_,
                   [&](const Row& other, const auto& cell, auto shift) {
                     for (int image = -images; image <= images; ++image) {
                       const auto order = cell != row.cell ? cell <=> row.cell : image <=> 0;
                       if (is_one_level && order < 0)
                         continue;
                       shift[0] = image * query_.period.length[0];
                       sweep(row, other, shift, is_one_level && order == 0);
                     }
                   });
  }

private:
  /// Goes along both rows at once: whoever is near along x lies in a window that moves on.
  void sweep(const Row& row, const Row& other, const Vec<dim>& shift, bool is_itself) {
    constexpr std::uint32_t stride = 4; // so long that the window seldom moves
    const double* x = to_.x[0].data();
    std::uint32_t begin = other.begin;
    for (std::uint32_t i = row.begin; i < row.end; ++i) {
      const Vec<dim> from = from_.position(i) - shift;
      if (x[other.end - 1] - from[0] < -farthest_)
        return;
      while (begin + stride <= other.end && x[begin + stride - 1] - from[0] < -farthest_)
        begin += stride;
      std::uint32_t k = is_itself ? i + 1 : begin;
      for (; k < other.end && x[k] - from[0] <= farthest_; k += lanes)
        compare(i, from, k, other.end);
    }
  }

  /// Takes those of the next few particles from k that are near particle i with an image at `from`.
  void compare(std::uint32_t i, const Vec<dim>& from, std::uint32_t k, std::uint32_t end) {
    Lanes distance2 = (Lanes::Map(&to_.x[0][k]) - from[0]).square();
    for (int a = 1; a < dim; ++a)
      distance2 += (Lanes::Map(&to_.x[a][k]) - from[a]).square();
    const Lanes limit = Lanes::Map(&to_.radius[k]) + (from_.radius[i] + query_.reach);
    const Lanes excess = distance2 - limit * limit.abs(); // m²
#pragma GCC unroll 8
    for (std::uint32_t l = 0; l < lanes; ++l)
      if (excess[l] <= doubt_ && k + l < end &&
          (excess[l] < -doubt_ || counts(i, k + l, to_.position(k + l) - from))) {
        const auto [first, second] = std::minmax(from_.particle[i], to_.particle[k + l]);
        found_.push_back({first, second});
      }
  }

  /// Decides from the distance itself. Of two images half a period away Period chooses one.
  bool counts(std::uint32_t i, std::uint32_t k, const Vec<dim>& branch) const {
    const std::uint32_t one = from_.particle[i], two = to_.particle[k];
    const Vec<dim> shortest = query_.period.shortest(query_.position[two] - query_.position[one]);
    for (int a = 0; a < dim; ++a)
      if (query_.period.length[a] > 0.0 &&
          std::abs(branch[a] - shortest[a]) > 0.5 * query_.period.length[a])
        return false;
    return shortest.norm() - (query_.radius[one] + query_.radius[two]) <= query_.reach;
  }

  static constexpr std::uint32_t lanes = Rows::padding;
  using Lanes = Eigen::Array<double, lanes, 1>;

  const Query<dim>& query_;
  const Rows &from_, &to_;
  std::vector<Pair>& found_;
  double farthest_; // distance at which two may count, m
  double doubt_;    // of squared distances, m²
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
std::vector<Pair> sorted(std::span<const std::vector<Pair>> lists, std::size_t particles) {
  std::vector<std::uint32_t> offset(particles + 1, 0);
  for (const std::vector<Pair>& list : lists)
    for (const Pair& pair : list)
      ++offset[pair.first + 1];
  for (std::size_t i = 0; i < particles; ++i)
    offset[i + 1] += offset[i];
  std::vector<Pair> pairs(offset.back());
  std::vector<std::uint32_t> next(offset.begin(), offset.end() - 1);
  for (const std::vector<Pair>& list : lists)
    for (const Pair& pair : list)
      pairs[next[pair.first]++] = pair;
  const auto rows = static_cast<std::int64_t>(particles);
#pragma omp parallel for schedule(static) if (particles > particles_worth_threads)
  for (std::int64_t i = 0; i < rows; ++i)
    std::sort(pairs.begin() + offset[i], pairs.begin() + offset[i + 1],
              [](const Pair& a, const Pair& b) { return a.second < b.second; });
  return pairs;
}

} // namespace

template <int dim>
std::vector<Pair> find_pairs(std::span<const Vec<dim>> position, std::span<const double> radius,
                             double reach, const Period<dim>& period) {
  if (radius.empty())
    return {};
  check_period(period, 2.0 * *std::max_element(radius.begin(), radius.end()) + reach);
  const Query<dim> query{position, radius, reach, period};
  const std::vector<Level<dim>> levels = levels_of(query);
  std::vector<std::vector<Pair>> found; // of each thread, in any order
#pragma omp parallel if (position.size() > particles_worth_threads)
  {
    std::vector<Pair> own;
    for (std::size_t from = 0; from < levels.size(); ++from) {
      const auto rows = levels[from].rows.rows();
#pragma omp for schedule(dynamic) nowait
      for (std::size_t r = 0; r < rows.size(); ++r)
        for (std::size_t to = from; to < levels.size(); ++to)
          Search<dim>(query, levels[from], levels[to], own).find(rows[r]);
    }
#pragma omp critical
    found.push_back(std::move(own));
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
