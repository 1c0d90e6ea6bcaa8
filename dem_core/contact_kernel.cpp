// The force of bonded and of frictional contacts, several at a time. Compiled once for every set of
// instructions; see contact_forces.hpp for what is computed and cmake/instruction_sets.cmake.
#include "common/lanes.hpp"
#include "dem_core/contact_chunk.hpp"
#include "dem_core/contact_laws.hpp"
#include "dem_core/contact_view.hpp"

namespace kerf::KERF_ISA {
namespace {

using dem::BreakMode;

/// How the two particles of a contact have moved during the increment.
template <int dim> struct Increments {
  static constexpr int rotations = ContactView<dim>::shear_components;
  LaneVector<dim> normal;               // at the end
  Lanes length;                         // of the branch at the end, m
  LaneVector<dim> moved;                // of the branch, m
  LaneVector<rotations> turn_i, turn_j; // rad
  Lanes share;                          // of the branch that is arm of the first

  template <bool whole> KERF_INLINE explicit Increments(const Batch<dim, whole>& batch) {
    const ContactView<dim>& c = batch.c;
    normal = batch.column(batch.chunk.normal);
    length = load(&batch.chunk.length[batch.at]);
    moved = scaled(broadcast(c.scale), batch.column(batch.chunk.moved));
    turn_i = scaled(broadcast(c.scale), batch.column(batch.chunk.turn_first));
    turn_j = scaled(broadcast(c.scale), batch.column(batch.chunk.turn_second));
    share = batch.get(c.share);
  }
  KERF_INLINE LaneVector<dim> branch() const { return scaled(length, normal); }
};

/// What came along with the contact to the end of the increment, and the slip; both are tangential.
/// In 2D they are numbers along the normal turned by +90 degrees, in 3D vectors.
template <int dim> struct Carried {
  static constexpr int size = ContactView<dim>::shear_components;
  LaneVector<size> trial;  // tangential force as if nothing gave way, N
  LaneVector<size> slip;   // m
  LaneVector<size> moment; // that came along, N m
};

/// The arms share the branch, so that a rigid rotation of both particles makes no slip.
template <bool with_moment, bool whole>
KERF_INLINE Carried<2> carry(const Batch<2, whole>& batch, const Increments<2>& m,
                             const Lanes& fade, const Lanes& k_t) {
  const ContactView<2>& c = batch.c;
  const Lanes turned = m.turn_j[0] + m.share * (m.turn_i[0] - m.turn_j[0]);
  const LaneVector<2> middle = sum(m.branch(), broadcast(-c.half), m.moved);
  const Lanes length2 = dot(middle, middle);
  Carried<2> result;
  result.slip[0] = inverse_square_root(length2) *
                   (middle[0] * m.moved[1] - middle[1] * m.moved[0] - length2 * turned);
  result.trial[0] = fade * batch.get(c.shear[0]) + k_t * result.slip[0];
  if constexpr (with_moment)
    result.moment[0] = batch.get(c.moment[0]);
  return result;
}

/// The stored force F makes the shortest rotation from the branch at the start to the one at the
/// end, which is two half turns, about the branch at the start and about the middle, and the mean
/// turn of both particles about the branch. The slip s is that of the middle of the increment: half
/// of the growth makes the rotation R too, R (F + k_t s / 2) + k_t s / 2, which is the same there
/// and back.
struct Turn {
  LaneVector<3> middle, normal; // the normal at the end
  Lanes twice_inverse_middle2;  // 1/m²
  Lanes q, u;                   // of the turn about the normal: tan(angle / 2), sin(angle)

  /// A half turn about the middle, and the opposite of that.
  KERF_INLINE LaneVector<3> mirrored(const LaneVector<3>& v) const {
    return sum(v, -twice_inverse_middle2 * dot(v, middle), middle);
  }
  /// Of a vector across the branch at the start, which the half turn about that makes its opposite.
  KERF_INLINE LaneVector<3> of_tangent(const LaneVector<3>& v) const {
    const LaneVector<3> at_end = mirrored(v);
    return sum(at_end, u, sum(cross(normal, at_end), -q, at_end));
  }
  KERF_INLINE LaneVector<3> of_any(const LaneVector<3>& v, const LaneVector<3>& start) const {
    const Lanes along = dot(v, start) * inverse(dot(start, start));
    return sum(of_tangent(sum(v, -along, start)), -along, mirrored(start));
  }
};

template <bool with_moment, bool whole>
KERF_INLINE Carried<3> carry(const Batch<3, whole>& batch, const Increments<3>& m,
                             const Lanes& fade, const Lanes& k_t) {
  const ContactView<3>& c = batch.c;
  const LaneVector<3> branch = m.branch();
  const LaneVector<3> middle = sum(branch, broadcast(-0.5), m.moved);
  const Lanes inverse_middle = inverse_square_root(dot(middle, middle));
  const Lanes inverse_middle2 = inverse_middle * inverse_middle;

  const bool at_end = c.half == 0.0;
  const LaneVector<3>& lever = at_end ? branch : middle;
  const Lanes inverse_lever2 = at_end ? inverse(dot(branch, branch)) : inverse_middle2;
  LaneVector<3> turn; // of the branch, less that of the particles where they touch
  const LaneVector<3> swept = cross(lever, m.moved);
  for (int a = 0; a < 3; ++a)
    turn[a] = inverse_lever2 * swept[a] - m.turn_j[a] - m.share * (m.turn_i[a] - m.turn_j[a]);
  Carried<3> result;
  result.slip = cross(turn, lever);

  Turn R = {middle, m.normal, 2.0 * inverse_middle2, {}, {}};
  R.q = 0.25 * inverse_middle * dot(sum(m.turn_i, broadcast(1.0), m.turn_j), middle);
  R.u = 2.0 * R.q * inverse(1.0 + R.q * R.q);
  const LaneVector<3> force = {
      {fade * batch.get(c.shear[0]), fade * batch.get(c.shear[1]), fade * batch.get(c.shear[2])}};
  const LaneVector<3> trial =
      sum(R.of_tangent(sum(force, c.half * k_t, result.slip)), (1.0 - c.half) * k_t, result.slip);
  result.trial = sum(trial, -dot(trial, m.normal), m.normal);
  if constexpr (with_moment)
    result.moment =
        R.of_any({{batch.get(c.moment[0]), batch.get(c.moment[1]), batch.get(c.moment[2])}},
                 sum(branch, broadcast(-1.0), m.moved));
  return result;
}

/// The moment of a contact: a spring against the relative rotation of its particles. Bonds keep it;
/// free contacts roll when it exceeds mu_r R* |F_n|, and twist freely.
template <int dim> struct MomentLaw {
  static constexpr int rotations = ContactView<dim>::shear_components;
  LaneVector<rotations> moment; // on the first particle, N m
  Lanes bending2, twisting2;    // squares of its parts, N² m²
  Lanes k_b;                    // N m

  template <bool whole>
  KERF_INLINE MomentLaw(const Batch<dim, whole>& batch, const LaneVector<rotations>& carried,
                        const Lanes& bending_stiffness)
      : k_b(bending_stiffness) {
    const Increments<dim> m(batch);
    const LaneVector<rotations> apart = sum(m.turn_j, broadcast(-1.0), m.turn_i); // rad
    if constexpr (dim == 2) {
      moment[0] = carried[0] + k_b * apart[0];
      twisting2 = Lanes{};
    } else {
      const Lanes k_w = batch.get(batch.c.twisting_stiffness);
      moment = sum(sum(carried, k_b, apart), (k_w - k_b) * dot(apart, m.normal), m.normal);
      const Lanes twisting = dot(moment, m.normal);
      twisting2 = twisting * twisting;
    }
    bending2 = dot(moment, moment) - twisting2;
  }

  /// Bounds the moment of free contacts; returns what that loses, with half a mean, J.
  template <bool whole>
  KERF_INLINE Lanes release(const Batch<dim, whole>& batch, const LaneVector<dim>& n,
                            const LaneVector<rotations>& carried, const Mask& free,
                            const Lanes& F_n) {
    const LaneVector<rotations> trial = moment;
    if constexpr (dim == 3) // no twist
      moment = sum(moment, select(free, -dot(moment, n), Lanes{}), n);
    const Lanes limit = batch.get(batch.c.rolling_limit) * absolute(F_n);
    const Lanes size2 = dot(moment, moment);
    const Mask rolls = free & (size2 > limit * limit);
    moment = scaled(select(rolls, limit / square_root(size2), broadcast(1.0)), moment);
    const Lanes lost =
        0.5 * dot(sum(carried, broadcast(1.0), moment), sum(trial, broadcast(-1.0), moment)) / k_b;
    return select(free & (k_b > 0.0), lost, Lanes{});
  }
};

/// The first pass: where the contacts are. The difference of the squares of length and rest length
/// comes from the displacement, so that it keeps its digits when it is small; what is left of it
/// where bonds are free of stress at their reference is rounding.
template <int dim, bool whole>
KERF_INLINE void find_opening(const Batch<dim, whole>& batch, Chunk<dim>& chunk) {
  const LaneVector<dim> relative = batch.column(chunk.relative);
  LaneVector<dim> B;
  for (int a = 0; a < dim; ++a)
    B[a] = batch.get(batch.c.reference_branch[a]);
  if (!whole) // beyond the count: any branch that is not zero
    for (int l = batch.count; l < width; ++l)
      B[0][l] = 1.0 - relative[0][l];
  const LaneVector<dim> branch = sum(B, broadcast(1.0), relative);
  const Lanes length2 = dot(branch, branch);
  const Lanes inverse_length = inverse_square_root(length2);
  const Lanes length = length2 * inverse_length;
  const Lanes rest = batch.get(batch.c.rest_length);
  constexpr double rounding = 4e-15;
  const Lanes rest2 = rest * rest, start = dot(B, B) - rest2;
  const Lanes growth = dot(relative, sum(relative, broadcast(2.0), B)) +
                       select(absolute(start) > rounding * rest2, start, Lanes{});
  batch.set_column(chunk.normal, scaled(inverse_length, branch));
  store(&chunk.length[batch.at], length);
  store(&chunk.opening[batch.at], growth * inverse(length + rest));
}

/// The smallest gap of pairs that are apart and were, for which there is nothing to do; 0 when one
/// touches or did.
template <int dim>
KERF_INLINE double least_gap(const ContactView<dim>& c, const Chunk<dim>& chunk) {
  Mask touch{};
  Lanes least = broadcast(__builtin_inf());
  for_batches(c, chunk, [&](auto batch) KERF_LAMBDA {
    const Lanes gap = load(&chunk.opening[batch.at]);
    touch |= ~(gap > 0.0) | (batch.get(c.normal_force) != 0.0);
    least = select(gap < least, gap, least);
  });
  return any(touch) ? 0.0 : smallest(least);
}

/// The second pass: what comes along, eq. 13.
template <int dim, class Law, bool more, bool whole>
KERF_INLINE void carry_history(const Batch<dim, whole>& batch, Chunk<dim>& chunk) {
  const Increments<dim> m(batch);
  const Lanes opening = load(&chunk.opening[batch.at]);
  const Lanes k_t = Law::tangential_stiffness(batch.get(batch.c.tangential_stiffness), opening);
  Lanes fade = broadcast(1.0); // of the tangential force as a stiffening contact is released
  if (Law::stiffens) {
    const Lanes before = opening - dot(m.moved, m.normal);
    fade = select((opening > before) & (opening < 0.0), square_root(opening / before), fade);
  }
  const Carried<dim> carried = carry<more>(batch, m, fade, k_t);
  batch.set_column(chunk.trial, carried.trial);
  batch.set_column(chunk.slip, carried.slip);
  if constexpr (more)
    batch.set_column(chunk.carried_moment, carried.moment);
}

/// The third pass: what the contacts can bear, and what they do to the particles. `more`: with
/// dashpots and moments.
template <int dim, class Law, bool more, bool bonds, bool whole>
KERF_INLINE void bound(ContactView<dim>& c, const Batch<dim, whole>& batch, Chunk<dim>& chunk) {
  constexpr int shears = ContactView<dim>::shear_components;
  const LaneVector<dim> n = batch.column(chunk.normal);
  const Lanes opening = load(&chunk.opening[batch.at]), length = load(&chunk.length[batch.at]);
  const Mask bonded = bonds ? batch.flags(c.bonded) : Mask{};
  const Lanes k_n = batch.get(c.normal_stiffness);
  const Lanes k_t = Law::tangential_stiffness(batch.get(c.tangential_stiffness), opening);
  Carried<dim> carried;
  carried.trial = batch.column(chunk.trial);
  carried.slip = batch.column(chunk.slip);
  if constexpr (more)
    carried.moment = batch.column(chunk.carried_moment);

  Lanes F_n = Law::normal_force(k_n, opening); // N
  LaneVector<shears> F_T = carried.trial;
  const Lanes R_n = batch.get(c.tensile_strength), R_t = batch.get(c.shear_strength);
  const Lanes trial_n = F_n, trial_T2 = dot(F_T, F_T);
  Lanes tension = F_n, shear2 = trial_T2; // what is compared with the strengths
  [[maybe_unused]] LaneVector<shears> M;
  [[maybe_unused]] Lanes lost_moment{};
  if constexpr (more) {
    MomentLaw<dim> law(batch, carried.moment,
                       Law::tangential_stiffness(batch.get(c.bending_stiffness), opening));
    const Lanes lever = batch.get(c.bond_lever);
    tension += lever * square_root(law.bending2);
    const Lanes shear = square_root(trial_T2) + 0.5 * lever * square_root(law.twisting2);
    shear2 = shear * shear;
    const Mask breaking = bonded & ((tension > R_n) | (shear2 > R_t * R_t));
    const Mask free = ~bonded | breaking;
    if (any(free))
      lost_moment = law.release(batch, n, carried.moment, free, select(F_n < 0.0, F_n, Lanes{}));
    M = law.moment;
  }
  const Mask breaks = bonded & ((tension > R_n) | (shear2 > R_t * R_t)); // eqs 14, 15
  const Mask free = ~bonded | breaks;
  const Lanes weight = batch.only_contacts(batch.get(c.weight));
  [[maybe_unused]] Mask slides{};

  if (any(free)) {
    F_n = select(free & (F_n > 0.0), Lanes{}, F_n);
    const Lanes limit = batch.get(c.friction) * absolute(F_n);
    slides = free & (trial_T2 > limit * limit);
    Lanes lost{};
    if (any(slides)) {
      F_T = scaled(select(slides, limit * inverse_square_root(trial_T2), broadcast(1.0)), F_T);
      // Work of a spring that gives way: mean force times the slip that is not elastic.
      const LaneVector<shears> twice_mean =
          sum(sum(carried.trial, -k_t, carried.slip), broadcast(1.0), F_T);
      const Lanes lost_T =
          0.5 * dot(twice_mean, sum(carried.trial, broadcast(-1.0), F_T)) * inverse(k_t);
      lost = select(slides & (k_t > 0.0), lost_T, Lanes{});
    }
    lost = weight * (lost + lost_moment);
    c.friction_loss += total(select(~breaks, lost, Lanes{}));
    if (any(breaks)) {
      const Lanes before_n = batch.get(c.normal_force);
      const Lanes released = lost + 0.5 * weight * (before_n + F_n) * (trial_n - F_n) / k_n;
      c.fracture_loss += total(select(breaks, released, Lanes{}));
      for (int l = 0; l < width; ++l)
        if (breaks[l] != 0) {
          const std::size_t k = batch.k + static_cast<std::size_t>(l);
          c.bonded[k] = 0;
          c.on_break(c.breaks, static_cast<std::uint32_t>(k),
                     tension[l] > R_n[l] ? BreakMode::tension : BreakMode::shear, released[l]);
        }
    }
  }
  batch.set(c.normal_force, F_n);
  for (int a = 0; a < shears; ++a)
    batch.set(c.shear[a], F_T[a]);

  if constexpr (more) {
    for (int a = 0; a < shears; ++a)
      batch.set(c.moment[a], M[a]);
    M = scaled(weight, M);
    // Dashpots act while the contact carries, the tangential one while it does not slide.
    const Mask pressed = opening < 0.0;
    const Mask carries = pressed | (bonded & ~breaks);
    const Lanes c_n = Law::viscosity(batch.get(c.normal_viscosity), opening);
    const Lanes c_t = Law::viscosity(batch.get(c.tangential_viscosity), opening);
    const Lanes approach = dot(scaled(broadcast(c.scale), batch.column(chunk.moved)), n);
    const Lanes viscous_n = select(carries, c.rate * c_n * approach, Lanes{});
    const LaneVector<shears> viscous_T =
        scaled(select(carries & ~slides, c.rate * c_t, Lanes{}), carried.slip);
    c.viscous_loss += total(weight * (viscous_n * approach + dot(viscous_T, carried.slip)));
    F_n += viscous_n;
    F_T = sum(F_T, broadcast(1.0), viscous_T);
  }
  F_n *= weight;
  F_T = scaled(weight, F_T);
  LaneVector<dim> F;
  LaneVector<shears> couple;
  if constexpr (dim == 2) { // F_T acts along (-n_y, n_x); F_n has no arm
    F = {{F_n * n[0] - F_T[0] * n[1], F_n * n[1] + F_T[0] * n[0]}};
    couple[0] = length * F_T[0];
  } else {
    F = sum(F_T, F_n, n);
    couple = scaled(length, cross(n, F_T)); // eq. 11
  }
  LaneVector<shears> on_first = scaled(batch.get(c.share), couple);
  LaneVector<shears> on_second = sum(couple, broadcast(-1.0), on_first);
  if constexpr (more) {
    on_first = sum(on_first, broadcast(1.0), M);
    on_second = sum(on_second, broadcast(-1.0), M);
  }
  scatter(batch, F, on_first, on_second);
}

KERF_INLINE std::size_t least(std::size_t a, std::size_t b) {
  return a < b ? a : b;
}

/// Asks for what the chunk after the next one needs, which may still be far away: its columns and
/// the particles that its contacts come to.
template <int dim>
KERF_INLINE void prefetch(const ContactView<dim>& c, std::size_t begin, std::size_t end) {
  constexpr std::size_t line = 8; // numbers
  constexpr int row = dim == 2 ? 2 : 4, rotation = dim == 2 ? 1 : 4, load = dim == 2 ? 4 : 8;
  const auto ask = [](const double* at) { __builtin_prefetch(at, 0, 3); };
  for (std::size_t k = begin; k < end; k += line) {
    for (int a = 0; a < dim; ++a)
      ask(c.reference_branch[a] + k);
    for (int a = 0; a < ContactView<dim>::shear_components; ++a)
      ask(c.shear[a] + k);
    ask(c.rest_length + k);
    ask(c.share + k);
    ask(c.normal_force + k);
  }
  for (std::size_t k = begin; k < end; ++k) {
    const std::size_t j = c.second[k];
    ask(c.displacement + row * j);
    ask(c.translation + row * j);
    ask(c.rotation + rotation * j);
    ask(c.loads + load * c.target[k]);
  }
}

/// Of a chunk that is gathered and knows its openings.
template <int dim, class Law, bool more, bool bonds>
KERF_INLINE void finish(ContactView<dim>& c, Chunk<dim>& chunk) {
  for_batches(c, chunk,
              [&](auto batch) KERF_LAMBDA { carry_history<dim, Law, more>(batch, chunk); });
  for_batches(c, chunk,
              [&](auto batch) KERF_LAMBDA { bound<dim, Law, more, bonds>(c, batch, chunk); });
}

/// What has or had a bond.
template <int dim, class Law, bool more>
KERF_INLINE void compute_bonds(ContactView<dim>& c, std::size_t begin, std::size_t end) {
  Chunk<dim> chunk;
  for (std::size_t k = begin; k < end; k += chunk_size) {
    chunk.start(c, k, end);
    prefetch(c, least(end, k + 2 * chunk_size), least(end, k + 3 * chunk_size));
    gather<dim, true, true>(c, chunk);
    for_batches(c, chunk, [&](auto batch) KERF_LAMBDA { find_opening<dim>(batch, chunk); });
    finish<dim, Law, more, true>(c, chunk);
  }
}

/// Pairs that never had a bond. Many are apart, and stay so for some time.
template <int dim, class Law, bool more>
KERF_INLINE void compute_loose(ContactView<dim>& c, std::size_t begin, std::size_t end) {
  Chunk<dim> chunk;
  double* clear_until = c.clear_until;
  for (std::size_t k = begin; k < end; k += chunk_size, ++clear_until) {
    if (c.travelled < *clear_until)
      continue;
    chunk.start(c, k, end);
    prefetch(c, least(end, k + 2 * chunk_size), least(end, k + 3 * chunk_size));
    const bool were_apart = *clear_until > 0.0;
    if (were_apart)
      gather<dim, true, false>(c, chunk);
    else
      gather<dim, true, true>(c, chunk);
    for_batches(c, chunk, [&](auto batch) KERF_LAMBDA { find_opening<dim>(batch, chunk); });
    if (const double gap = least_gap(c, chunk); gap > 0.0) {
      *clear_until = c.travelled + 0.4999 * gap; // both may come nearer
      continue;
    }
    *clear_until = 0.0;
    if (were_apart)
      gather<dim, false, true>(c, chunk);
    finish<dim, Law, more, false>(c, chunk);
  }
}

} // namespace

template <int dim, class Law, bool more> void contact_kernel(ContactView<dim>& view) {
  ContactView<dim> c = view; // a copy: nothing else can change its constants
  if constexpr (Law::has_bonds)
    compute_bonds<dim, Law, more>(c, c.begin, c.loose);
  compute_loose<dim, Law, more>(c, c.loose, c.end);
  view.friction_loss += c.friction_loss;
  view.fracture_loss += c.fracture_loss;
  view.viscous_loss += c.viscous_loss;
}

template <int dim> dem::ContactKernel<dim> kernel_of(dem::ContactLaw law) {
  switch (law) {
  case dem::ContactLaw::hertz_mindlin:
    return contact_kernel<dim, HertzMindlinLaw, true>;
  case dem::ContactLaw::linear_with_moments:
    return contact_kernel<dim, LinearLaw, true>;
  case dem::ContactLaw::linear:
    break;
  }
  return contact_kernel<dim, LinearLaw, false>;
}

template dem::ContactKernel<2> kernel_of<2>(dem::ContactLaw);
template dem::ContactKernel<3> kernel_of<3>(dem::ContactLaw);

} // namespace kerf::KERF_ISA
