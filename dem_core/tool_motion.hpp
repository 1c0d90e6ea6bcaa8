// How a rigid tool moves: prescribed, by a controlled force, or freely under its loads.
#pragma once

#include "common/vec.hpp"
#include "common/time_table.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace kerf::dem {

/// Moves the tool along a direction so that it pushes with a wanted force. In every step
///
///     v = 0.5 (wanted - pushed) / (k dt),    |v| <= max_velocity,
///
/// where k is the sum of the normal stiffness of all contacts of the tool: were they springs along
/// the direction, half of what is missing would be there after the step. Without a contact the tool
/// comes with max_velocity.
/// @see Itasca, PFC documentation, "wall servo"
template <int dim> struct Servo {
  Vec<dim> direction = Vec<dim>::Zero(); // the way in which the tool pushes, of any length
  TimeTable force;                       // wanted, N
  double max_velocity = 0.0;             // m/s
};

/// Along these axes the tool moves as its loads make it.
template <int dim> struct FreeTranslation {
  std::array<bool, dim> axes{};
  double mass = 0.0;                 // kg
  Vec<dim> force = Vec<dim>::Zero(); // from outside, gravity too, N
};

/// The tool turns about its axis as its loads make it: a wheel on a bearing.
struct FreeRotation {
  double inertia = 0.0; // about the axis, kg m²
  double moment = 0.0;  // from outside, about the axis, N m
};

/// The motion of a reference point of the tool, and the rotation about an axis through this point.
/// The axis goes with the point and keeps its direction.
template <int dim> struct ToolMotion {
  Vec<dim> reference = Vec<dim>::Zero(); // the point at the start, m
  std::array<TimeTable, dim> velocity;   // along each axis, m/s; a free one begins with it
  std::optional<Servo<dim>> servo;       // instead of the velocity along its direction
  std::optional<FreeTranslation<dim>> free_translation;
  Rot<dim> axis = Rot<dim>::UnitX(); // of any length; in 2D out of the plane
  TimeTable rotation_rate;           // about the axis, rad/s; a free one begins with it
  std::optional<FreeRotation> free_rotation;
};

/// Velocity of a rigid body: of its reference point, m/s, and about it, rad/s.
template <int dim> struct RigidVelocity {
  Vec<dim> translation = Vec<dim>::Zero();
  Rot<dim> rotation = Rot<dim>::Zero();
};

/// What acts on a tool, about its reference point.
template <int dim> struct ToolLoad {
  Vec<dim> force = Vec<dim>::Zero();  // N
  Rot<dim> moment = Rot<dim>::Zero(); // N m
  double stiffness = 0.0;             // sum of k_n of all contacts, N/m

  ToolLoad& operator+=(const ToolLoad& other) {
    force += other.force;
    moment += other.moment;
    stiffness += other.stiffness;
    return *this;
  }

  double power(const RigidVelocity<dim>& v) const { // W
    return force.dot(v.translation) + moment.dot(v.rotation);
  }
};

/// Carries the reference point and the angle from step to step by central differences. What is
/// prescribed comes from t_n = n dt and does not drift.
template <int dim> class ToolMover {
public:
  /// @throws std::invalid_argument for a number that is not finite, a direction or an axis of no
  ///         length, a bound, a mass or an inertia that is not positive, a free body without a free
  ///         axis, or a servo along a free axis
  explicit ToolMover(const ToolMotion<dim>& motion);

  Vec<dim> translation(double t) const; // of the reference point since the start, m; t is t_n
  double angle(double t) const;         // since the start, rad; t is t_n
  /// Goes on with another motion from where the point is at t_n, which its tables count from. What
  /// becomes or stays free keeps the velocity, given as v^(n-1/2).
  /// @throws std::invalid_argument as the constructor; also for another axis of what has turned
  void redirect(const ToolMotion<dim>& motion, double t, const RigidVelocity<dim>& velocity);

  Rot<dim> axis() const { return motion_.axis; }

  double inverse_mass() const noexcept { // along free axes, 1/kg; 0 without one
    return motion_.free_translation ? 1.0 / motion_.free_translation->mass : 0.0;
  }
  double inverse_inertia() const noexcept { // about the axis, 1/(kg m²); 0 unless it turns freely
    return motion_.free_rotation ? 1.0 / motion_.free_rotation->inertia : 0.0;
  }

  RigidVelocity<dim> initial_velocity() const; // v^0
  /// Velocity of the step that begins at t_n, v^(n+1/2), after which the state is that of t_(n+1).
  RigidVelocity<dim> advance(std::uint64_t step, double time_step, const ToolLoad<dim>& load);

private:
  friend struct StateParts;

  ToolMotion<dim> motion_;      // direction and axis are unit vectors
  double begin_ = 0.0;          // of this motion, s
  Vec<dim> translation_before_; // made by motions before it, m
  double angle_before_ = 0.0;   // rad
  double servo_way_ = 0.0;      // along its direction, m
  Vec<dim> free_translation_;   // along free axes, m
  Vec<dim> free_velocity_;      // v^(n-1/2) along free axes, m/s
  double free_angle_ = 0.0;     // rad
  double free_rate_ = 0.0;      // omega^(n-1/2), rad/s
};

} // namespace kerf::dem
