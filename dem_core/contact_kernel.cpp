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
  std::uint32_t k;
  int count;
  std::uint32_t i[width], j[width];

  KERF_INLINE Batch(const ContactView<dim>& view, std::uint32_t first_contact)
      : c(view), k(first_contact) {
    count = whole || view.end - k >= width ? width : static_cast<int>(view.end - k);
    for (int l = 0; l < width; ++l) {
      const std::uint32_t at = k + static_cast<std::uint32_t>(whole || l < count ? l : count - 1);
      i[l] = c.first[at];
      j[l] = c.second[at];
    }
  }

  /// A number of each contact.
  KERF_INLINE Lanes get(const double* column) const {
    return whole ? load(column + k) : load_some(column + k, count);
  }
  KERF_INLINE void set(double* column, const Lanes& value) const {
    if (whole)
      store(column + k, value);
    else
      store_some(column + k, value, count);
  }

  /// Row p of an array with rows of `size` numbers.
  template <int size> KERF_INLINE Row4 row(const double* array, std::uint32_t p) const {
    const double* from = array + static_cast<std::size_t>(p) * size;
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
      rows[l] = row<size>(array, j[l]) - row<size>(array, i[l]);
    return turned<size>(rows);
  }
  template <int size>
  KERF_INLINE LaneVector<size> gathered(const double* array, const std::uint32_t* p) const {
    if constexpr (size == 1) {
      LaneVector<1> result;
      for (int l = 0; l < width; ++l)
        result[0][l] = array[p[l]];
      return result;
    } else {
      Row4 rows[width];
      for (int l = 0; l < width; ++l)
        rows[l] = row<size>(array, p[l]);
      return turned<size>(rows);
    }
  }

  KERF_INLINE Mask bonded() const {
    Mask mask{};
    for (int l = 0; l < width; ++l)
      if (whole || l < count)
        mask[l] = -static_cast<std::int64_t>(c.bonded[k + static_cast<std::uint32_t>(l)]);
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

/// What the increment has done to a contact. Shear vectors are orthogonal to the normal; in 2D they
/// are numbers along the normal turned by +90 degrees.
template <int dim> struct Kinematics {
  static constexpr int shear_components = ContactView<dim>::shear_components;
  LaneVector<dim> branch, normal; // at the end of the increment
  Lanes length, opening;
  LaneVector<dim> moved;                // of the branch
  LaneVector<shear_components> carried; // tangential force that came along, N
  LaneVector<shear_components> slip;    // m
};

/// The arms share the branch, so that a rigid rotation of both particles makes no slip.
template <bool whole>
KERF_INLINE void follow_shear(const Batch<2, whole>& batch, const Lanes& share, Kinematics<2>& m) {
  const ContactView<2>& c = batch.c;
  const Lanes turn_i = batch.template gathered<1>(c.rotation, batch.i)[0];
  const Lanes turn_j = batch.template gathered<1>(c.rotation, batch.j)[0];
  const Lanes turned = c.scale * (share * turn_i + (1.0 - share) * turn_j);
  const LaneVector<2> middle = sum(m.branch, broadcast(-c.half), m.moved);
  const Lanes length = square_root(dot(middle, middle));
  m.carried[0] = batch.get(c.shear[0]);
  m.slip[0] = (middle[0] * m.moved[1] - middle[1] * m.moved[0]) / length - length * turned;
}

/// The stored force makes the rotation of the branch, the shortest one, and the mean turn of both
/// particles about it; what slips in the middle of the increment makes half of that.
template <bool whole>
KERF_INLINE void follow_shear(const Batch<3, whole>& batch, const Lanes& share, Kinematics<3>& m) {
  const ContactView<3>& c = batch.c;
  const LaneVector<3> turn_i = batch.template gathered<3>(c.rotation, batch.i);
  const LaneVector<3> turn_j = batch.template gathered<3>(c.rotation, batch.j);
  const LaneVector<3> old_branch = sum(m.branch, broadcast(-1.0), m.moved);
  const LaneVector<3> middle = sum(m.branch, broadcast(-c.half), m.moved);
  const LaneVector<3>& n = m.normal;

  LaneVector<3> turned;
  for (int a = 0; a < 3; ++a)
    turned[a] = c.scale * (turn_j[a] + share * (turn_i[a] - turn_j[a]));
  const Lanes middle2 = dot(middle, middle);
  const Lanes inverse_old = 1.0 / square_root(dot(old_branch, old_branch));
  const Lanes inverse_middle = 1.0 / square_root(middle2);
  const LaneVector<3> n_old = scaled(inverse_old, old_branch);
  const LaneVector<3> n_middle = scaled(inverse_middle, middle);

  LaneVector<3> slip = sum(m.moved, broadcast(-1.0), cross(turned, middle));
  slip = sum(slip, -dot(slip, n_middle), n_middle);
  LaneVector<3> mean_turn;
  for (int a = 0; a < 3; ++a)
    mean_turn[a] = turn_i[a] + turn_j[a];
  const Lanes t = 0.25 * c.scale * dot(mean_turn, n_middle); // tangent of half the angle
  const Lanes t_slip = c.half * t;

  // Turn v from the unit vector a to n, then by 2 atan t about n; all divisions in one.
  const LaneVector<3> force = {
      {batch.get(c.shear[0]), batch.get(c.shear[1]), batch.get(c.shear[2])}};
  const Lanes d_force = 1.0 + dot(n_old, n), d_slip = 1.0 + dot(n_middle, n);
  const Lanes e_force = 1.0 + t * t, e_slip = 1.0 + t_slip * t_slip;
  const Lanes d = d_force * d_slip, e = e_force * e_slip;
  const Lanes inverse = 1.0 / (d * e);
  const auto turn = [&](const LaneVector<3>& v, const LaneVector<3>& from, const Lanes& inverse_d,
                        const Lanes& tangent, const Lanes& inverse_e) {
    const Lanes part = -dot(v, n) * inverse_d;
    const LaneVector<3> u = sum(sum(v, part, from), part, n);
    return sum(scaled((1.0 - tangent * tangent) * inverse_e, u), 2.0 * tangent * inverse_e,
               cross(n, u));
  };
  const Lanes inverse_d = inverse * e, inverse_e = inverse * d;
  m.carried = turn(force, n_old, inverse_d * d_slip, t, inverse_e * e_slip);
  m.slip = turn(slip, n_middle, inverse_d * d_force, t_slip, inverse_e * e_force);
}

/// Adds force F to the load of the first particle and -F to that of the second, and shares the
/// couple among them.
template <bool whole>
KERF_INLINE void scatter(const Batch<2, whole>& batch, const LaneVector<2>& F, const Lanes& couple,
                         const Lanes& share) {
  const Lanes on_first = share * couple;
  const Lanes first[4] = {F[0], F[1], on_first, Lanes{}};
  const Lanes second[4] = {-F[0], -F[1], couple - on_first, Lanes{}};
  Row4 row_i[width], row_j[width];
  to_rows(first, row_i);
  to_rows(second, row_j);
  for (int l = 0; l < width; ++l)
    if (whole || l < batch.count) {
      auto* const load_i = reinterpret_cast<Row4*>(batch.c.loads) + batch.i[l];
      *load_i += row_i[l];
      auto* const load_j = reinterpret_cast<Row4*>(batch.c.loads) +
                           batch.c.target[batch.k + static_cast<std::uint32_t>(l)];
      *load_j += row_j[l];
    }
}
template <bool whole>
KERF_INLINE void scatter(const Batch<3, whole>& batch, const LaneVector<3>& F,
                         const LaneVector<3>& couple, const Lanes& share) {
  const Lanes columns[8] = {F[0], F[1], F[2], couple[0], couple[1], couple[2], share, Lanes{}};
  Row8 rows[width];
  to_rows(columns, rows);
  const Row8 plus{1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const Row8 rest{-1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 0.0, 0.0}; // minus the share: of the second
  for (int l = 0; l < width; ++l)
    if (whole || l < batch.count) {
      const Row8 r = rows[l];
      const Row8 s = __builtin_shufflevector(r, Row8{}, 8, 8, 8, 6, 6, 6, 8, 8);
      auto* const load_i = reinterpret_cast<Row8*>(batch.c.loads) + batch.i[l];
      *load_i += r * (plus + s);
      auto* const load_j = reinterpret_cast<Row8*>(batch.c.loads) +
                           batch.c.target[batch.k + static_cast<std::uint32_t>(l)];
      *load_j += r * (rest - s);
    }
}

/// Bond, and the friction that remains when it is broken; docs in contact_forces.hpp.
template <int dim, bool whole>
KERF_INLINE void bond_or_friction(ContactView<dim>& c, std::uint32_t k) {
  constexpr int shears = ContactView<dim>::shear_components;
  const Batch<dim, whole> batch(c, k);
  Kinematics<dim> m;
  const LaneVector<dim> relative = batch.template difference<dim>(c.displacement);
  LaneVector<dim> B;
  for (int a = 0; a < dim; ++a)
    B[a] = batch.get(c.reference_branch[a]);
  if (!whole) // lanes beyond the end: any branch that is not zero
    for (int l = batch.count; l < width; ++l)
      B[0][l] = 1.0 - relative[0][l];
  m.branch = sum(B, broadcast(1.0), relative);
  m.length = square_root(dot(m.branch, m.branch));
  // |b| - |B| from the displacement, so that it keeps its digits when it is small.
  const Lanes reference_length = square_root(dot(B, B));
  m.opening = dot(relative, sum(relative, broadcast(2.0), B)) / (m.length + reference_length) +
              (reference_length - batch.get(c.rest_length));

  const Mask bonded = batch.bonded();
  if (!any(bonded | (m.opening < 0.0))) { // all open: nothing to do, unless one has just opened
    if (!any(batch.get(c.normal_force) != 0.0))
      return;
  }

  m.normal = scaled(1.0 / m.length, m.branch);
  m.moved = scaled(broadcast(c.scale), batch.template difference<dim>(c.translation));
  const Lanes share = batch.get(c.share);
  follow_shear(batch, share, m);

  const Lanes k_n = batch.get(c.normal_stiffness), k_t = batch.get(c.tangential_stiffness);
  Lanes F_n = k_n * m.opening;                          // N; eq. 12
  LaneVector<shears> F_T = sum(m.carried, k_t, m.slip); // N; eq. 13
  const Lanes F_T2 = dot(F_T, F_T);
  const Lanes R_n = batch.get(c.tensile_strength), R_t = batch.get(c.shear_strength);
  const Mask breaks = bonded & ((F_n > R_n) | (F_T2 > R_t * R_t)); // eqs 14, 15
  const Mask free = ~(bonded & ~breaks);
  const Lanes weight = c.weight != nullptr ? batch.get(c.weight) : broadcast(1.0);

  if (any(free)) {
    const Lanes trial_n = F_n;
    const LaneVector<shears> trial_T = F_T;
    F_n = select(free & (F_n > 0.0), Lanes{}, F_n);
    const Lanes limit = c.friction * absolute(F_n);
    const Lanes size = square_root(F_T2);
    const Mask slides = free & (size > limit);
    F_T = scaled(select(slides, limit / size, broadcast(1.0)), F_T);

    // Work of a spring that gives way: mean force times the slip that is not elastic.
    const Lanes lost_T =
        0.5 * weight *
        dot(sum(m.carried, broadcast(1.0), F_T), sum(trial_T, broadcast(-1.0), F_T)) / k_t;
    c.friction_loss += kerf::KERF_ISA::sum(select(slides & ~breaks, lost_T, Lanes{}));
    if (any(breaks)) {
      const Lanes before_n = batch.get(c.normal_force);
      const Lanes lost =
          select(slides, lost_T, Lanes{}) + 0.5 * weight * (before_n + F_n) * (trial_n - F_n) / k_n;
      c.fracture_loss += kerf::KERF_ISA::sum(select(breaks, lost, Lanes{}));
      for (int l = 0; l < width; ++l)
        if (breaks[l] != 0) {
          const std::uint32_t at = k + static_cast<std::uint32_t>(l);
          c.bonded[at] = 0;
          c.on_break(c.breaks, at, trial_n[l] > R_n[l] ? BreakMode::tension : BreakMode::shear,
                     lost[l]);
        }
    }
  }
  batch.set(c.normal_force, F_n);
  for (int a = 0; a < shears; ++a)
    batch.set(c.shear[a], F_T[a]);

  if constexpr (dim == 2) { // F_T acts along (-n_y, n_x); F_n has no arm
    const LaneVector<2>& n = m.normal;
    const LaneVector<2> F = {
        {weight * (F_n * n[0] - F_T[0] * n[1]), weight * (F_n * n[1] + F_T[0] * n[0])}};
    scatter(batch, F, weight * m.length * F_T[0], share);
  } else {
    const LaneVector<3> F = scaled(weight, sum(F_T, F_n, m.normal)); // eq. 11
    scatter(batch, F, scaled(weight, cross(m.branch, F_T)), share);
  }
}

/// True when a contact of the batch joins the last particle.
template <int dim> KERF_INLINE bool reaches_the_end(const ContactView<dim>& c, std::uint32_t k) {
  bool reaches = false;
  for (int l = 0; l < width; ++l)
    reaches |= c.second[k + static_cast<std::uint32_t>(l)] + 1 == c.particles;
  return reaches;
}

} // namespace

template <int dim> void bond_kernel(ContactView<dim>& c) {
  for (std::uint32_t k = c.begin; k < c.end; k += width)
    if (c.end - k >= width && !reaches_the_end(c, k))
      bond_or_friction<dim, true>(c, k);
    else
      bond_or_friction<dim, false>(c, k);
}

template void bond_kernel<2>(ContactView<2>&);
template void bond_kernel<3>(ContactView<3>&);

} // namespace kerf::KERF_ISA
