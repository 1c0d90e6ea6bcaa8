// The stiffness of a linear body, assembled row by row: f = K u.
#pragma once

#include "common/large_pages.hpp"
#include "fem_core/element.hpp"
#include "fem_core/kernels/stiffness_view.hpp"
#include "fem_core/rows.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace kerf::fem {

/// Elements of one shape whose forces are K_e u.
template <int dim> struct StiffnessElements {
  int corners;
  std::span<const std::uint32_t> rows; // [elements][corners]
  /// [corner][component] both ways, N/m (per metre in 2D): symmetric, and without forces when all
  /// corners move alike.
  std::function<ElementMatrix<dim>(std::size_t element)> stiffness;
};

/// K as the forces between pairs of rows, f_i = sum_j K_ij (u_j - u_i): no diagonal is stored, and
/// a translation gives no force to the last bit. Between two rows of one block the matrix is stored
/// once and gives both forces; a pair in two blocks is stored in both. So a block needs nothing but
/// u: its rows of f are finished, with the same bits for any number of threads, when it is done.
///
/// Where K_ij is symmetric, to rounding, half of what is off its diagonal is not stored. Of
/// conforming elements that is all pairs but those of two rows on the outside, or where the moduli
/// change: lambda div u div v + mu grad u^T : grad v differs from a symmetric form by a multiple of
/// div u div v - grad u^T : grad v, a null Lagrangian; L.C. Evans, Partial Differential Equations
/// (AMS, 2010), section 8.1.4.
///
/// Rows that follow a curve through space make it fast: neighbours then share blocks.
template <int dim> class StiffnessRows {
public:
  static constexpr std::size_t rows_per_block = 1024;

  /// Calls stiffness() for each element once in every block that has a row of it.
  /// @throws std::invalid_argument for a row that is not there, and for a matrix that is not
  ///         symmetric or resists translation, both to 1e-9 of its largest number
  StiffnessRows(std::size_t num_rows, std::span<const StiffnessElements<dim>> elements);

  std::size_t num_rows() const { return num_rows_; }
  std::size_t bytes() const; // of what multiply() reads besides u

  /// f = K u.
  /// @param u  [num_rows][row_size] m
  /// @param f  [num_rows][row_size] N; is not u
  void multiply(const double* u, double* f) const;

  /// Calls finish(first row, end, f) for every block of rows with its part of f = K u, [rows]
  /// [row_size] N, while that is in the cache. The calls come from all threads; finish() leaves u
  /// as it is, which other blocks still read: it writes the next displacements elsewhere.
  template <class Finish> void for_blocks(const double* u, Finish finish) const {
    const auto count = static_cast<std::int64_t>(blocks_.size());
#pragma omp parallel if (count > 1)
    {
      Rows<dim> force(std::min(num_rows_, rows_per_block));
#pragma omp for schedule(static)
      for (std::int64_t b = 0; b < count; ++b) {
        const Block& block = blocks_[static_cast<std::size_t>(b)];
        compute(block, u, force.data());
        finish(std::size_t{block.first_row}, std::size_t{block.first_row + block.num_rows},
               force.data());
      }
    }
  }

private:
  template <int> friend class StiffnessAssembly;

  struct Block {
    std::uint32_t first_row, num_rows;
    std::array<std::uint32_t, num_pair_kinds> num_slices;
    std::size_t first_slice, first_inside, first_outside, first_matrix; // in the arrays
  };

  void compute(const Block& block, const double* u, double* f) const;

  std::size_t num_rows_ = 0;
  StiffnessKernel kernel_ = nullptr;
  std::vector<Block> blocks_;
  std::vector<std::uint16_t> rows_, lengths_; // as StiffnessView has them
  LargeVector<std::uint16_t> inside_;
  LargeVector<std::uint32_t> outside_;
  LargeVector<PairNumbers> matrices_;
};

} // namespace kerf::fem
