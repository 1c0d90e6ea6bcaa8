// How far a rigid body has turned, without loss of digits when it is little.
#pragma once

#include "common/vec.hpp"

#include <cmath>

namespace kerf::dem {

template <int dim> class Orientation;

template <> class Orientation<2> {
public:
  /// Turned by an angle about an axis out of the plane, of length one.
  static Orientation about(const Rot<2>& axis, double angle) {
    Orientation turned;
    turned.angle_ = axis[0] * angle;
    return turned;
  }

  Vec<2> turned(const Vec<2>& r) const { return r + moved(r); }
  Vec<2> turned_back(const Vec<2>& r) const { return about(Rot<2>(-1.0), angle_).turned(r); }
  /// Turned r less r.
  Vec<2> moved(const Vec<2>& r) const {
    const double sine = std::sin(0.5 * angle_), cosine = std::cos(0.5 * angle_);
    return spin<2>(Rot<2>(2.0 * sine * cosine), r) - (2.0 * sine * sine) * r;
  }
  /// This one, and then another one.
  Orientation then(const Orientation& next) const {
    return about(Rot<2>(1.0), angle_ + next.angle_);
  }

private:
  friend struct StateParts;

  double angle_ = 0.0; // rad
};

template <> class Orientation<3> {
public:
  static Orientation about(const Vec<3>& axis, double angle) {
    return {std::cos(0.5 * angle), std::sin(0.5 * angle) * axis};
  }
  /// Turned by an angle whose half has this tangent, along the axis.
  static Orientation of_gibbs(const Vec<3>& tangent) {
    const double cosine = 1.0 / std::sqrt(1.0 + tangent.squaredNorm());
    return {cosine, cosine * tangent};
  }
  Orientation() = default;

  Vec<3> turned(const Vec<3>& r) const { return r + moved(r); }
  Vec<3> turned_back(const Vec<3>& r) const { return Orientation(cosine_, -axis_).turned(r); }
  Vec<3> moved(const Vec<3>& r) const {
    const Vec<3> t = 2.0 * axis_.cross(r);
    return cosine_ * t + axis_.cross(t);
  }
  Orientation then(const Orientation& next) const {
    Orientation both(next.cosine_ * cosine_ - next.axis_.dot(axis_),
                     next.cosine_ * axis_ + cosine_ * next.axis_ + next.axis_.cross(axis_));
    const double length = std::hypot(both.cosine_, both.axis_.norm());
    both.cosine_ /= length;
    both.axis_ /= length;
    return both;
  }

private:
  friend struct StateParts;

  Orientation(double cosine, const Vec<3>& axis) : cosine_(cosine), axis_(axis) {}

  // A quaternion of length one: of half of the angle.
  double cosine_ = 1.0;
  Vec<3> axis_ = Vec<3>::Zero(); // times the sine
};

} // namespace kerf::dem
