// What the kernel of StiffnessRows sees of a block of rows: pointers and plain numbers.
#pragma once

#include "fem_core/kernels/patch_view.hpp"

#include <cstddef>
#include <cstdint>

namespace kerf::fem {

/// Numbers of the 2 x 2 or 3 x 3 matrix of a pair of rows: xx yy xy, in 3D xx yy zz yz xz xy; or
/// all of them, row by row.
constexpr std::size_t pair_numbers(int dim, bool symmetric) {
  return static_cast<std::size_t>(symmetric ? dim * (dim + 1) / 2 : dim * dim);
}

/// How a pair is stored. One inside a block is there once and acts on both of its rows; one that
/// two blocks share is there twice. Most matrices are symmetric.
struct PairKind {
  bool inside, symmetric;
};
inline constexpr int num_pair_kinds = 4;
inline constexpr PairKind pair_kinds[num_pair_kinds] = {
    {true, true}, {true, false}, {false, true}, {false, false}};

/// One number of the matrices of several pairs.
struct alignas(batch_size * sizeof(double)) PairNumbers {
  double of_lane[batch_size];
};

/// One block. Slices of batch_size rows each have as many pairs as their longest row; matrices of
/// zero fill the others. The slices of one kind follow those of another.
struct StiffnessView {
  std::size_t first_row, num_rows;
  const std::uint32_t* num_slices; // [num_pair_kinds]
  const std::uint16_t* rows;       // [slices][batch_size] where they begin in the block
  const std::uint16_t* lengths;    // [slices] pairs of each row
  const std::uint16_t* inside;     // [slices][length][batch_size] other rows, likewise
  const std::uint32_t* outside;    // [slices][length][batch_size] other rows, of all
  const PairNumbers* matrices;     // [slices][length][pair_numbers()] N/m
  const double* displacement;      // [rows] u, m
  double* force;                   // [num_rows] receives K u, N
};

using StiffnessKernel = void (*)(const StiffnessView&);

} // namespace kerf::fem
