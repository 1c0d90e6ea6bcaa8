// Rows of nodes from one step to the next. Compiled once for every set of instructions.
#include "fem_core/kernels/advance.hpp"

#include "common/lanes.hpp"
#include "fem_core/kernels/patch_view.hpp"

namespace kerf::KERF_ISA {
namespace {

using fem::row_size;
using fem::RowsView;

/// The least number of rows that fill vectors, and these.
template <int dim> struct Chunk {
  static constexpr int size = row_size<dim>;
  static constexpr int vectors = size > width ? size / width : 1;
  static constexpr int rows = vectors * width / size;
};

/// One number for every row of a vector, from the first one's on.
template <int dim> KERF_INLINE Lanes of_rows(const double* from) {
#if defined(__AVX512F__)
  if constexpr (dim == 2) {
    Row4 four;
    std::memcpy(&four, from, sizeof four);
    return __builtin_shufflevector(four, four, 0, 0, 1, 1, 2, 2, 3, 3);
  }
#endif
  Lanes lanes;
  for (int l = 0; l < width; ++l)
    lanes[l] = from[l / row_size<dim>];
  return lanes;
}

/// Sums of RowsView, for every number of a chunk.
struct Sums {
  Lanes kinetic{}, momentum[2]{}, fallen[2]{}, lost[2]{}, squares{};
};

/// @param special  with anything besides force and gravity of all of the mass
template <int dim, bool special>
KERF_INLINE void advance_chunk(const RowsView& view, const double* mass, const double* weighed,
                               const double* force, const double* prescribed, double* velocity,
                               double* displacement, Sums (&sums)[Chunk<dim>::vectors]) {
  const double dt = view.time_step;
  for (int v = 0; v < Chunk<dim>::vectors; ++v) {
    const int at = v * width;
    const Lanes m = of_rows<dim>(mass), of_step = dt / m;
    const Lanes w = special && weighed != nullptr ? of_rows<dim>(weighed) : m;
    Lanes gravity;
    for (int l = 0; l < width; ++l)
      gravity[l] = view.gravity[(at + l) % row_size<dim>];
    const Lanes f = load(force + at) + w * gravity, old = load(velocity + at);
    Lanes before = old, after, squares = f * f;
    Sums& sum = sums[v];
    if constexpr (special) {
      const Lanes size = absolute(f);
      const Lanes with = select(old > 0.0, size, select(old < 0.0, -size, Lanes{}));
      const Lanes net = f - view.local_damping * with;
      if (view.first)
        before -= 0.5 * of_step * net;
      Lanes resisted; // N
      if (view.stop) {
        after = 0.5 * of_step * f;
        resisted = f - (after - before) / of_step;
      } else {
        const double half = 0.5 * view.mass_damping * dt;
        after = ((1.0 - half) * before + of_step * net) / (1.0 + half);
        resisted = f - net + (0.5 * view.mass_damping) * m * (before + after);
      }
      if (prescribed != nullptr) {
        const Lanes given = load(prescribed + at);
        const Mask is_free = given != given;
        before = select(is_free, before, old);
        after = select(is_free, after, given);
        resisted = select(is_free, resisted, Lanes{});
        squares = select(is_free, squares, Lanes{});
      }
      sum.lost[0] += resisted * before;
      sum.lost[1] += resisted * after;
      sum.fallen[0] += w * before;
      sum.fallen[1] += w * after;
    } else {
      if (view.first)
        before -= 0.5 * of_step * f;
      after = before + of_step * f;
    }
    store(velocity + at, after);
    store(displacement + at, load(displacement + at) + dt * after);
    const Lanes carried = m * before;
    sum.kinetic += carried * after;
    sum.momentum[0] += carried;
    sum.momentum[1] += m * after;
    sum.squares += squares;
  }
}

template <int dim, bool special> void advance_rows(RowsView& all) {
  constexpr int size = row_size<dim>, vectors = Chunk<dim>::vectors;
  constexpr std::size_t rows = Chunk<dim>::rows;
  const RowsView view = all; // a copy: nothing else can change its constants
  Sums sums[vectors];
  const std::size_t whole = view.count / rows * rows;
  for (std::size_t row = 0; row < whole; row += rows)
    advance_chunk<dim, special>(view, view.mass + row,
                                view.weighed == nullptr ? nullptr : view.weighed + row,
                                view.force + row * size,
                                view.prescribed == nullptr ? nullptr : view.prescribed + row * size,
                                view.velocity + row * size, view.displacement + row * size, sums);
  if (const std::size_t left = view.count - whole; left > 0) { // with rows that are held at rest
    constexpr int numbers = vectors * width;
    double mass[rows], weighed[rows], force[numbers]{}, held[numbers]{}, velocity[numbers]{},
        displacement[numbers]{};
    for (std::size_t k = 0; k < rows; ++k) {
      mass[k] = k < left ? view.mass[whole + k] : 1.0;
      weighed[k] = k < left && view.weighed != nullptr ? view.weighed[whole + k] : mass[k];
    }
    for (std::size_t k = 0; k < left * size; ++k) {
      const std::size_t at = whole * size + k;
      force[k] = view.force[at];
      held[k] = view.prescribed == nullptr ? __builtin_nan("") : view.prescribed[at];
      velocity[k] = view.velocity[at];
      displacement[k] = view.displacement[at];
    }
    advance_chunk<dim, true>(view, mass, weighed, force, held, velocity, displacement, sums);
    std::memcpy(view.velocity + whole * size, velocity, left * size * sizeof(double));
    std::memcpy(view.displacement + whole * size, displacement, left * size * sizeof(double));
  }
  for (int k = 0; k < vectors * width; ++k) {
    const Sums& sum = sums[k / width];
    const int l = k % width, i = k % size;
    all.kinetic[i] += sum.kinetic[l];
    all.squares[i] += sum.squares[l];
    for (int when = 0; when < 2; ++when) {
      all.momentum[when][i] += sum.momentum[when][l];
      all.fallen[when][i] += (special ? sum.fallen : sum.momentum)[when][l];
      all.lost[when][i] += sum.lost[when][l];
    }
  }
}

} // namespace

template <int dim> void advance(RowsView& view) {
  if (view.prescribed != nullptr || view.weighed != nullptr || view.stop ||
      view.mass_damping > 0.0 || view.local_damping > 0.0)
    advance_rows<dim, true>(view);
  else
    advance_rows<dim, false>(view);
}

template void advance<2>(RowsView&);
template void advance<3>(RowsView&);

} // namespace kerf::KERF_ISA
