// A vector of elements while their internal forces are computed; Rojek (2008) eqs 24 and 44. The
// integral over a configuration, reference or current, is taken on the reference element.
#pragma once

#include "fem_core/kernels/deformation.hpp"

namespace kerf::KERF_ISA {

using fem::batch_size;
using fem::Kinematics;
using fem::PatchView;
using fem::Space;

/// Where the numbers of elements begin in an array [batches][count][batch_size].
KERF_INLINE std::size_t place(std::size_t first, int count) {
  return first / batch_size * batch_size * static_cast<std::size_t>(count) + first % batch_size;
}

/// Calls act(first element, how many) for every vector of elements of a patch.
template <class Act> KERF_INLINE void for_vectors(const PatchView& view, Act act) {
  for (std::size_t first = 0; first < view.num_elements; first += width) {
    const std::size_t left = view.num_elements - first;
    act(first, left < width ? static_cast<int>(left) : width);
  }
}

/// N_a at a point.
template <Shape shape> constexpr double shape_value(int q, int a) {
  if constexpr (shape == Shape::tri3)
    return 1.0 / 3.0;
  const double x = (q & 1) != 0 ? gauss_point : -gauss_point;
  const double y = (q & 2) != 0 ? gauss_point : -gauss_point;
  const double sign_x = a == 1 || a == 2 ? 1.0 : -1.0, sign_y = a >= 2 ? 1.0 : -1.0;
  return 0.25 * (1.0 + sign_x * x) * (1.0 + sign_y * y);
}

/// Displacement gradient or its increment at a point.
template <int dim> struct Deformation {
  Matrix<dim> gradient; // times factor
  Lanes factor;
  Tensor<dim> strain; // the symmetric part; zz of 2D is the hoop, or zero
  Lanes own_trace;    // that of strain, before a formulation has averaged it
};

/// Where and with which weight a stress acts.
template <int dim> struct PointForce {
  Matrix<dim> cof;
  Lanes weight; // the force is weight * stress . cof
  Lanes hoop;   // and, of the hoop stress, hoop * N_a
  Lanes volume; // in the middle of the increment, or of the reference configuration, m³
  Lanes end;    // at the end of the increment, m³
};

template <Shape shape, Kinematics kinematics, Space space> struct ElementVector {
  static constexpr int dim = ShapeOf<shape>::dim, nodes = ShapeOf<shape>::nodes,
                       points = ShapeOf<shape>::points;
  static constexpr bool ring = space == Space::axisymmetric;

  const PatchView& view;
  std::size_t first;
  int count;
  Columns<dim> X[nodes], motion[nodes], force[nodes];
  Derivatives<shape> dX, dm, df;

  KERF_INLINE ElementVector(const PatchView& patch, std::size_t at, int elements)
      : view(patch), first(at), count(elements) {
    const std::uint16_t* node = view.nodes + place(first, nodes);
#pragma GCC unroll 8
    for (int a = 0; a < nodes; ++a) {
      X[a] = gather<dim>(view.reference, node + a * batch_size);
      motion[a] = gather<dim>(view.motion, node + a * batch_size);
      force[a] = {};
    }
    dX.set(X);
    dm.set(motion);
    df.clear();
  }

  /// The lanes of one number of a point in an array [batches][points][size][batch_size].
  KERF_INLINE std::size_t at(int q, int size = 1) const {
    return place(first, points * size) + static_cast<std::size_t>(q * size) * batch_size;
  }

  KERF_INLINE Lanes interpolated(int q, const Columns<dim> (&corner)[nodes]) const {
    Lanes sum = shape_value<shape>(q, 0) * corner[0].c[0];
    for (int a = 1; a < nodes; ++a)
      sum += shape_value<shape>(q, a) * corner[a].c[0];
    return sum;
  }

  KERF_INLINE void deform(int q, Deformation<dim>& d, PointForce<dim>& f) const {
    constexpr double whole_ring = 6.28318530717958647693;
    const Matrix<dim> jX = at_point(dX, q), jm = at_point(dm, q);
    Lanes share = broadcast(ShapeOf<shape>::scale);
    if (view.alpha != nullptr)
      share *= load(view.alpha + at(q));
    if constexpr (kinematics == Kinematics::rate) {
      const Jacobian<dim> middle(sum(jX, -0.5 * view.motion_scale, jm)), end(jX);
      d.gradient = middle.gradient_times_det(jm);
      d.factor = view.motion_scale * inverse(middle.det);
      f.cof = end.cof;
      f.weight = share;
      f.volume = share * middle.det;
      f.end = share * end.det;
    } else {
      const Jacobian<dim> reference(jX);
      d.gradient = reference.gradient_times_det(jm);
      d.factor = view.motion_scale * inverse(reference.det);
      f.volume = share * reference.det;
      if constexpr (kinematics == Kinematics::total) { // Kirchhoff stress in the reference volume
        const Jacobian<dim> end(sum(jX, 1.0, jm));
        f.cof = end.cof;
        f.weight = f.volume * inverse(end.det);
      } else {
        f.cof = reference.cof;
        f.weight = share;
      }
      f.end = f.volume;
    }
    d.strain = symmetric(d.gradient, d.factor);
    if constexpr (ring) {
      const Lanes radius = interpolated(q, X), moved = interpolated(q, motion);
      const Lanes of_strain =
          kinematics == Kinematics::rate ? radius - 0.5 * view.motion_scale * moved : radius;
      d.strain[2] = view.motion_scale * moved / of_strain;
      f.hoop = whole_ring * f.end;
      if constexpr (kinematics == Kinematics::total)
        f.hoop *= radius / (radius + moved);
      f.weight *= whole_ring * radius;
      f.volume *= whole_ring * of_strain;
      f.end *= whole_ring * radius;
    }
    d.own_trace = trace(d.strain);
  }

  KERF_INLINE void add(int q, const PointForce<dim>& f, const Tensor<dim>& stress) {
    add_force<shape, dim>(df, q, stress, f.cof, f.weight);
    if constexpr (ring)
      for (int a = 0; a < nodes; ++a)
        force[a].c[0] += shape_value<shape>(q, a) * (stress[2] * f.hoop);
  }

  KERF_INLINE void scatter() {
    Columns<dim> corner[nodes];
    df.corner_forces(corner);
    const std::uint16_t* node = view.nodes + place(first, nodes);
#pragma GCC unroll 8
    for (int a = 0; a < nodes; ++a) {
      if constexpr (ring)
        corner[a].c[0] += force[a].c[0];
      subtract(view.force, node + a * batch_size, corner[a], count);
    }
  }
};

} // namespace kerf::KERF_ISA
