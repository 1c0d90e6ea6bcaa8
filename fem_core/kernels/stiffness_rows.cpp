// Forces of the pairs of a block of StiffnessRows. Compiled once for every set of instructions.
#include "fem_core/kernels/stiffness_view.hpp"

#include "fem_core/kernels/rows.hpp"

namespace kerf::KERF_ISA {

using fem::batch_size;
using fem::PairNumbers;
using fem::StiffnessView;

/// Where the arrays of a view go on.
struct StiffnessCursor {
  const std::uint16_t *rows, *lengths, *inside;
  const std::uint32_t* outside;
  const PairNumbers* matrices;
};

template <int dim> KERF_INLINE Columns<dim> gather(const double* rows, const std::uint32_t* row) {
  constexpr std::uint16_t size = fem::row_size<dim>;
  static constexpr std::uint16_t in_order[batch_size] = {0,        size,     2 * size, 3 * size,
                                                         4 * size, 5 * size, 6 * size, 7 * size};
  double copy[size * width];
  for (std::size_t l = 0; l < width; ++l)
    std::memcpy(copy + size * l, rows + std::size_t{size} * row[l], size * sizeof(double));
  return gather<dim>(copy, in_order);
}

/// K d of the lanes from l on, or K^T d when `transposed`.
template <bool symmetric, bool transposed = false>
KERF_INLINE Columns<2> product(const PairNumbers* K, int l, const Columns<2>& d) {
  const auto k = [=](int n) __attribute__((always_inline)) {
    return load(K[n].of_lane + l);
  };
  if constexpr (symmetric)
    return {k(0) * d.c[0] + k(2) * d.c[1], k(2) * d.c[0] + k(1) * d.c[1]};
  else if constexpr (transposed)
    return {k(0) * d.c[0] + k(2) * d.c[1], k(1) * d.c[0] + k(3) * d.c[1]};
  else
    return {k(0) * d.c[0] + k(1) * d.c[1], k(2) * d.c[0] + k(3) * d.c[1]};
}
template <bool symmetric, bool transposed = false>
KERF_INLINE Columns<3> product(const PairNumbers* K, int l, const Columns<3>& d) {
  const auto row = [&](int x, int y, int z) __attribute__((always_inline)) {
    const auto k = [=](int n) __attribute__((always_inline)) {
      return load(K[n].of_lane + l);
    };
    return k(x) * d.c[0] + k(y) * d.c[1] + k(z) * d.c[2];
  };
  if constexpr (symmetric)
    return {row(0, 5, 4), row(5, 1, 3), row(4, 3, 2)};
  else if constexpr (transposed)
    return {row(0, 3, 6), row(1, 4, 7), row(2, 5, 8)};
  else
    return {row(0, 1, 2), row(3, 4, 5), row(6, 7, 8)};
}

/// Rows sum to zero: f_i = sum_j K_ij (u_j - u_i), and f_j gets K_ij^T (u_i - u_j).
template <int dim, bool is_inside, bool symmetric>
void add_slices(const StiffnessView& view, std::uint32_t count, StiffnessCursor& at) {
  constexpr std::size_t numbers = fem::pair_numbers(dim, symmetric);
  const double* const block = view.displacement + view.first_row * fem::row_size<dim>;
  for (std::uint32_t s = 0; s < count; ++s) {
    const std::size_t length = *at.lengths++;
    for (int l = 0; l < batch_size; l += width) {
      const Columns<dim> own = gather<dim>(block, at.rows + l);
      Columns<dim> taken{}; // off the rows
      for (std::size_t k = 0; k < length; ++k) {
        const std::size_t place = k * batch_size + static_cast<std::size_t>(l);
        Columns<dim> d;
        if constexpr (is_inside)
          d = gather<dim>(block, at.inside + place);
        else
          d = gather<dim>(view.displacement, at.outside + place);
        for (int i = 0; i < dim; ++i)
          d.c[i] -= own.c[i];
        const PairNumbers* const K = at.matrices + k * numbers;
        const Columns<dim> f = product<symmetric>(K, l, d);
        for (int i = 0; i < dim; ++i)
          taken.c[i] -= f.c[i];
        if constexpr (is_inside)
          subtract<dim>(view.force, at.inside + place,
                        symmetric ? f : product<symmetric, true>(K, l, d), width);
      }
      subtract<dim>(view.force, at.rows + l, taken, width);
    }
    at.rows += batch_size;
    if constexpr (is_inside)
      at.inside += length * batch_size;
    else
      at.outside += length * batch_size;
    at.matrices += length * numbers;
  }
}

template <int dim> void multiply_stiffness(const StiffnessView& view) {
  std::memset(view.force, 0, view.num_rows * fem::row_size<dim> * sizeof(double));
  StiffnessCursor at{view.rows, view.lengths, view.inside, view.outside, view.matrices};
  add_slices<dim, true, true>(view, view.num_slices[0], at);
  add_slices<dim, true, false>(view, view.num_slices[1], at);
  add_slices<dim, false, true>(view, view.num_slices[2], at);
  add_slices<dim, false, false>(view, view.num_slices[3], at);
}

fem::StiffnessKernel stiffness_kernel(int dim) {
  return dim == 2 ? multiply_stiffness<2> : multiply_stiffness<3>;
}

} // namespace kerf::KERF_ISA
