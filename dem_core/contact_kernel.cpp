// The force of bonded and of frictional contacts, several at a time. Compiled once for every set of
// instructions; see contact_forces.hpp for what is computed and cmake/instruction_sets.cmake.
#include "common/lanes.hpp"
#include "dem_core/contact_view.hpp"

namespace kerf::KERF_ISA {
namespace {

using dem::BreakMode;
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

/// The tangential force at the end of an increment as if nothing gave way, and what it has grown
/// by. Tangential vectors are orthogonal to the normal; in 2D they are numbers along the normal
/// turned by +90 degrees.
template <int dim> struct Shear {
  static constexpr int size = ContactView<dim>::shear_components;
  LaneVector<size> trial;  // N
  LaneVector<size> growth; // N
};

/// The arms share the branch, so that a rigid rotation of both particles makes no slip.
template <bool whole>
KERF_INLINE Shear<2> follow_shear(const Batch<2, whole>& batch, const LaneVector<2>& branch,
                                  const LaneVector<2>&, const LaneVector<2>& moved,
                                  const Lanes& share, const Lanes& k_t) {
  const ContactView<2>& c = batch.c;
  const Lanes turn_i = batch.template gathered<1>(c.rotation, c.first)[0];
  const Lanes turn_j = batch.template gathered<1>(c.rotation, c.second)[0];
  const Lanes turned = c.scale * (turn_j + share * (turn_i - turn_j));
  const LaneVector<2> middle = sum(branch, broadcast(-c.half), moved);
  const Lanes length2 = dot(middle, middle);
  const Lanes slip = inverse_square_root(length2) *
                     (middle[0] * moved[1] - middle[1] * moved[0] - length2 * turned);
  const Lanes growth = k_t * slip;
  return {{{batch.get(c.shear[0]) + growth}}, {{growth}}};
}

/// The stored force F makes the rotation R of the branch, the shortest one, with the mean turn of
/// both particles about it. The slip s is that of the middle of the increment: half of the growth
/// makes the rotation too, R (F + k_t s / 2) + k_t s / 2, which is the same there and back.
///
/// The rotation has the Gibbs vector t, tan(angle / 2) along its axis: b' - b = t x (b' + b) for a
/// branch that keeps its length.
template <bool whole>
KERF_INLINE Shear<3> follow_shear(const Batch<3, whole>& batch, const LaneVector<3>& branch,
                                  const LaneVector<3>& normal, const LaneVector<3>& moved,
                                  const Lanes& share, const Lanes& k_t) {
  const ContactView<3>& c = batch.c;
  const LaneVector<3> turn_i = batch.template gathered<3>(c.rotation, c.first);
  const LaneVector<3> turn_j = batch.template gathered<3>(c.rotation, c.second);
  const LaneVector<3> middle = sum(branch, broadcast(-0.5), moved);
  const Lanes inverse_middle2 = inverse(dot(middle, middle));

  LaneVector<3> turned;
  for (int a = 0; a < 3; ++a)
    turned[a] = c.scale * (turn_j[a] + share * (turn_i[a] - turn_j[a]));
  const bool at_end = c.half == 0.0;
  const LaneVector<3>& lever = at_end ? branch : middle;
  const Lanes inverse_lever2 = at_end ? inverse(dot(branch, branch)) : inverse_middle2;
  LaneVector<3> slip = sum(moved, broadcast(-1.0), cross(turned, lever));
  slip = sum(slip, -inverse_lever2 * dot(moved, lever), lever);

  const Lanes half_inverse = 0.5 * inverse_middle2;
  const Lanes spin = 0.5 * c.scale * half_inverse * (dot(turn_i, middle) + dot(turn_j, middle));
  const LaneVector<3> t = sum(scaled(half_inverse, cross(middle, moved)), spin, middle);
  const LaneVector<3> force = {
      {batch.get(c.shear[0]), batch.get(c.shear[1]), batch.get(c.shear[2])}};
  const LaneVector<3> G = sum(force, c.half * k_t, slip);
  const LaneVector<3> tG = cross(t, G);
  LaneVector<3> trial = sum(tG, broadcast(1.0), cross(t, tG));
  trial = sum(G, 2.0 * inverse(1.0 + dot(t, t)), trial);
  trial = sum(trial, (1.0 - c.half) * k_t, slip);
  return {sum(trial, -dot(trial, normal), normal), scaled(k_t, slip)};
}

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

/// Bond, and the friction that remains when it is broken; docs in contact_forces.hpp.
template <int dim, bool whole>
KERF_INLINE void bond_or_friction(ContactView<dim>& c, std::size_t k) {
  constexpr int shears = ContactView<dim>::shear_components;
  const Batch<dim, whole> batch(c, k);
  const LaneVector<dim> relative = batch.template difference<dim>(c.displacement);
  LaneVector<dim> B;
  for (int a = 0; a < dim; ++a)
    B[a] = batch.get(c.reference_branch[a]);
  if (!whole) // lanes beyond the end: any branch that is not zero
    for (int l = batch.count; l < width; ++l)
      B[0][l] = 1.0 - relative[0][l];
  const LaneVector<dim> branch = sum(B, broadcast(1.0), relative);
  const Lanes length2 = dot(branch, branch);
  const Lanes inverse_length = inverse_square_root(length2);
  const Lanes length = length2 * inverse_length;
  // The difference of squares of length and rest length, from the displacement, so that it keeps
  // its digits when it is small; bonds are free of stress at their reference.
  const Lanes rest = batch.get(c.rest_length);
  const Lanes start = select(batch.flags(c.bonded_at_start), Lanes{}, dot(B, B) - rest * rest);
  const Lanes opening =
      (dot(relative, sum(relative, broadcast(2.0), B)) + start) * inverse(length + rest);

  const Mask bonded = batch.flags(c.bonded);
  if (!any(bonded | (opening < 0.0))) // all open: nothing to do, unless one has just opened
    if (!any(batch.get(c.normal_force) != 0.0))
      return;

  const LaneVector<dim> n = scaled(inverse_length, branch);
  const LaneVector<dim> moved =
      scaled(broadcast(c.scale), batch.template difference<dim>(c.translation));
  const Lanes share = batch.get(c.share);
  const Lanes k_n = batch.get(c.normal_stiffness), k_t = batch.get(c.tangential_stiffness);
  const Shear<dim> shear = follow_shear(batch, branch, n, moved, share, k_t); // eq. 13

  Lanes F_n = k_n * opening; // N; Rojek (2008) eq. 12
  LaneVector<shears> F_T = shear.trial;
  const Lanes F_T2 = dot(F_T, F_T);
  const Lanes R_n = batch.get(c.tensile_strength), R_t = batch.get(c.shear_strength);
  const Mask breaks = bonded & ((F_n > R_n) | (F_T2 > R_t * R_t)); // eqs 14, 15
  const Mask free = ~bonded | breaks;

  if (any(free)) {
    const Lanes weight = batch.get(c.weight);
    const Lanes trial_n = F_n;
    F_n = select(free & (F_n > 0.0), Lanes{}, F_n);
    const Lanes limit = c.friction * absolute(F_n);
    const Lanes size = square_root(F_T2);
    const Mask slides = free & (size > limit);
    F_T = scaled(select(slides, limit / size, broadcast(1.0)), F_T);

    // Work of a spring that gives way: mean force times the slip that is not elastic.
    const LaneVector<shears> twice_mean =
        sum(sum(shear.trial, broadcast(-1.0), shear.growth), broadcast(1.0), F_T);
    const Lanes lost_T =
        0.5 * weight * dot(twice_mean, sum(shear.trial, broadcast(-1.0), F_T)) / k_t;
    c.friction_loss += total(select(slides & ~breaks, lost_T, Lanes{}));
    if (any(breaks)) {
      const Lanes before_n = batch.get(c.normal_force);
      const Lanes lost =
          select(slides, lost_T, Lanes{}) + 0.5 * weight * (before_n + F_n) * (trial_n - F_n) / k_n;
      c.fracture_loss += total(select(breaks, lost, Lanes{}));
      for (int l = 0; l < width; ++l)
        if (breaks[l] != 0) {
          const std::size_t at = k + static_cast<std::size_t>(l);
          c.bonded[at] = 0;
          c.on_break(c.breaks, static_cast<std::uint32_t>(at),
                     trial_n[l] > R_n[l] ? BreakMode::tension : BreakMode::shear, lost[l]);
        }
    }
  }
  batch.set(c.normal_force, F_n);
  for (int a = 0; a < shears; ++a)
    batch.set(c.shear[a], F_T[a]);

  if (c.weight.each != nullptr || c.weight.all != 1.0) {
    const Lanes weight = batch.get(c.weight);
    F_n *= weight;
    F_T = scaled(weight, F_T);
  }
  if constexpr (dim == 2) { // F_T acts along (-n_y, n_x); F_n has no arm
    const LaneVector<2> F = {{F_n * n[0] - F_T[0] * n[1], F_n * n[1] + F_T[0] * n[0]}};
    scatter(batch, F, length * F_T[0], share);
  } else {
    scatter(batch, sum(F_T, F_n, n), cross(branch, F_T), share); // eq. 11
  }
}

} // namespace

template <int dim> void bond_kernel(ContactView<dim>& view) {
  ContactView<dim> c = view; // a copy: nothing else can change its constants
  for (std::size_t k = c.begin; k < c.end; k += width)
    if (c.end - k >= width && !any_is(c.second + k, c.particles - 1))
      bond_or_friction<dim, true>(c, k);
    else
      bond_or_friction<dim, false>(c, k);
  view.friction_loss += c.friction_loss;
  view.fracture_loss += c.fracture_loss;
}

template void bond_kernel<2>(ContactView<2>&);
template void bond_kernel<3>(ContactView<3>&);

} // namespace kerf::KERF_ISA
