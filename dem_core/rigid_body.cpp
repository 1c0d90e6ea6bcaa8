#include "dem_core/rigid_body.hpp"

#include <Eigen/LU>

#include <cmath>

namespace kerf::dem {

namespace {

Eigen::Matrix3d cross_matrix(const Vec<3>& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
  return m;
}

/// m = pi + dt / 2 m x J^-1 m by Newton's method; a step turns by little, so it is near pi.
Vec<3> mean_momentum(const Eigen::Matrix3d& inverse_inertia, const Vec<3>& pi, double time) {
  constexpr int most_iterations = 20;
  Vec<3> m = pi;
  for (int k = 0; k < most_iterations; ++k) {
    const Vec<3> rate = inverse_inertia * m;
    const Vec<3> residual = m - pi - 0.5 * time * m.cross(rate);
    const Eigen::Matrix3d slope =
        Eigen::Matrix3d::Identity() -
        0.5 * time * (cross_matrix(m) * inverse_inertia - cross_matrix(rate));
    const Vec<3> change = slope.inverse() * residual;
    m -= change;
    if (!(change.norm() > 1e-16 * pi.norm()))
      break;
  }
  return m;
}

} // namespace

template <>
FreeTurn<2> free_turn<2>(const Inertia<2>& inertia, const Orientation<2>&, const Rot<2>& momentum,
                         double time) {
  const Rot<2> rate = momentum / inertia(0, 0);
  return {Orientation<2>::about(Rot<2>(1.0), rate[0] * time), rate};
}

template <>
FreeTurn<3> free_turn<3>(const Inertia<3>& inertia, const Orientation<3>& orientation,
                         const Rot<3>& momentum, double time) {
  const Eigen::Matrix3d inverse = inertia.inverse();
  const Vec<3> mean = mean_momentum(inverse, orientation.turned_back(momentum), time);
  const Vec<3> tangent = orientation.turned(0.5 * time * (inverse * mean)); // of half of the angle
  const double length = tangent.norm();
  const double shrink = length > 1e-8 ? std::atan(length) / length : 1.0;
  return {Orientation<3>::of_gibbs(tangent), 2.0 * shrink / time * tangent};
}

} // namespace kerf::dem
