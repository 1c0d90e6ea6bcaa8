// Several contacts at a time: their numbers as lanes, in from the arrays and out to the loads.
#pragma once

#include "common/lanes.hpp"
#include "dem_core/contact_view.hpp"

namespace kerf::KERF_ISA {

using dem::ContactView;

/// A vector of each lane.
template <int n> struct LaneVector {
  Lanes of[n];
  KERF_INLINE Lanes& operator[](int a) { return of[a]; }
  KERF_INLINE const Lanes& operator[](int a) const { return of[a]; }
};

template <int n> KERF_INLINE Lanes dot(const LaneVector<n>& a, const LaneVector<n>& b) {
  Lanes sum = a[0] * b[0];
  for (int c = 1; c < n; ++c)
    sum += a[c] * b[c];
  return sum;
}
/// a + s b
template <int n>
KERF_INLINE LaneVector<n> sum(const LaneVector<n>& a, const Lanes& s, const LaneVector<n>& b) {
  LaneVector<n> result;
  for (int c = 0; c < n; ++c)
    result[c] = a[c] + s * b[c];
  return result;
}
template <int n> KERF_INLINE LaneVector<n> scaled(const Lanes& s, const LaneVector<n>& a) {
  LaneVector<n> result;
  for (int c = 0; c < n; ++c)
    result[c] = s * a[c];
  return result;
}
KERF_INLINE LaneVector<3> cross(const LaneVector<3>& a, const LaneVector<3>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// Contacts k to k + width. `whole`: all of them exist, and none joins the last particle, beyond
/// whose numbers nothing may be read.
template <int dim, bool whole> struct Batch {
  const ContactView<dim>& c;
  std::size_t k;
  int count;

  KERF_INLINE Batch(const ContactView<dim>& view, std::size_t first_contact)
      : c(view), k(first_contact),
        count(whole || view.end - k >= width ? width : static_cast<int>(view.end - k)) {}

  /// An index of lane l; beyond the end that of the last contact.
  KERF_INLINE std::size_t index(const std::uint32_t* column, int l) const {
    return column[k + static_cast<std::size_t>(whole || l < count ? l : count - 1)];
  }

  /// A number of each contact.
  KERF_INLINE Lanes get(const double* column) const {
    return whole ? load(column + k) : load_some(column + k, count);
  }
  KERF_INLINE Lanes get(const dem::ContactConstant& constant) const {
    return constant.each != nullptr ? get(constant.each) : broadcast(constant.all);
  }
  KERF_INLINE void set(double* column, const Lanes& value) const {
    if (whole)
      store(column + k, value);
    else
      store_some(column + k, value, count);
  }

  /// Row p of an array with rows of `size` numbers.
  template <int size> KERF_INLINE Row4 row(const double* array, std::size_t p) const {
    const double* from = array + p * size;
    if (whole)
      return load_row4(from);
    Row4 row{};
    for (int a = 0; a < size; ++a)
      row[a] = from[a];
    return row;
  }
  /// Rows of the second particles less those of the first.
  template <int size> KERF_INLINE LaneVector<size> difference(const double* array) const {
    Row4 rows[width];
    for (int l = 0; l < width; ++l)
      rows[l] = row<size>(array, index(c.second, l)) - row<size>(array, index(c.first, l));
    return turned<size>(rows);
  }
  template <int size>
  KERF_INLINE LaneVector<size> gathered(const double* array, const std::uint32_t* particle) const {
    if constexpr (size == 1) {
      LaneVector<1> result;
      for (int l = 0; l < width; ++l)
        result[0][l] = array[index(particle, l)];
      return result;
    } else {
      Row4 rows[width];
      for (int l = 0; l < width; ++l)
        rows[l] = row<size>(array, index(particle, l));
      return turned<size>(rows);
    }
  }

  KERF_INLINE Mask flags(const std::uint8_t* column) const {
    if (whole)
      return load_flags(column + k);
    Mask mask{};
    for (int l = 0; l < count; ++l)
      mask[l] = column[k + static_cast<std::size_t>(l)] != 0 ? -1 : 0;
    return mask;
  }

private:
  template <int size> KERF_INLINE static LaneVector<size> turned(const Row4 (&rows)[width]) {
    Lanes columns[4];
    to_columns(rows, columns);
    LaneVector<size> result;
    for (int a = 0; a < size; ++a)
      result[a] = columns[a];
    return result;
  }
};

template <class Row> KERF_INLINE void add(double* loads, std::size_t row, const Row& load) {
  Row value;
  std::memcpy(&value, loads + row * (sizeof(Row) / 8), sizeof value);
  value += load;
  std::memcpy(loads + row * (sizeof(Row) / 8), &value, sizeof value);
}

/// Adds force F to the load of the first particle and -F to that of the second, and shares the
/// couple among them.
template <bool whole>
KERF_INLINE void scatter(const Batch<2, whole>& batch, const LaneVector<2>& F, const Lanes& couple,
                         const Lanes& share) {
  const ContactView<2>& c = batch.c;
  const Lanes on_first = share * couple;
  const Lanes first[4] = {F[0], F[1], on_first, Lanes{}};
  const Lanes second[4] = {-F[0], -F[1], couple - on_first, Lanes{}};
  Row4 row_first[width], row_second[width];
  to_rows(first, row_first);
  to_rows(second, row_second);
  for (int l = 0; l < width; ++l)
    if (whole || l < batch.count) {
      add(c.loads, batch.index(c.first, l), row_first[l]);
      add(c.loads, batch.index(c.target, l), row_second[l]);
    }
}
template <bool whole>
KERF_INLINE void scatter(const Batch<3, whole>& batch, const LaneVector<3>& F,
                         const LaneVector<3>& couple, const Lanes& share) {
  const ContactView<3>& c = batch.c;
#if defined(__AVX512F__)
  const Lanes columns[8] = {F[0], F[1], F[2], couple[0], couple[1], couple[2], share, Lanes{}};
  Row8 rows[width];
  to_rows(columns, rows);
  const Row8 forces{1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const Row8 rest{-1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 0.0, 0.0}; // of the second, less the share
  for (int l = 0; l < width; ++l)
    if (whole || l < batch.count) {
      const Row8 r = rows[l];
      const Row8 s = __builtin_shufflevector(r, Row8{}, 8, 8, 8, 6, 6, 6, 8, 8);
      add(c.loads, batch.index(c.first, l), r * (forces + s));
      add(c.loads, batch.index(c.target, l), r * (rest - s));
    }
#else
  const LaneVector<3> on_first = scaled(share, couple);
  const LaneVector<3> on_second = sum(couple, broadcast(-1.0), on_first);
  const Lanes columns[4][4] = {{F[0], F[1], F[2], on_first[0]},
                               {on_first[1], on_first[2], Lanes{}, Lanes{}},
                               {-F[0], -F[1], -F[2], on_second[0]},
                               {on_second[1], on_second[2], Lanes{}, Lanes{}}};
  for (int part = 0; part < 4; ++part) {
    Row4 rows[width];
    to_rows(columns[part], rows);
    for (int l = 0; l < width; ++l)
      if (whole || l < batch.count)
        add(c.loads + part % 2 * 4, 2 * batch.index(part < 2 ? c.first : c.target, l), rows[l]);
  }
#endif
}

/// Adds a moment to the first particle of each contact and the opposite to the second.
template <int dim, bool whole>
KERF_INLINE void scatter_moment(const Batch<dim, whole>& batch,
                                const LaneVector<ContactView<dim>::shear_components>& moment) {
  constexpr int row = dim == 2 ? 4 : 8;
  const ContactView<dim>& c = batch.c;
  for (int l = 0; l < width; ++l)
    if (whole || l < batch.count)
      for (int a = 0; a < ContactView<dim>::shear_components; ++a) {
        c.loads[batch.index(c.first, l) * row + dim + a] += moment[a][l];
        c.loads[batch.index(c.target, l) * row + dim + a] -= moment[a][l];
      }
}

} // namespace kerf::KERF_ISA
