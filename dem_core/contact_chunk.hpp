// Some contacts on their way through a kernel: gathered from the particles, computed, scattered.
#pragma once

#include "common/lanes.hpp"
#include "dem_core/contact_view.hpp"

namespace kerf::KERF_ISA {

using dem::chunk_size;
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

/// Numbers that the arrays of a vector and of the load have for each particle.
template <int dim> inline constexpr std::uint32_t row_size = dim == 2 ? 2 : 4;
template <int dim> inline constexpr std::uint32_t load_size = dim == 2 ? 4 : 8;

/// Some contacts of one block. They go through several short passes, each over all of them: what is
/// long for one contact, from its first load to its last addition, then overlaps with others.
/// Beyond the count columns hold the last contact again, up to whole batches.
template <int dim> struct Chunk {
  static constexpr int size = chunk_size, turns = ContactView<dim>::shear_components;
  std::size_t begin;
  int count;
  // Where the motion of the particles begins, and their loads, in numbers.
  std::uint32_t first[size], second[size], load_first[size], load_second[size];

  double relative[dim][size]; // u_j - u_i, m
  double moved[dim][size];    // v_j - v_i
  double turn_first[turns][size], turn_second[turns][size];
  double normal[dim][size], length[size], opening[size]; // at the end of the increment; m
  double trial[turns][size], slip[turns][size];          // see Carried; N, m
  double carried_moment[turns][size];                    // N m

  KERF_INLINE void start(const ContactView<dim>& c, std::size_t from, std::size_t end) {
    begin = from;
    count = end - from < size ? static_cast<int>(end - from) : size;
    if (count == size)
      set_rows(c, size);
    else {
      set_rows(c, count);
      for (int l = count; l % width != 0; ++l) {
        first[l] = first[count - 1];
        second[l] = second[count - 1];
      }
    }
  }

private:
  KERF_INLINE void set_rows(const ContactView<dim>& c, int n) {
    for (int l = 0; l < n; ++l) {
      first[l] = row_size<dim> * c.first[begin + l];
      second[l] = row_size<dim> * c.second[begin + l];
      load_first[l] = load_size<dim> * c.first[begin + l];
      load_second[l] = load_size<dim> * c.target[begin + l];
    }
  }
};

/// Lanes at to at + width of a chunk. `whole`: all of them are contacts.
template <int dim, bool whole> struct Batch {
  const ContactView<dim>& c;
  const Chunk<dim>& chunk;
  int at, count;
  std::size_t k;

  KERF_INLINE Batch(const ContactView<dim>& view, const Chunk<dim>& of, int from)
      : c(view), chunk(of), at(from), count(whole ? width : of.count - from),
        k(of.begin + static_cast<std::size_t>(from)) {}

  template <int size>
  KERF_INLINE LaneVector<size> column(const double (&of)[size][chunk_size]) const {
    LaneVector<size> result;
    for (int a = 0; a < size; ++a)
      result[a] = load(&of[a][at]);
    return result;
  }
  template <int size>
  KERF_INLINE void set_column(double (&of)[size][chunk_size], const LaneVector<size>& value) const {
    for (int a = 0; a < size; ++a)
      store(&of[a][at], value[a]);
  }

  /// A number of each contact; zero beyond the last.
  KERF_INLINE Lanes get(const double* column) const {
    return whole ? load(column + k) : load_some(column + k, count);
  }
  KERF_INLINE Lanes get(const dem::ContactConstant& constant) const {
    if (constant.each != nullptr)
      return get(constant.each);
    return broadcast(constant.all);
  }
  KERF_INLINE void set(double* column, const Lanes& value) const {
    if (whole)
      store(column + k, value);
    else
      store_some(column + k, value, count);
  }
  KERF_INLINE Mask flags(const std::uint8_t* column) const {
    if (whole)
      return load_flags(column + k);
    Mask mask{};
    for (int l = 0; l < count; ++l)
      mask[l] = column[k + static_cast<std::size_t>(l)] != 0 ? -1 : 0;
    return mask;
  }
  /// Zero beyond the last contact.
  KERF_INLINE Lanes only_contacts(Lanes value) const {
    if (!whole)
      for (int l = count; l < width; ++l)
        value[l] = 0.0;
    return value;
  }
};

#define KERF_LAMBDA __attribute__((always_inline))

/// Calls pass(batch) for all batches of a chunk; the last may have fewer contacts than lanes.
template <int dim, class Pass>
KERF_INLINE void for_batches(const ContactView<dim>& c, const Chunk<dim>& chunk, const Pass& pass) {
  int at = 0;
  for (; at + width <= chunk.count; at += width)
    pass(Batch<dim, true>(c, chunk, at));
  if (at < chunk.count)
    pass(Batch<dim, false>(c, chunk, at));
}

template <int size>
KERF_INLINE void set_column(double (&of)[size][chunk_size], int at, const Row4 (&rows)[width]) {
  Lanes columns[4];
  to_columns(rows, columns);
  for (int a = 0; a < size; ++a)
    store(&of[a][at], columns[a]);
}

/// From the first to the second particle of a contact, in the arrays of a vector.
template <int dim>
KERF_INLINE Row4 difference(const double* array, std::size_t first, std::size_t second) {
  return load_row<dim>(array + second) - load_row<dim>(array + first);
}

/// Where the particles of each contact are to each other, and how they have moved.
template <int dim, bool branch, bool motion>
KERF_INLINE void gather(const ContactView<dim>& c, Chunk<dim>& chunk) {
  for (int at = 0; at < chunk.count; at += width) {
    Row4 relative[width], moved[width];
    [[maybe_unused]] Row4 turn_first[width], turn_second[width];
    for (int l = 0; l < width; ++l) {
      const std::size_t i = chunk.first[at + l], j = chunk.second[at + l];
      if constexpr (branch)
        relative[l] = difference<dim>(c.displacement, i, j);
      if constexpr (!motion)
        continue;
      moved[l] = difference<dim>(c.translation, i, j);
      if constexpr (dim == 2) {
        chunk.turn_first[0][at + l] = c.rotation[i / 2];
        chunk.turn_second[0][at + l] = c.rotation[j / 2];
      } else {
        turn_first[l] = load_row<3>(c.rotation + i);
        turn_second[l] = load_row<3>(c.rotation + j);
      }
    }
    if constexpr (branch)
      set_column(chunk.relative, at, relative);
    if constexpr (motion)
      set_column(chunk.moved, at, moved);
    if constexpr (motion && dim == 3) {
      set_column(chunk.turn_first, at, turn_first);
      set_column(chunk.turn_second, at, turn_second);
    }
  }
}

template <class Row> KERF_INLINE void add(double* to, const Row& load) {
  Row value;
  std::memcpy(&value, to, sizeof value);
  value += load;
  std::memcpy(to, &value, sizeof value);
}

/// Adds the columns, force and moment, to the load of one particle of each contact.
template <bool whole>
KERF_INLINE void add_to_loads(double* loads, const std::uint32_t* row, int count,
                              const Lanes (&columns)[4]) {
  Row4 rows[width];
  to_rows(columns, rows);
  for (int l = 0; l < width; ++l)
    if (whole || l < count)
      add(loads + row[l], rows[l]);
}
template <bool whole>
KERF_INLINE void add_to_loads(double* loads, const std::uint32_t* row, int count,
                              const Lanes (&columns)[8]) {
#if defined(__AVX512F__)
  Row8 rows[width];
  to_rows(columns, rows);
  for (int l = 0; l < width; ++l)
    if (whole || l < count)
      add(loads + row[l], rows[l]);
#else
  Row4 front[width], back[width];
  to_rows({columns[0], columns[1], columns[2], columns[3]}, front);
  to_rows({columns[4], columns[5], columns[6], columns[7]}, back);
  for (int l = 0; l < width; ++l)
    if (whole || l < count) {
      add(loads + row[l], front[l]);
      add(loads + row[l] + 4, back[l]);
    }
#endif
}

/// Adds the force F to the load of the first particle and its opposite to that of the second; each
/// gets its moment.
template <bool whole>
KERF_INLINE void scatter(const Batch<2, whole>& batch, const LaneVector<2>& F,
                         const LaneVector<1>& M_i, const LaneVector<1>& M_j) {
  const ContactView<2>& c = batch.c;
  add_to_loads<whole>(c.loads, batch.chunk.load_first + batch.at, batch.count,
                      {F[0], F[1], M_i[0], Lanes{}});
  add_to_loads<whole>(c.loads, batch.chunk.load_second + batch.at, batch.count,
                      {-F[0], -F[1], M_j[0], Lanes{}});
}
template <bool whole>
KERF_INLINE void scatter(const Batch<3, whole>& batch, const LaneVector<3>& F,
                         const LaneVector<3>& M_i, const LaneVector<3>& M_j) {
  const ContactView<3>& c = batch.c;
  add_to_loads<whole>(c.loads, batch.chunk.load_first + batch.at, batch.count,
                      {F[0], F[1], F[2], M_i[0], M_i[1], M_i[2], Lanes{}, Lanes{}});
  add_to_loads<whole>(c.loads, batch.chunk.load_second + batch.at, batch.count,
                      {-F[0], -F[1], -F[2], M_j[0], M_j[1], M_j[2], Lanes{}, Lanes{}});
}

} // namespace kerf::KERF_ISA
