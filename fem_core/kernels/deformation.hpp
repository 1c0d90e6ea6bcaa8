// Small matrices of lanes: Jacobians, gradients and the turn of a stress.
#pragma once

#include "fem_core/kernels/shapes.hpp"
#include "fem_core/laws/symmetric.hpp"

namespace kerf::KERF_ISA {

using fem::Symmetric;

template <int dim> struct Matrix { Lanes m[dim][dim]; };
template <int dim> using Tensor = Symmetric<Lanes, dim>;

/// J = dx/dxi at a point, without the factor of the modes, and its cofactors; J^-1 = cof^T / det.
template <int dim> struct Jacobian {
  Matrix<dim> cof;
  Lanes det;

  KERF_INLINE explicit Jacobian(const Matrix<dim>& j) {
    const auto& m = j.m;
    if constexpr (dim == 2) {
      cof = {{{m[1][1], -m[1][0]}, {-m[0][1], m[0][0]}}};
      det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    } else {
      for (int i = 0; i < 3; ++i) {
        const auto& p = m[(i + 1) % 3];
        const auto& q = m[(i + 2) % 3];
        for (int d = 0; d < 3; ++d)
          cof.m[i][d] = p[(d + 1) % 3] * q[(d + 2) % 3] - p[(d + 2) % 3] * q[(d + 1) % 3];
      }
      det = m[0][0] * cof.m[0][0] + m[0][1] * cof.m[0][1] + m[0][2] * cof.m[0][2];
    }
  }
  /// Gradient [component][axis of space] of a field with these derivatives, times det.
  KERF_INLINE Matrix<dim> gradient_times_det(const Matrix<dim>& derivatives) const {
    Matrix<dim> g;
    for (int i = 0; i < dim; ++i)
      for (int c = 0; c < dim; ++c) {
        Lanes sum = derivatives.m[i][0] * cof.m[c][0];
        for (int d = 1; d < dim; ++d)
          sum += derivatives.m[i][d] * cof.m[c][d];
        g.m[i][c] = sum;
      }
    return g;
  }
};

template <Shape shape>
KERF_INLINE Matrix<ShapeOf<shape>::dim> at_point(const Derivatives<shape>& of, int q) {
  Matrix<ShapeOf<shape>::dim> m;
  for (int i = 0; i < ShapeOf<shape>::dim; ++i)
    for (int d = 0; d < ShapeOf<shape>::dim; ++d)
      m.m[i][d] = of.at(q, i, d);
  return m;
}

template <int dim>
KERF_INLINE Matrix<dim> sum(const Matrix<dim>& a, double factor, const Matrix<dim>& b) {
  Matrix<dim> result;
  for (int i = 0; i < dim; ++i)
    for (int d = 0; d < dim; ++d)
      result.m[i][d] = a.m[i][d] + factor * b.m[i][d];
  return result;
}

/// Symmetric part of factor * g; zz of 2D is zero.
template <int dim> KERF_INLINE Tensor<dim> symmetric(const Matrix<dim>& g, const Lanes& factor) {
  const Lanes half = 0.5 * factor;
  if constexpr (dim == 2)
    return {factor * g.m[0][0], factor * g.m[1][1], Lanes{}, half * (g.m[0][1] + g.m[1][0])};
  else
    return {factor * g.m[0][0],
            factor * g.m[1][1],
            factor * g.m[2][2],
            half * (g.m[1][2] + g.m[2][1]),
            half * (g.m[0][2] + g.m[2][0]),
            half * (g.m[0][1] + g.m[1][0])};
}

/// Rows of a symmetric tensor in the plane or the space of the elements.
template <int dim> constexpr int component_of(int i, int j) {
  if constexpr (dim == 2)
    return i == j ? i : 3;
  else
    return i == j ? i : 6 - i - j;
}

/// Adds factor * stress . cof to the derivatives at a point.
template <Shape shape, int dim>
KERF_INLINE void add_force(Derivatives<shape>& force, int q, const Tensor<dim>& stress,
                           const Matrix<dim>& cof, const Lanes& factor) {
  for (int i = 0; i < dim; ++i) {
    Lanes s[dim];
    for (int c = 0; c < dim; ++c)
      s[c] = factor * stress[component_of<dim>(i, c)];
    for (int d = 0; d < dim; ++d) {
      Lanes total = s[0] * cof.m[0][d];
      for (int c = 1; c < dim; ++c)
        total += s[c] * cof.m[c][d];
      force.add(q, i, d, total);
    }
  }
}

template <int dim> KERF_INLINE Matrix<dim> product(const Matrix<dim>& a, const Matrix<dim>& b) {
  Matrix<dim> result;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      Lanes sum = a.m[i][0] * b.m[0][j];
      for (int k = 1; k < dim; ++k)
        sum += a.m[i][k] * b.m[k][j];
      result.m[i][j] = sum;
    }
  return result;
}

/// The root of the rotation R = (1 - W/2)^-1 (1 + W/2) that an increment of spin makes, which is
/// one whatever its size; T. J. R. Hughes and J. Winget, doi:10.1002/nme.1620151210. Turned by it
/// once before the strain of the increment counts and once after, a stress comes back when motion
/// does.
/// @param g  factor * g is the gradient of the displacement increment in the middle of the step
template <int dim> KERF_INLINE Matrix<dim> half_turn_of(const Matrix<dim>& g, const Lanes& factor) {
  // With a half the axial vector of W, R has the quaternion 1 + a, its root 1 + a / (1 + |1 + a|).
  const Lanes quarter = 0.25 * factor;
  const auto half = [](const Lanes& squared) { return inverse(1.0 + square_root(1.0 + squared)); };
  if constexpr (dim == 2) {
    Lanes a = quarter * (g.m[1][0] - g.m[0][1]);
    a *= half(a * a);
    const Lanes f = inverse(1.0 + a * a);
    const Lanes cosine = (1.0 - a * a) * f, sine = 2.0 * a * f;
    return {{{cosine, -sine}, {sine, cosine}}};
  } else {
    Lanes x = quarter * (g.m[2][1] - g.m[1][2]);
    Lanes y = quarter * (g.m[0][2] - g.m[2][0]);
    Lanes z = quarter * (g.m[1][0] - g.m[0][1]);
    const Lanes s = half(x * x + y * y + z * z);
    x *= s;
    y *= s;
    z *= s;
    const Lanes f = 2.0 * inverse(1.0 + x * x + y * y + z * z);
    return {{{1.0 - f * (y * y + z * z), f * (x * y - z), f * (x * z + y)},
             {f * (x * y + z), 1.0 - f * (x * x + z * z), f * (y * z - x)},
             {f * (x * z - y), f * (y * z + x), 1.0 - f * (x * x + y * y)}}};
  }
}

/// R . s . R^T; zz of 2D stays.
template <int dim> KERF_INLINE void turn(Tensor<dim>& s, const Matrix<dim>& rotation) {
  const auto& r = rotation.m;
  Lanes t[dim][dim]; // R s
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      t[i][j] = r[i][0] * s[component_of<dim>(0, j)];
      for (int k = 1; k < dim; ++k)
        t[i][j] += r[i][k] * s[component_of<dim>(k, j)];
    }
  for (int i = 0; i < dim; ++i)
    for (int j = i; j < dim; ++j) {
      Lanes sum = t[i][0] * r[j][0];
      for (int k = 1; k < dim; ++k)
        sum += t[i][k] * r[j][k];
      s[component_of<dim>(i, j)] = sum;
    }
}

} // namespace kerf::KERF_ISA
