// A rigid tool or wall: its shape, where it is, what it feels and what work it does.
#pragma once

#include "dem_core/tool_motion.hpp"
#include "dem_core/tool_shape.hpp"

#include <cstdint>

namespace kerf::dem {

/// Where a body is: its reference point and how far it has turned since the start.
template <int dim> struct Pose {
  Vec<dim> start;                           // reference point at the start, m
  Vec<dim> reference;                       // the same now, m
  Eigen::Matrix<double, dim, dim> rotation; // of directions since the start

  Vec<dim> to_body(const Vec<dim>& x) const {
    return start + rotation.transpose() * (x - reference);
  }
  Vec<dim> to_space(const Vec<dim>& body) const { return reference + rotation * (body - start); }
};

/// A step of the engine is
///
///     tool.begin_step(step, dt);            // pose of t_n, no loads
///     tool.add_load(force, point, k_n);     // every contact, always in the same order
///     tool.end_step();                      // v^(n+1/2), work
template <int dim> class Tool {
public:
  /// @throws std::invalid_argument when the motion cannot be, see ToolMover
  Tool(ToolShape<dim> shape, const ToolMotion<dim>& motion);

  /// Goes on with another motion, see ToolMover::redirect(); between two steps.
  void redirect(const ToolMotion<dim>& motion, double t) { mover_.redirect(motion, t, velocity_); }
  Rot<dim> axis() const { return mover_.axis(); }

  const ToolShape<dim>& shape() const noexcept { return shape_; }

  /// @param step       0 first, then one more each time
  /// @param time_step  s, the same in all steps
  void begin_step(std::uint64_t step, double time_step);

  const Pose<dim>& pose() const noexcept { return pose_; } // of t_n
  /// Of t_(n-1); that of t_0 in the first step.
  const Pose<dim>& pose_before() const noexcept { return pose_before_; }
  double angle() const noexcept { return angle_; } // made about the axis since the start, rad
  /// With which the tool has come to t_n, v^(n-1/2); v^0 in the first step.
  const RigidVelocity<dim>& velocity() const noexcept { return velocity_; }
  /// The same of the point of the tool that is at x, m/s.
  Vec<dim> velocity_at(const Vec<dim>& x) const {
    return velocity_.translation + spin<dim>(velocity_.rotation, x - pose_.reference);
  }

  /// @param force      of a particle on the tool, N
  /// @param point      where it acts, m
  /// @param stiffness  normal stiffness of the contact, N/m; only a servo needs it
  void add_load(const Vec<dim>& force, const Vec<dim>& point, double stiffness);
  /// The sum of many of them, about the reference point.
  void add_load(const ToolLoad<dim>& load) { load_ += load; }
  /// Sums of add_load() in this step; the moment is about the reference point.
  const ToolLoad<dim>& load() const noexcept { return load_; }

  void end_step();

  /// Of t_n, after end_step(): what the tool does to the particles, -(F . v + M . omega) with the
  /// mean of v^(n-1/2) and v^(n+1/2), W.
  double power() const noexcept { return power_; }
  /// Done on the particles from t_0 to t_n, after end_step(), J.
  double work() const noexcept { return work_; }

  /// Bound of the acceleration that a unit force gives to a point, along the force, 1/kg; 0 where
  /// the motion is not free.
  double mobility(const Vec<dim>& point) const {
    return mover_.inverse_mass() +
           mover_.inverse_inertia() * (point - pose_.reference).squaredNorm();
  }

private:
  friend struct StateParts;

  ToolShape<dim> shape_;
  ToolMover<dim> mover_;
  std::uint64_t step_ = 0;
  double time_step_ = 0.0; // s
  Pose<dim> pose_, pose_before_;
  double angle_ = 0.0; // rad
  RigidVelocity<dim> velocity_;
  ToolLoad<dim> load_;
  double power_ = 0.0;
  double work_ = 0.0;       // until t_n, J
  double work_ahead_ = 0.0; // until t_(n+1/2), J
};

} // namespace kerf::dem
