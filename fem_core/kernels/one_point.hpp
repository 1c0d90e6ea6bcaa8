// The one-point element: the mean of the gradient over the element, and forces against the
// hourglass modes that it does not see; D. P. Flanagan and T. Belytschko,
// doi:10.1002/nme.1620170504.
//
// In the modes of shapes.hpp the volume is a short polynomial of the modes of the corners, and its
// derivative with respect to them is the mean gradient.
#pragma once

#include "fem_core/kernels/response.hpp"

namespace kerf::KERF_ISA {

template <Shape shape> struct ModesOf;
template <> struct ModesOf<Shape::quad4> {
  static constexpr int linear = 2, hourglass = 1, first_hourglass = 2, all = 3;
};
template <> struct ModesOf<Shape::hex8> {
  static constexpr int linear = 6, hourglass = 4, first_hourglass = 3, all = 7;
};

/// Modes of a vector field, [mode][component]: xi, eta, (zeta,) then those of the hourglass.
template <Shape shape> struct FieldModes {
  static constexpr int dim = ShapeOf<shape>::dim, nodes = ShapeOf<shape>::nodes;
  Lanes m[ModesOf<shape>::all][dim];

  KERF_INLINE void set(const Columns<dim> (&corner)[nodes]) {
    for (int i = 0; i < dim; ++i) {
      Lanes w[nodes];
      for (int a = 0; a < nodes; ++a)
        w[a] = corner[a].c[i];
      if constexpr (shape == Shape::quad4) {
        const QuadModes q = QuadModes::of(w);
        m[0][i] = q.xi;
        m[1][i] = q.eta;
        m[2][i] = q.xi_eta;
      } else {
        const HexModes h = HexModes::of(w);
        const Lanes mode[7] = {h.xi, h.eta, h.zeta, h.xi_eta, h.eta_zeta, h.zeta_xi, h.xi_eta_zeta};
        for (int k = 0; k < 7; ++k)
          m[k][i] = mode[k];
      }
    }
  }
  KERF_INLINE void corner_forces(Columns<dim> (&corner)[nodes]) const {
    for (int i = 0; i < dim; ++i) {
      Lanes w[nodes];
      if constexpr (shape == Shape::quad4)
        QuadModes{m[0][i], m[1][i], m[2][i]}.corners(w);
      else
        HexModes{m[0][i], m[1][i], m[2][i], m[3][i], m[4][i], m[5][i], m[6][i]}.corners(w);
      for (int a = 0; a < nodes; ++a)
        corner[a].c[i] = w[a];
    }
  }
};

KERF_INLINE void add_cross(Lanes (&sum)[3], double factor, const Lanes (&a)[3],
                           const Lanes (&b)[3]) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sum[i] += factor * (a[j] * b[k] - a[k] * b[j]);
  }
}

/// Volume and mean gradient: a field with the modes u has the mean gradient
/// sum_m u[m] (x) b[m] / volume.
template <Shape shape> struct MeanGradient {
  static constexpr int dim = ShapeOf<shape>::dim, linear = ModesOf<shape>::linear;
  Lanes b[linear][dim]{};
  Lanes volume;

  KERF_INLINE explicit MeanGradient(const FieldModes<shape>& x) {
    const auto& m = x.m;
    if constexpr (shape == Shape::quad4) {
      b[0][0] = 0.25 * m[1][1];
      b[0][1] = -0.25 * m[1][0];
      b[1][0] = -0.25 * m[0][1];
      b[1][1] = 0.25 * m[0][0];
      volume = m[0][0] * b[0][0] + m[0][1] * b[0][1];
    } else {
      constexpr double whole = 1.0 / 64.0, third = whole / 3.0;
      enum { x1, x2, x3, x12, x23, x31 };
      add_cross(b[x1], whole, m[x2], m[x3]);
      add_cross(b[x1], third, m[x12], m[x31]);
      add_cross(b[x2], whole, m[x3], m[x1]);
      add_cross(b[x2], third, m[x23], m[x12]);
      add_cross(b[x3], whole, m[x1], m[x2]);
      add_cross(b[x3], third, m[x31], m[x23]);
      add_cross(b[x12], third, m[x31], m[x1]);
      add_cross(b[x12], third, m[x2], m[x23]);
      add_cross(b[x23], third, m[x12], m[x2]);
      add_cross(b[x23], third, m[x3], m[x31]);
      add_cross(b[x31], third, m[x1], m[x12]);
      add_cross(b[x31], third, m[x23], m[x3]);
      volume = Lanes{}; // homogeneous of degree three: a third of sum_m x[m] . b[m]
      for (int k = 0; k < linear; ++k)
        for (int i = 0; i < 3; ++i)
          volume += m[k][i] * b[k][i];
      volume *= 1.0 / 3.0;
    }
  }

  KERF_INLINE Matrix<dim> of(const FieldModes<shape>& u) const { // times volume
    Matrix<dim> g;
    for (int i = 0; i < dim; ++i)
      for (int c = 0; c < dim; ++c) {
        Lanes sum = u.m[0][i] * b[0][c];
        for (int k = 1; k < linear; ++k)
          sum += u.m[k][i] * b[k][c];
        g.m[i][c] = sum;
      }
    return g;
  }
  KERF_INLINE Lanes squared_norm() const {
    Lanes sum{};
    for (const auto& mode : b)
      for (const Lanes& value : mode)
        sum += value * value;
    return sum;
  }
};

/// What is left of the hourglass modes of a field when its mean gradient is taken off.
template <Shape shape>
KERF_INLINE void hourglass_part(const FieldModes<shape>& field,
                                const Matrix<shape == Shape::quad4 ? 2 : 3>& gradient,
                                const FieldModes<shape>& x,
                                Lanes (&q)[ModesOf<shape>::hourglass][ShapeOf<shape>::dim]) {
  for (int k = 0; k < ModesOf<shape>::hourglass; ++k) {
    const int mode = ModesOf<shape>::first_hourglass + k;
    for (int i = 0; i < ShapeOf<shape>::dim; ++i) {
      q[k][i] = field.m[mode][i];
      for (int c = 0; c < ShapeOf<shape>::dim; ++c)
        q[k][i] -= gradient.m[i][c] * x.m[mode][c];
    }
  }
}

/// 1 / (nodes sqrt(3 dim))
template <int dim>
inline constexpr double viscous_share = dim == 2 ? 0.10206207261596575409 : 1.0 / 24.0;

template <int dim> KERF_INLINE void turn_vector(Lanes (&v)[dim], const Matrix<dim>& rotation) {
  Lanes turned[dim];
  for (int i = 0; i < dim; ++i) {
    turned[i] = rotation.m[i][0] * v[0];
    for (int c = 1; c < dim; ++c)
      turned[i] += rotation.m[i][c] * v[c];
  }
  for (int i = 0; i < dim; ++i)
    v[i] = turned[i];
}

template <int dim> KERF_INLINE Matrix<dim> times(const Lanes& factor, const Matrix<dim>& a) {
  Matrix<dim> result;
  for (int i = 0; i < dim; ++i)
    for (int c = 0; c < dim; ++c)
      result.m[i][c] = factor * a.m[i][c];
  return result;
}

/// What a response asks of the elements.
template <Shape shape> struct OnePoint {
  const PatchView& view;
  std::size_t first;
  int count;

  KERF_INLINE std::size_t at(int, int size = 1) const { return place(first, size); }
};

template <Shape shape, Kinematics kinematics, class Response>
void one_point_kernel(PatchView& patch) {
  constexpr int dim = ShapeOf<shape>::dim, nodes = ShapeOf<shape>::nodes;
  constexpr int hourglass = ModesOf<shape>::hourglass, first_mode = ModesOf<shape>::first_hourglass;
  PatchView view = patch;
  WorkLanes work;
  for_vectors(
      view, [&](std::size_t first, int count) __attribute__((always_inline)) {
        OnePoint<shape> e{view, first, count};
        const std::uint16_t* node = view.nodes + place(first, nodes);
        Columns<dim> corner[nodes];
        FieldModes<shape> x, u;
        for (int a = 0; a < nodes; ++a)
          corner[a] = gather<dim>(view.motion, node + a * batch_size);
        u.set(corner);
        for (int a = 0; a < nodes; ++a)
          corner[a] = gather<dim>(view.reference, node + a * batch_size);
        x.set(corner);

        // Deformation.
        const MeanGradient<shape> acting(x); // on which the force acts; total: the reference
        Deformation<dim> d;
        PointForce<dim> f;
        const Lanes share = view.alpha == nullptr ? broadcast(1.0) : load(view.alpha + e.at(0));
        FieldModes<shape> straining = x;
        if constexpr (kinematics == Kinematics::rate)
          for (int k = 0; k < ModesOf<shape>::all; ++k)
            for (int i = 0; i < dim; ++i)
              straining.m[k][i] -= 0.5 * view.motion_scale * u.m[k][i];
        const MeanGradient<shape> middle(straining);
        const Lanes inverse_volume = inverse(middle.volume);
        d.gradient = middle.of(u);
        d.factor = view.motion_scale * inverse_volume;
        d.strain = symmetric(d.gradient, d.factor);
        d.own_trace = trace(d.strain);
        if constexpr (kinematics == Kinematics::rate) { // Kirchhoff stress in the reference volume
          f.volume = load(view.volume + e.at(0));
          f.weight = f.volume * inverse(acting.volume);
        } else {
          f.volume = share * middle.volume;
          f.weight = share;
        }
        f.end = share * acting.volume;

        // Stress, as the tensor S of force[mode] = S . b[mode].
        Tensor<dim> stress = Response::stress(e, 0, d, f, work);
        Matrix<dim> S;
        for (int i = 0; i < dim; ++i)
          for (int c = 0; c < dim; ++c)
            S.m[i][c] = f.weight * stress[component_of<dim>(i, c)];
        if constexpr (kinematics == Kinematics::total) { // tau . F^-T
          Matrix<dim> F = times<dim>(d.factor, d.gradient);
          for (int i = 0; i < dim; ++i)
            F.m[i][i] += 1.0;
          const Jacobian<dim> inverse_F(F);
          S = times<dim>(inverse(inverse_F.det), product(S, inverse_F.cof));
        }

        // Hourglass control.
        Lanes q[hourglass][dim], Q[hourglass][dim];
        hourglass_part<shape>(u, times<dim>(inverse_volume, d.gradient), straining, q);
        const Lanes norm = acting.squared_norm();
        const Lanes stiffness =
            share * view.constants.hourglass / (3.0 * dim) * norm * inverse(acting.volume);
        Lanes energy{}, viscous{};
        if (view.hourglass != nullptr) { // of increments
          double* const stored = view.hourglass + place(first, hourglass * dim);
          Matrix<dim> half_turn;
          if constexpr (kinematics == Kinematics::rate)
            half_turn = half_turn_of<dim>(d.gradient, d.factor);
          // -zeta rho c_P |b| / (n sqrt(3 d)) q', which is critical of full stiffness at zeta = 2.
          Lanes viscosity{};
          if (view.time_step != 0.0)
            viscosity =
                share * view.constants.hourglass_viscosity * viscous_share<dim> * square_root(norm);
          for (int k = 0; k < hourglass; ++k) {
            Lanes before[dim], after[dim];
            for (int i = 0; i < dim; ++i)
              before[i] = load(stored + (k * dim + i) * batch_size);
            if constexpr (kinematics == Kinematics::rate)
              turn_vector<dim>(before, half_turn);
            for (int i = 0; i < dim; ++i) {
              const Lanes step = view.motion_scale * q[k][i];
              after[i] = before[i] + stiffness * step;
              energy += 0.5 * (before[i] + after[i]) * step;
            }
            if constexpr (kinematics == Kinematics::rate)
              turn_vector<dim>(after, half_turn);
            for (int i = 0; i < dim; ++i) {
              store(stored + (k * dim + i) * batch_size, after[i]);
              const Lanes resisting = viscosity * q[k][i]; // N; the motion is a velocity here
              viscous += resisting * view.motion_scale * q[k][i];
              Q[k][i] = after[i] + resisting;
            }
          }
        } else {
          for (int k = 0; k < hourglass; ++k)
            for (int i = 0; i < dim; ++i) {
              Q[k][i] = stiffness * view.motion_scale * q[k][i];
              if (view.wants_energy)
                energy += 0.5 * view.motion_scale * Q[k][i] * q[k][i];
            }
        }
        work.hourglass += only(energy, count);
        work.viscous += only(viscous, count);

        // Forces.
        const Lanes inverse_acting = inverse(acting.volume);
        for (int k = 0; k < hourglass; ++k)
          for (int i = 0; i < dim; ++i)
            for (int c = 0; c < dim; ++c)
              S.m[i][c] -= inverse_acting * Q[k][i] * x.m[first_mode + k][c];
        FieldModes<shape> force;
        for (int k = 0; k < ModesOf<shape>::all; ++k)
          for (int i = 0; i < dim; ++i) {
            Lanes sum{};
            if (k < ModesOf<shape>::linear)
              for (int c = 0; c < dim; ++c)
                sum += S.m[i][c] * acting.b[k < ModesOf<shape>::linear ? k : 0][c];
            if (k >= first_mode)
              sum += Q[k >= first_mode ? k - first_mode : 0][i];
            force.m[k][i] = sum;
          }
        force.corner_forces(corner);
        for (int a = 0; a < nodes; ++a)
          subtract(view.force, node + a * batch_size, corner[a], count);
      });
  book(work, patch);
}

} // namespace kerf::KERF_ISA
