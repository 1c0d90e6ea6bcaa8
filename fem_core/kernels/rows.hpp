// Rows of nodes to lanes of elements and back.
#pragma once

#include "common/lanes.hpp"
#include "fem_core/kernels/patch_view.hpp"

namespace kerf::KERF_ISA {

/// One vector of each element.
template <int dim> struct Columns { Lanes c[dim]; };

/// The rows of one node of `width` elements.
/// @param place  where each begins
KERF_INLINE Columns<3> gather3(const double* rows, const std::uint16_t* place) {
  Row4 row[width];
  for (int l = 0; l < width; ++l)
    std::memcpy(&row[l], rows + place[l], sizeof(Row4));
  Lanes column[4];
  to_columns(row, column);
  return {column[0], column[1], column[2]};
}

KERF_INLINE Columns<2> gather2(const double* rows, const std::uint16_t* place) {
  Row2 r[width];
  for (int l = 0; l < width; ++l)
    std::memcpy(&r[l], rows + place[l], sizeof(Row2));
#if defined(__AVX512F__)
  const Row8 even = joined(joined(r[0], r[2]), joined(r[4], r[6]));
  const Row8 odd = joined(joined(r[1], r[3]), joined(r[5], r[7]));
  return {__builtin_shufflevector(even, odd, 0, 8, 2, 10, 4, 12, 6, 14),
          __builtin_shufflevector(even, odd, 1, 9, 3, 11, 5, 13, 7, 15)};
#elif defined(__AVX__)
  const Row4 even = joined(r[0], r[2]), odd = joined(r[1], r[3]);
  return {__builtin_shufflevector(even, odd, 0, 4, 2, 6),
          __builtin_shufflevector(even, odd, 1, 5, 3, 7)};
#else
  return {Lanes{r[0][0], r[1][0]}, Lanes{r[0][1], r[1][1]}};
#endif
}

template <int dim> KERF_INLINE Columns<dim> gather(const double* rows, const std::uint16_t* place) {
  if constexpr (dim == 2)
    return gather2(rows, place);
  else
    return gather3(rows, place);
}

template <class Row> KERF_INLINE void subtract_row(double* at, const Row& row) {
  Row sum;
  std::memcpy(&sum, at, sizeof sum);
  sum -= row;
  std::memcpy(at, &sum, sizeof sum);
}

KERF_INLINE void to_rows(const Columns<3>& columns, Row4 (&row)[width]) {
  const Lanes column[4] = {columns.c[0], columns.c[1], columns.c[2], Lanes{}};
  to_rows(column, row);
}
KERF_INLINE void to_rows(const Columns<2>& columns, Row2 (&row)[width]) {
  const Lanes &x = columns.c[0], &y = columns.c[1];
#if defined(__AVX512F__)
  const Row8 even = __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14);
  const Row8 odd = __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
  row[0] = __builtin_shufflevector(even, even, 0, 1);
  row[2] = __builtin_shufflevector(even, even, 2, 3);
  row[4] = __builtin_shufflevector(even, even, 4, 5);
  row[6] = __builtin_shufflevector(even, even, 6, 7);
  row[1] = __builtin_shufflevector(odd, odd, 0, 1);
  row[3] = __builtin_shufflevector(odd, odd, 2, 3);
  row[5] = __builtin_shufflevector(odd, odd, 4, 5);
  row[7] = __builtin_shufflevector(odd, odd, 6, 7);
#elif defined(__AVX__)
  const Row4 even = __builtin_shufflevector(x, y, 0, 4, 2, 6);
  const Row4 odd = __builtin_shufflevector(x, y, 1, 5, 3, 7);
  row[0] = __builtin_shufflevector(even, even, 0, 1);
  row[1] = __builtin_shufflevector(odd, odd, 0, 1);
  row[2] = __builtin_shufflevector(even, even, 2, 3);
  row[3] = __builtin_shufflevector(odd, odd, 2, 3);
#else
  row[0] = __builtin_shufflevector(x, y, 0, 2);
  row[1] = __builtin_shufflevector(x, y, 1, 3);
#endif
}
template <int dim> struct RowOf;
template <> struct RowOf<2> { using type = Row2; };
template <> struct RowOf<3> { using type = Row4; };

/// Takes a force off the rows of one node of the first `count` elements, which may share rows.
template <int dim>
KERF_INLINE void subtract(double* rows, const std::uint16_t* place, const Columns<dim>& force,
                          int count) {
  typename RowOf<dim>::type row[width];
  to_rows(force, row);
  if (count == width)
    for (int l = 0; l < width; ++l)
      subtract_row(rows + place[l], row[l]);
  else
    for (int l = 0; l < count; ++l)
      subtract_row(rows + place[l], row[l]);
}

} // namespace kerf::KERF_ISA
