#include "dem_core/tool_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace kerf::dem {

namespace {

/// Part of the missing force that a step of the servo makes up for; above 1 it would swing.
constexpr double servo_share = 0.5;

void must_be_positive(double value, std::string_view what) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw std::invalid_argument(fmt::format("{} must be positive, not {}", what, value));
}

void must_be_finite(bool is_finite, std::string_view what) {
  if (!is_finite)
    throw std::invalid_argument(fmt::format("{} must be finite", what));
}

template <class Vector> Vector unit(const Vector& vector, std::string_view what) {
  must_be_positive(vector.norm(), fmt::format("the length of {}", what));
  return vector.normalized();
}

/// The motion with unit vectors, when it can be.
template <int dim> ToolMotion<dim> checked(ToolMotion<dim> motion) {
  must_be_finite(motion.reference.allFinite(), "the reference point of a tool");
  motion.axis = unit(motion.axis, "the axis of a tool");
  if (motion.servo) {
    motion.servo->direction = unit(motion.servo->direction, "the direction of a servo");
    must_be_positive(motion.servo->max_velocity, "the largest velocity of a servo");
  }
  if (const auto& free = motion.free_translation) {
    must_be_positive(free->mass, "the mass of a free tool");
    must_be_finite(free->force.allFinite(), "the force on a free tool");
    if (std::ranges::none_of(free->axes, [](bool is_free) { return is_free; }))
      throw std::invalid_argument("a free tool needs an axis along which it is free");
    for (int a = 0; a < dim; ++a)
      if (motion.servo && free->axes[a] && motion.servo->direction[a] != 0.0)
        throw std::invalid_argument(
            fmt::format("a tool with a servo along {} cannot be free along it", "xyz"[a]));
  }
  if (const auto& free = motion.free_rotation) {
    must_be_positive(free->inertia, "the moment of inertia of a free tool");
    must_be_finite(std::isfinite(free->moment), "the moment on a free tool");
  }
  return motion;
}

/// Velocity of the servo in the next step, m/s.
template <int dim>
double servo_velocity(const Servo<dim>& servo, double t, double time_step,
                      const ToolLoad<dim>& load) {
  const double missing = servo.force.value(t) + load.force.dot(servo.direction); // N
  if (missing == 0.0)
    return 0.0;
  if (!(load.stiffness > 0.0))
    return std::copysign(servo.max_velocity, missing);
  return std::clamp(servo_share * missing / (load.stiffness * time_step), -servo.max_velocity,
                    servo.max_velocity);
}

} // namespace

template <int dim>
ToolMover<dim>::ToolMover(const ToolMotion<dim>& motion)
    : motion_(checked(motion)), translation_before_(Vec<dim>::Zero()),
      free_translation_(Vec<dim>::Zero()), free_velocity_(initial_velocity().translation),
      free_rate_(motion_.rotation_rate.value(0.0)) {}

template <int dim> Vec<dim> ToolMover<dim>::translation(double t) const {
  Vec<dim> u;
  for (int a = 0; a < dim; ++a)
    u[a] = motion_.velocity[a].integral(t - begin_);
  if (const auto& free = motion_.free_translation)
    for (int a = 0; a < dim; ++a)
      if (free->axes[a])
        u[a] = free_translation_[a];
  if (const auto& servo = motion_.servo)
    u += (servo_way_ - u.dot(servo->direction)) * servo->direction;
  return translation_before_ + u;
}

template <int dim> double ToolMover<dim>::angle(double t) const {
  return angle_before_ +
         (motion_.free_rotation ? free_angle_ : motion_.rotation_rate.integral(t - begin_));
}

template <int dim>
void ToolMover<dim>::redirect(const ToolMotion<dim>& motion, double t,
                              const RigidVelocity<dim>& velocity) {
  const ToolMotion<dim> next = checked(motion);
  const Vec<dim> way = translation(t);
  const double turned = angle(t);
  if (turned != 0.0 && next.axis.dot(motion_.axis) < 1.0 - 1e-12)
    throw std::invalid_argument("a tool that has turned keeps its axis");
  motion_ = next;
  begin_ = t;
  translation_before_ = way;
  angle_before_ = turned;
  servo_way_ = free_angle_ = 0.0;
  free_translation_.setZero();
  free_velocity_ = velocity.translation;
  free_rate_ = velocity.rotation.dot(motion_.axis);
}

template <int dim> RigidVelocity<dim> ToolMover<dim>::initial_velocity() const {
  RigidVelocity<dim> v;
  for (int a = 0; a < dim; ++a)
    v.translation[a] = motion_.velocity[a].value(0.0);
  if (const auto& servo = motion_.servo) // it starts from rest
    v.translation -= v.translation.dot(servo->direction) * servo->direction;
  v.rotation = motion_.rotation_rate.value(0.0) * motion_.axis;
  return v;
}

template <int dim>
RigidVelocity<dim> ToolMover<dim>::advance(std::uint64_t step, double time_step,
                                           const ToolLoad<dim>& load) {
  const double now = static_cast<double>(step) * time_step - begin_;
  const double then = static_cast<double>(step + 1) * time_step - begin_;
  const double kick = step == 0 ? 0.5 * time_step : time_step; // from v^0, or from v^(n-1/2)

  RigidVelocity<dim> v;
  for (int a = 0; a < dim; ++a)
    v.translation[a] = motion_.velocity[a].mean(now, then);
  if (const auto& free = motion_.free_translation) {
    free_velocity_ += (kick / free->mass) * (load.force + free->force);
    free_translation_ += time_step * free_velocity_;
    for (int a = 0; a < dim; ++a)
      if (free->axes[a])
        v.translation[a] = free_velocity_[a];
  }
  if (const auto& servo = motion_.servo) {
    const double along = servo_velocity(*servo, now, time_step, load);
    servo_way_ += along * time_step;
    v.translation += (along - v.translation.dot(servo->direction)) * servo->direction;
  }

  double rate = motion_.rotation_rate.mean(now, then);
  if (const auto& free = motion_.free_rotation) {
    free_rate_ += kick / free->inertia * (load.moment.dot(motion_.axis) + free->moment);
    free_angle_ += free_rate_ * time_step;
    rate = free_rate_;
  }
  v.rotation = rate * motion_.axis;
  return v;
}

template class ToolMover<2>;
template class ToolMover<3>;

} // namespace kerf::dem
