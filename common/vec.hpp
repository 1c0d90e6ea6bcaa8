// Small vectors of the space that a case lives in, and the rotations that go with them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

namespace kerf {

/// A point, displacement, velocity or force in 2D or 3D.
template <int dim> using Vec = Eigen::Matrix<double, dim, 1>;

/// Independent rotations: one about the out-of-plane axis in 2D, three in 3D.
template <int dim> inline constexpr int rotations = dim == 2 ? 1 : 3;

/// An angular velocity, angular displacement or moment; a single number in 2D.
template <int dim> using Rot = Eigen::Matrix<double, rotations<dim>, 1>;

/// Velocity omega x r of a point at r on a body that turns with omega, m/s.
template <int dim> inline Vec<dim> spin(const Rot<dim>& omega, const Vec<dim>& r) {
  if constexpr (dim == 2)
    return {-omega[0] * r[1], omega[0] * r[0]};
  else
    return omega.cross(r);
}

/// Moment r x f of a force that acts at r, N m.
template <int dim> inline Rot<dim> moment(const Vec<dim>& r, const Vec<dim>& f) {
  if constexpr (dim == 2)
    return Rot<2>(r[0] * f[1] - r[1] * f[0]);
  else
    return r.cross(f);
}

/// A part of space; its edges belong to it.
template <int dim> struct Box {
  Vec<dim> lower, upper; // m

  /// True inside and up to 1e-9 of the longest edge outside.
  bool contains(const Vec<dim>& point) const {
    const double slack = 1e-9 * (upper - lower).maxCoeff();
    return ((point - lower).array() >= -slack).all() && ((upper - point).array() >= -slack).all();
  }
};

/// Box that repeats itself along some axes; a length of zero means that the axis does not repeat.
template <int dim> struct Period {
  Vec<dim> length = Vec<dim>::Zero(); // m

  /// The shortest of all images of a difference of positions.
  Vec<dim> shortest(Vec<dim> difference) const {
    for (int a = 0; a < dim; ++a)
      if (length[a] > 0.0)
        difference[a] -= length[a] * std::round(difference[a] / length[a]);
    return difference;
  }
};

} // namespace kerf
