// Particles sorted into rows along x, in which those near each other follow one another.
#pragma once

#include "common/vec.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kerf::dem {

/// With fewer, waking up the other threads takes longer than the search.
inline constexpr std::size_t particles_worth_threads = 1024;

/// Particles of similar size, copied row by row into arrays of their own. A row has those in one
/// cell of y and z, ascending by x. Rows are found by a hash, so that a particle that flies away
/// costs no memory. Coordinates along periodic axes are taken into the period.
template <int dim> class ParticleRows {
public:
  using Cell = std::array<std::int64_t, dim - 1>; // along y and z
  struct Row {
    Cell cell;
    std::uint32_t begin, end; // its particles
  };
  /// How many particles behind the last one of all a loop may read.
  static constexpr std::uint32_t padding = 8;

  /// @param particles  which of all
  /// @param width      least edge of a cell, m
  /// @param farthest   what is farther from the origin shares the outermost cells, m
  ParticleRows(std::span<const std::uint32_t> particles, std::span<const Vec<dim>> position,
               std::span<const double> radius, double width, double farthest,
               const Period<dim>& period);

  std::span<const Row> rows() const noexcept { return rows_; }
  Vec<dim> position(std::size_t k) const {
    Vec<dim> position;
    for (int a = 0; a < dim; ++a)
      position[a] = x[a][k];
    return position;
  }
  Box<dim> bounds(const Row& row) const;

  /// Calls visit(row, cell, shift) for every row that has an image within `reach` of a box: the
  /// image is in this cell, shifted by so much from where its particles are, m.
  template <class Visit> void visit_near(const Box<dim>& box, double reach, Visit visit) const {
    Cell low, high;
    for (int a = 1; a < dim; ++a) {
      low[a - 1] = cell_along(a, box.lower[a] - reach);
      high[a - 1] = cell_along(a, box.upper[a] + reach);
    }
    Cell image = low;
    for (;;) {
      Cell cell = image;
      Vec<dim> shift = Vec<dim>::Zero();
      for (int a = 1; a < dim; ++a)
        if (const std::int64_t count = count_[a - 1]; count > 0) {
          cell[a - 1] = (image[a - 1] % count + count) % count;
          const std::int64_t periods = (image[a - 1] - cell[a - 1]) / count;
          shift[a] = static_cast<double>(periods) * period_.length[a];
        }
      if (const std::uint32_t row = slots_[slot_of(cell)]; row != none)
        visit(rows_[row], image, shift);
      int a = 0;
      while (a < dim - 1 && ++image[a] > high[a]) {
        image[a] = low[a];
        ++a;
      }
      if (a == dim - 1)
        return;
    }
  }

  // One entry a particle.
  std::array<std::vector<double>, dim> x; // m
  std::vector<double> radius;             // m
  std::vector<std::uint32_t> particle;    // its index

private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  std::int64_t cell_along(int axis, double coordinate) const;
  Cell cell_of(const Vec<dim>& position) const;
  std::size_t slot_of(const Cell& cell) const;
  std::vector<std::uint32_t> assign_rows(std::span<const Cell> cells);
  void arrange(const Row& row, std::span<const Vec<dim>> position, std::span<const double> radius);

  Period<dim> period_;
  double farthest_;
  Vec<dim> width_; // of a cell, m
  Cell count_{};   // cells of a period; 0: does not repeat
  std::vector<Row> rows_;
  std::vector<std::uint32_t> slots_; // of the hash: rows
};

} // namespace kerf::dem
