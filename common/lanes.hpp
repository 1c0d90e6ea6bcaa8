// Several numbers at once: the vectors of the processor that a file is compiled for.
//
// A file that includes this is compiled once for every set of instructions, with KERF_ISA naming
// its namespace, so that no function of one set is ever linked into another. It must not include
// headers with inline functions of other namespaces that are not inlined for certain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#if !defined(KERF_ISA)
#error "compile this for a set of instructions: see cmake/instruction_sets.cmake"
#endif

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace kerf::KERF_ISA {

#if defined(__AVX512F__)
inline constexpr int width = 8;
#elif defined(__AVX__)
inline constexpr int width = 4;
#else
inline constexpr int width = 2;
#endif

using Lanes = double __attribute__((vector_size(8 * width)));      // one number of each contact
using Mask = std::int64_t __attribute__((vector_size(8 * width))); // -1: true
using Row2 = double __attribute__((vector_size(16)));              // two numbers of one contact
using Row4 = double __attribute__((vector_size(32)));              // four numbers of one contact
using Row8 = double __attribute__((vector_size(64)));              // eight numbers of one contact

#define KERF_INLINE [[gnu::always_inline]] inline

KERF_INLINE Lanes broadcast(double value) {
  return Lanes{} + value;
}

KERF_INLINE Lanes load(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
KERF_INLINE void store(double* to, const Lanes& lanes) {
  std::memcpy(to, &lanes, sizeof lanes);
}
/// The first `count` lanes; the others are zero.
KERF_INLINE Lanes load_some(const double* from, int count) {
  Lanes lanes{};
  for (int l = 0; l < width; ++l)
    if (l < count)
      lanes[l] = from[l];
  return lanes;
}
KERF_INLINE void store_some(double* to, const Lanes& lanes, int count) {
  for (int l = 0; l < width; ++l)
    if (l < count)
      to[l] = lanes[l];
}

/// True where a flag is not zero.
KERF_INLINE Mask load_flags(const std::uint8_t* from) {
#if defined(__AVX512F__)
  std::int64_t bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  return (Mask)_mm512_cvtepu8_epi64(_mm_cvtsi64_si128(bytes)) != 0;
#elif defined(__AVX2__)
  std::int32_t bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  return (Mask)_mm256_cvtepu8_epi64(_mm_cvtsi32_si128(bytes)) != 0;
#else
  return Mask{-static_cast<std::int64_t>(from[0] != 0), -static_cast<std::int64_t>(from[1] != 0)};
#endif
}
/// A vector of two (2D) or three numbers; in 3D a fourth fills its row.
template <int dim> KERF_INLINE Row4 load_row(const double* from) {
  if constexpr (dim == 2) {
    Row2 row;
    std::memcpy(&row, from, sizeof row);
    return __builtin_shufflevector(row, Row2{}, 0, 1, 2, 3);
  } else {
    Row4 row;
    std::memcpy(&row, from, sizeof row);
    return row;
  }
}

/// One behind the other; the second is best read from memory just here.
KERF_INLINE Row4 joined(const Row2& low, const Row2& high) {
#if defined(__AVX__)
  return (Row4)_mm256_insertf128_pd(_mm256_castpd128_pd256((__m128d)low), (__m128d)high, 1);
#else
  return __builtin_shufflevector(low, high, 0, 1, 2, 3);
#endif
}
#if defined(__AVX512F__)
KERF_INLINE Row8 joined(const Row4& low, const Row4& high) {
  return (Row8)_mm512_insertf64x4(_mm512_castpd256_pd512((__m256d)low), (__m256d)high, 1);
}
#endif

KERF_INLINE bool any(const Mask& mask) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
#elif defined(__AVX__)
  return _mm256_movemask_pd((__m256d)mask) != 0;
#else
  return (mask[0] | mask[1]) != 0;
#endif
}

KERF_INLINE Lanes select(const Mask& mask, const Lanes& yes, const Lanes& no) {
#if defined(__AVX512F__)
  return mask ? yes : no;
#elif defined(__AVX__)
  return (Lanes)_mm256_blendv_pd((__m256d)no, (__m256d)yes, (__m256d)mask);
#else // in plain operators g++ 12 finds conditions that it then fails on
  return (Lanes)_mm_or_pd(_mm_and_pd((__m128d)mask, (__m128d)yes),
                          _mm_andnot_pd((__m128d)mask, (__m128d)no));
#endif
}
KERF_INLINE Lanes square_root(const Lanes& x) {
#if defined(__AVX512F__)
  return (Lanes)_mm512_maskz_sqrt_pd(-1, (__m512d)x);
#elif defined(__AVX__)
  return (Lanes)_mm256_sqrt_pd((__m256d)x);
#else
  return (Lanes)_mm_sqrt_pd((__m128d)x);
#endif
}
/// 1 / sqrt(x) to the last digit or two; x > 0.
KERF_INLINE Lanes inverse_square_root(const Lanes& x) {
#if defined(__AVX512F__)
  Lanes y =
      (Lanes)_mm512_maskz_rsqrt14_pd(-1, (__m512d)x); // 14 bits, doubled by each Newton iteration
  const Lanes half = 0.5 * x;
  y = y * (1.5 - half * y * y);
  return y * (1.5 - half * y * y);
#else
  return 1.0 / square_root(x);
#endif
}
/// 1 / x, likewise; x is not zero.
KERF_INLINE Lanes inverse(const Lanes& x) {
#if defined(__AVX512F__)
  Lanes y = (Lanes)_mm512_maskz_rcp14_pd(-1, (__m512d)x);
  y = y * (2.0 - x * y);
  return y * (2.0 - x * y);
#else
  return 1.0 / x;
#endif
}
KERF_INLINE Lanes absolute(const Lanes& x) {
  return (Lanes)((Mask)x & INT64_MAX);
}
KERF_INLINE double smallest(const Lanes& x) {
  double least = x[0];
  for (int l = 1; l < width; ++l)
    least = x[l] < least ? x[l] : least;
  return least;
}
/// Sum of the lanes, pairwise.
KERF_INLINE double total(const Lanes& x) {
  double value[width];
  std::memcpy(value, &x, sizeof value);
  for (int half = width / 2; half > 0; half /= 2)
    for (int l = 0; l < half; ++l)
      value[l] += value[l + half];
  return value[0];
}

/// Lane l of `column[c]` becomes number c of row l.
KERF_INLINE void to_columns(const Row4 (&row)[width], Lanes (&column)[4]) {
#if defined(__AVX512F__)
  const Row8 t0 = joined(row[0], row[4]);
  const Row8 t1 = joined(row[1], row[5]);
  const Row8 t2 = joined(row[2], row[6]);
  const Row8 t3 = joined(row[3], row[7]);
  const Row8 a = __builtin_shufflevector(t0, t1, 0, 8, 2, 10, 4, 12, 6, 14);
  const Row8 b = __builtin_shufflevector(t0, t1, 1, 9, 3, 11, 5, 13, 7, 15);
  const Row8 c = __builtin_shufflevector(t2, t3, 0, 8, 2, 10, 4, 12, 6, 14);
  const Row8 d = __builtin_shufflevector(t2, t3, 1, 9, 3, 11, 5, 13, 7, 15);
  column[0] = __builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13);
  column[1] = __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13);
  column[2] = __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15);
  column[3] = __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15);
#elif defined(__AVX__)
  const Row4 a = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6);
  const Row4 b = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
  const Row4 c = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6);
  const Row4 d = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
  column[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  column[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  column[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  column[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
#else
  for (int c = 0; c < 4; ++c)
    column[c] = Lanes{row[0][c], row[1][c]};
#endif
}

/// The reverse of to_columns().
KERF_INLINE void to_rows(const Lanes (&column)[4], Row4 (&row)[width]) {
#if defined(__AVX512F__)
  const Row8 a = __builtin_shufflevector(column[0], column[1], 0, 8, 2, 10, 4, 12, 6, 14);
  const Row8 b = __builtin_shufflevector(column[0], column[1], 1, 9, 3, 11, 5, 13, 7, 15);
  const Row8 c = __builtin_shufflevector(column[2], column[3], 0, 8, 2, 10, 4, 12, 6, 14);
  const Row8 d = __builtin_shufflevector(column[2], column[3], 1, 9, 3, 11, 5, 13, 7, 15);
  row[0] = __builtin_shufflevector(a, c, 0, 1, 8, 9);
  row[1] = __builtin_shufflevector(b, d, 0, 1, 8, 9);
  row[2] = __builtin_shufflevector(a, c, 2, 3, 10, 11);
  row[3] = __builtin_shufflevector(b, d, 2, 3, 10, 11);
  row[4] = __builtin_shufflevector(a, c, 4, 5, 12, 13);
  row[5] = __builtin_shufflevector(b, d, 4, 5, 12, 13);
  row[6] = __builtin_shufflevector(a, c, 6, 7, 14, 15);
  row[7] = __builtin_shufflevector(b, d, 6, 7, 14, 15);
#elif defined(__AVX__)
  Lanes turned[4];
  to_columns(column, turned); // a square is turned both ways alike
  for (int l = 0; l < 4; ++l)
    row[l] = turned[l];
#else
  for (int l = 0; l < width; ++l)
    row[l] = Row4{column[0][l], column[1][l], column[2][l], column[3][l]};
#endif
}

#if defined(__AVX512F__)
KERF_INLINE void to_rows(const Lanes (&column)[8], Row8 (&row)[width]) {
  Row8 a[8], b[8];
  for (int c = 0; c < 8; c += 2) {
    a[c] = __builtin_shufflevector(column[c], column[c + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    a[c + 1] = __builtin_shufflevector(column[c], column[c + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int half = 0; half < 8; half += 4) { // columns 0-3, then 4-7
    b[half] = __builtin_shufflevector(a[half], a[half + 2], 0, 1, 8, 9, 4, 5, 12, 13);
    b[half + 1] = __builtin_shufflevector(a[half + 1], a[half + 3], 0, 1, 8, 9, 4, 5, 12, 13);
    b[half + 2] = __builtin_shufflevector(a[half], a[half + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    b[half + 3] = __builtin_shufflevector(a[half + 1], a[half + 3], 2, 3, 10, 11, 6, 7, 14, 15);
  }
  for (int l = 0; l < 4; ++l) {
    row[l] = __builtin_shufflevector(b[l], b[l + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    row[l + 4] = __builtin_shufflevector(b[l], b[l + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}
#endif

} // namespace kerf::KERF_ISA
