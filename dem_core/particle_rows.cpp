#include "dem_core/particle_rows.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace kerf::dem {

namespace {

/// In [0, length], exact but for one rounding.
double into_period(double x, double length) {
  if (!(length > 0.0) || (x >= 0.0 && x < length))
    return x;
  x = std::fmod(x, length);
  return x < 0.0 ? x + length : x;
}

template <int dim> Vec<dim> into_period(Vec<dim> x, const Period<dim>& period) {
  for (int a = 0; a < dim; ++a)
    x[a] = into_period(x[a], period.length[a]);
  return x;
}

} // namespace

template <int dim>
ParticleRows<dim>::ParticleRows(std::span<const std::uint32_t> particles,
                                std::span<const Vec<dim>> position,
                                std::span<const double> all_radii, double width, double farthest,
                                const Period<dim>& period)
    : period_(period), farthest_(farthest), width_(Vec<dim>::Constant(width)) {
  for (int a = 1; a < dim; ++a)
    if (const double length = period.length[a]; length > 0.0) {
      count_[a - 1] = static_cast<std::int64_t>(std::clamp(length / width, 1.0, 1e6));
      width_[a] = length / static_cast<double>(count_[a - 1]);
    }
  const auto count = static_cast<std::int64_t>(particles.size());
  std::vector<Cell> cells(particles.size());
#pragma omp parallel for schedule(static) if (particles.size() > particles_worth_threads)
  for (std::int64_t k = 0; k < count; ++k)
    cells[k] = cell_of(into_period(position[particles[k]], period));

  const std::vector<std::uint32_t> row_of = assign_rows(cells);
  for (std::vector<double>& coordinate : x)
    coordinate.resize(particles.size() + padding);
  radius.resize(particles.size() + padding);
  particle.resize(particles.size() + padding);
  for (std::size_t k = 0; k < particles.size(); ++k)
    particle[rows_[row_of[k]].end++] = particles[k];

  const auto rows = static_cast<std::int64_t>(rows_.size());
#pragma omp parallel for schedule(static) if (particles.size() > particles_worth_threads)
  for (std::int64_t r = 0; r < rows; ++r)
    arrange(rows_[r], position, all_radii);
}

template <int dim> Box<dim> ParticleRows<dim>::bounds(const Row& row) const {
  Box<dim> box{position(row.begin), position(row.begin)};
  for (std::uint32_t k = row.begin; k < row.end; ++k) {
    box.lower = box.lower.cwiseMin(position(k));
    box.upper = box.upper.cwiseMax(position(k));
  }
  return box;
}

template <int dim> std::int64_t ParticleRows<dim>::cell_along(int axis, double coordinate) const {
  return static_cast<std::int64_t>(
      std::floor(std::clamp(coordinate, -farthest_, farthest_) / width_[axis]));
}

template <int dim>
typename ParticleRows<dim>::Cell ParticleRows<dim>::cell_of(const Vec<dim>& position) const {
  Cell cell;
  for (int a = 1; a < dim; ++a) {
    cell[a - 1] = cell_along(a, position[a]);
    if (count_[a - 1] > 0) // the end of the period belongs to it
      cell[a - 1] = std::min(cell[a - 1], count_[a - 1] - 1);
  }
  return cell;
}

/// Where the hash has this cell, or a free place for it.
template <int dim> std::size_t ParticleRows<dim>::slot_of(const Cell& cell) const {
  std::uint64_t hash = 0;
  for (const std::int64_t i : cell)
    hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u;
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = (hash >> 24) & mask;
  while (slots_[slot] != none && rows_[slots_[slot]].cell != cell)
    slot = (slot + 1) & mask;
  return slot;
}

/// Makes the rows, each still empty at the place that its particles will take.
/// @return the row of each particle
template <int dim>
std::vector<std::uint32_t> ParticleRows<dim>::assign_rows(std::span<const Cell> cells) {
  slots_.assign(std::bit_ceil(2 * cells.size()), none);
  std::vector<std::uint32_t> row_of(cells.size());
  for (std::size_t k = 0; k < cells.size(); ++k) {
    std::uint32_t& row = slots_[slot_of(cells[k])];
    if (row == none) {
      row = static_cast<std::uint32_t>(rows_.size());
      rows_.push_back({cells[k], 0, 0});
    }
    row_of[k] = row;
    ++rows_[row].end;
  }
  std::uint32_t begin = 0;
  for (Row& row : rows_) {
    const std::uint32_t particles = row.end;
    row.begin = row.end = begin;
    begin += particles;
  }
  return row_of;
}

/// Sorts a row and copies what its particles have.
template <int dim>
void ParticleRows<dim>::arrange(const Row& row, std::span<const Vec<dim>> position,
                                std::span<const double> all_radii) {
  struct Member {
    Vec<dim> x;
    std::uint32_t particle;
  };
  std::vector<Member> members;
  members.reserve(row.end - row.begin);
  for (std::uint32_t k = row.begin; k < row.end; ++k)
    members.push_back({into_period(position[particle[k]], period_), particle[k]});
  std::sort(members.begin(), members.end(),
            [](const Member& a, const Member& b) { return a.x[0] < b.x[0]; });
  for (std::uint32_t k = row.begin; k < row.end; ++k) {
    const Member& member = members[k - row.begin];
    for (int a = 0; a < dim; ++a)
      x[a][k] = member.x[a];
    radius[k] = all_radii[member.particle];
    particle[k] = member.particle;
  }
}

template class ParticleRows<2>;
template class ParticleRows<3>;

} // namespace kerf::dem
