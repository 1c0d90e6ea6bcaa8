// Derivatives of a field over the reference element at the Gauss points of each shape, and the
// transpose, which gives the forces at the corners.
//
// Quads and hexes go through their modes: sums of the corner values with the signs of 1, xi, eta,
// zeta, xi eta, … A derivative along an axis does not depend on the coordinate along that axis, so
// that the 2 x 2 (x 2) points have only 2 (4) different values of each.
#pragma once

#include "fem_core/kernels/rows.hpp"

namespace kerf::KERF_ISA {

using fem::Shape;

inline constexpr double gauss_point = 0.57735026918962576451; // 1 / sqrt(3)

/// Nodes, points and the constant part of the weights of a shape. The derivatives below come
/// without the factor of the modes, and this one makes up for it: a volume is scale * det, a corner
/// force scale * (…) of the transpose.
template <Shape shape> struct ShapeOf;
template <> struct ShapeOf<Shape::tri3> {
  static constexpr int dim = 2, nodes = 3, points = 1, samples = 1;
  static constexpr double scale = 0.5;
};
template <> struct ShapeOf<Shape::quad4> {
  static constexpr int dim = 2, nodes = 4, points = 4, samples = 2;
  static constexpr double scale = 1.0 / 16.0;
};
template <> struct ShapeOf<Shape::tet4> {
  static constexpr int dim = 3, nodes = 4, points = 1, samples = 1;
  static constexpr double scale = 1.0 / 6.0;
};
template <> struct ShapeOf<Shape::hex8> {
  static constexpr int dim = 3, nodes = 8, points = 8, samples = 4;
  static constexpr double scale = 1.0 / 512.0;
};

/// Of point q the sample that holds a derivative along an axis. Points count with xi fastest.
template <Shape shape> constexpr int sample(int q, int axis) {
  if constexpr (shape == Shape::quad4)
    return axis == 0 ? q >> 1 : q & 1;
  else if constexpr (shape == Shape::hex8)
    return axis == 0 ? q >> 1 : axis == 1 ? (q & 1) | ((q >> 1) & 2) : q & 3;
  else
    return 0;
}

/// Modes of one component of a quad: xi, eta, xi eta.
struct QuadModes {
  Lanes xi, eta, xi_eta;

  KERF_INLINE static QuadModes of(const Lanes (&w)[4]) {
    const Lanes d01 = w[1] - w[0], d32 = w[2] - w[3];
    const Lanes s01 = w[0] + w[1], s32 = w[3] + w[2];
    return {d01 + d32, s32 - s01, d32 - d01};
  }
  KERF_INLINE void corners(Lanes (&w)[4]) const {
    const Lanes d01 = xi - xi_eta, d32 = xi + xi_eta;
    w[0] = -eta - d01;
    w[1] = d01 - eta;
    w[2] = eta + d32;
    w[3] = eta - d32;
  }
};

/// Modes of one component of a hex.
struct HexModes {
  Lanes xi, eta, zeta, xi_eta, eta_zeta, zeta_xi, xi_eta_zeta;

  KERF_INLINE static HexModes of(const Lanes (&w)[8]) {
    const Lanes s01 = w[0] + w[1], d01 = w[1] - w[0], s32 = w[3] + w[2], d32 = w[2] - w[3];
    const Lanes s45 = w[4] + w[5], d45 = w[5] - w[4], s76 = w[7] + w[6], d76 = w[6] - w[7];
    const Lanes ds_0 = d01 + d32, dd_0 = d32 - d01, sd_0 = s32 - s01, ss_0 = s01 + s32;
    const Lanes ds_1 = d45 + d76, dd_1 = d76 - d45, sd_1 = s76 - s45, ss_1 = s45 + s76;
    return {ds_0 + ds_1, sd_0 + sd_1, ss_1 - ss_0, dd_0 + dd_1,
            sd_1 - sd_0, ds_1 - ds_0, dd_1 - dd_0};
  }
  KERF_INLINE void corners(Lanes (&w)[8]) const {
    const Lanes ds_0 = xi - zeta_xi, ds_1 = xi + zeta_xi;
    const Lanes sd_0 = eta - eta_zeta, sd_1 = eta + eta_zeta;
    const Lanes dd_0 = xi_eta - xi_eta_zeta, dd_1 = xi_eta + xi_eta_zeta;
    const Lanes s01 = -zeta - sd_0, s32 = sd_0 - zeta, d01 = ds_0 - dd_0, d32 = ds_0 + dd_0;
    const Lanes s45 = zeta - sd_1, s76 = zeta + sd_1, d45 = ds_1 - dd_1, d76 = ds_1 + dd_1;
    w[0] = s01 - d01;
    w[1] = s01 + d01;
    w[2] = s32 + d32;
    w[3] = s32 - d32;
    w[4] = s45 - d45;
    w[5] = s45 + d45;
    w[6] = s76 + d76;
    w[7] = s76 - d76;
  }
};

/// a + b x + c y + d x y at x, y = -+1, x fastest.
KERF_INLINE void at_signs(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& d,
                          Lanes (&value)[4]) {
  const Lanes minus = a - b, plus = a + b, d_minus = c - d, d_plus = c + d;
  value[0] = minus - d_minus;
  value[1] = plus - d_plus;
  value[2] = minus + d_minus;
  value[3] = plus + d_plus;
}

/// Derivatives of a vector field at the points: d[component][axis][sample].
template <Shape shape> struct Derivatives {
  static constexpr int dim = ShapeOf<shape>::dim, nodes = ShapeOf<shape>::nodes;
  Lanes d[dim][dim][ShapeOf<shape>::samples];

  KERF_INLINE const Lanes& at(int q, int component, int axis) const {
    return d[component][axis][sample<shape>(q, axis)];
  }

  KERF_INLINE void set(const Columns<dim> (&corner)[nodes]) {
    for (int i = 0; i < dim; ++i) {
      Lanes w[nodes];
      for (int a = 0; a < nodes; ++a)
        w[a] = corner[a].c[i];
      if constexpr (shape == Shape::quad4) {
        const QuadModes m = QuadModes::of(w);
        const Lanes bend = gauss_point * m.xi_eta;
        d[i][0][0] = m.xi - bend;
        d[i][0][1] = m.xi + bend;
        d[i][1][0] = m.eta - bend;
        d[i][1][1] = m.eta + bend;
      } else if constexpr (shape == Shape::hex8) {
        const HexModes m = HexModes::of(w);
        const Lanes xy = gauss_point * m.xi_eta, yz = gauss_point * m.eta_zeta,
                    zx = gauss_point * m.zeta_xi, xyz = (1.0 / 3.0) * m.xi_eta_zeta;
        at_signs(m.xi, xy, zx, xyz, d[i][0]);
        at_signs(m.eta, xy, yz, xyz, d[i][1]);
        at_signs(m.zeta, zx, yz, xyz, d[i][2]);
      } else {
        for (int k = 0; k < dim; ++k)
          d[i][k][0] = w[k + 1] - w[0];
      }
    }
  }

  KERF_INLINE void clear() {
    for (auto& component : d)
      for (auto& axis : component)
        for (Lanes& value : axis)
          value = Lanes{};
  }
  KERF_INLINE void add(int q, int component, int axis, const Lanes& value) {
    d[component][axis][sample<shape>(q, axis)] += value;
  }
  /// The transpose of set().
  KERF_INLINE void corner_forces(Columns<dim> (&corner)[nodes]) const {
    for (int i = 0; i < dim; ++i) {
      Lanes w[nodes];
      if constexpr (shape == Shape::quad4) {
        const QuadModes m = {d[i][0][0] + d[i][0][1], d[i][1][0] + d[i][1][1],
                             gauss_point * (d[i][0][1] - d[i][0][0] + d[i][1][1] - d[i][1][0])};
        m.corners(w);
      } else if constexpr (shape == Shape::hex8) {
        Lanes total[3], x[3], y[3], xy[3];
        for (int axis = 0; axis < 3; ++axis) {
          const auto& v = d[i][axis];
          const Lanes s0 = v[0] + v[1], d0 = v[1] - v[0], s1 = v[2] + v[3], d1 = v[3] - v[2];
          total[axis] = s0 + s1;
          x[axis] = d0 + d1;
          y[axis] = s1 - s0;
          xy[axis] = d1 - d0;
        }
        const HexModes m = {total[0],
                            total[1],
                            total[2],
                            gauss_point * (x[0] + x[1]),
                            gauss_point * (y[1] + y[2]),
                            gauss_point * (y[0] + x[2]),
                            (1.0 / 3.0) * (xy[0] + xy[1] + xy[2])};
        m.corners(w);
      } else {
        w[0] = -d[i][0][0];
        for (int k = 1; k < dim; ++k)
          w[0] -= d[i][k][0];
        for (int k = 0; k < dim; ++k)
          w[k + 1] = d[i][k][0];
      }
      for (int a = 0; a < nodes; ++a)
        corner[a].c[i] = w[a];
    }
  }
};

} // namespace kerf::KERF_ISA
