#include "dem_core/packing/cell_list.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::dem {

template <int dim>
CellList<dim>::CellList(const Box<dim>& bounds, const Period<dim>& period, double reach,
                        std::size_t points)
    : lower_(bounds.lower) {
  const Vec<dim> length = bounds.upper - bounds.lower;
  // Not many more cells than points, however thin the bodies are.
  const double least_width = std::pow(length.prod() / static_cast<double>(points + 1), 1.0 / dim);
  const double width = std::max(reach, least_width);
  std::size_t cells = 1;
  for (int a = 0; a < dim; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    is_periodic_[axis] = period.length[a] > 0.0;
    count_[axis] = std::max<std::size_t>(1, static_cast<std::size_t>(length[a] / width));
    width_[a] = length[a] / static_cast<double>(count_[axis]);
    cells *= count_[axis];
  }
  start_.resize(cells + 1);
}

template <int dim> std::size_t CellList<dim>::cell_along(double coordinate, int axis) const {
  const auto count = count_[static_cast<std::size_t>(axis)];
  const double cell = std::floor((coordinate - lower_[axis]) / width_[axis]);
  return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(count - 1)));
}

template <int dim>
typename CellList<dim>::Range CellList<dim>::cells_near(double coordinate, int axis) const {
  const auto a = static_cast<std::size_t>(axis);
  const std::size_t count = count_[a], own = cell_along(coordinate, axis);
  if (is_periodic_[a])
    return count < 3 ? Range{0, static_cast<int>(count)} : Range{own + count - 1, 3};
  const std::size_t first = own == 0 ? 0 : own - 1, last = std::min(own + 1, count - 1);
  return {first, static_cast<int>(last - first + 1)};
}

template <int dim> std::size_t CellList<dim>::cell_of(const Vec<dim>& point) const {
  std::size_t cell = 0;
  for (int a = dim; a-- > 0;)
    cell = cell * count_[static_cast<std::size_t>(a)] + cell_along(point[a], a);
  return cell;
}

template <int dim>
std::vector<std::uint32_t> CellList<dim>::sort(std::span<const Vec<dim>> points) {
  std::vector<std::size_t> cell(points.size());
  std::fill(start_.begin(), start_.end(), 0u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    cell[i] = cell_of(points[i]);
    ++start_[cell[i] + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c)
    start_[c] += start_[c - 1];
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1), order(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    order[next[cell[i]]++] = i;
  return order;
}

template class CellList<2>;
template class CellList<3>;

} // namespace kerf::dem
