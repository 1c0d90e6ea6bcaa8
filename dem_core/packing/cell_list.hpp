// Sorts points of a bounded region into cells, to find those that are near each other.
#pragma once

#include "common/vec.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kerf::dem {

template <int dim> class CellList {
public:
  /// @param bounds  around the points; what lies outside counts to the outermost cells
  /// @param reach   distance within which points are near, m; on periodic axes at most half a
  /// period
  /// @param points  their number, for the number of cells
  CellList(const Box<dim>& bounds, const Period<dim>& period, double reach, std::size_t points);

  /// Enters the points.
  /// @return their indices cell by cell; within a cell they ascend
  std::vector<std::uint32_t> sort(std::span<const Vec<dim>> points);

  /// Calls use(k) for the place k, in the order that sort() gave, of every point that may be near.
  template <class Use> void for_each_near(const Vec<dim>& point, Use use) const {
    std::array<Range, dim> range;
    for (int a = 0; a < dim; ++a)
      range[static_cast<std::size_t>(a)] = cells_near(point[a], a);
    std::array<int, dim> step{};
    for (;;) {
      std::size_t cell = 0;
      for (std::size_t a = dim; a-- > 0;)
        cell = cell * count_[a] + (range[a].first + static_cast<std::size_t>(step[a])) % count_[a];
      for (std::uint32_t k = start_[cell]; k < start_[cell + 1]; ++k)
        use(k);
      std::size_t a = 0;
      while (a < dim && ++step[a] == range[a].cells)
        step[a++] = 0;
      if (a == dim)
        return;
    }
  }

private:
  struct Range {
    std::size_t first;
    int cells; // at most three, each once
  };
  Range cells_near(double coordinate, int axis) const;
  std::size_t cell_along(double coordinate, int axis) const;
  std::size_t cell_of(const Vec<dim>& point) const;

  Vec<dim> lower_, width_;
  std::array<std::size_t, dim> count_;
  std::array<bool, dim> is_periodic_;
  std::vector<std::uint32_t> start_; // of each cell in the sorted order, and the end
};

} // namespace kerf::dem
