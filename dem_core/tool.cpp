#include "dem_core/tool.hpp"

#include <cassert>
#include <utility>

namespace kerf::dem {

namespace {

/// Rotation by an angle about a unit vector.
template <int dim> Eigen::Matrix<double, dim, dim> rotation(double angle, const Rot<dim>& axis) {
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(angle * axis[0]).toRotationMatrix();
  else
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

} // namespace

template <int dim>
Tool<dim>::Tool(ToolShape<dim> shape, const ToolMotion<dim>& motion)
    : shape_(std::move(shape)),
      mover_(motion), pose_{motion.reference, motion.reference, rotation<dim>(0.0, mover_.axis())},
      pose_before_(pose_), velocity_(mover_.initial_velocity()) {}

template <int dim> void Tool<dim>::begin_step(std::uint64_t step, double time_step) {
  assert(time_step > 0.0 && (step == 0 || step == step_ + 1));
  step_ = step;
  time_step_ = time_step;
  const double t = static_cast<double>(step) * time_step;
  pose_before_ = pose_;
  angle_ = mover_.angle(t);
  pose_.reference = pose_.start + mover_.translation(t);
  pose_.rotation = rotation<dim>(angle_, mover_.axis());
  load_ = {};
}

template <int dim>
void Tool<dim>::add_load(const Vec<dim>& force, const Vec<dim>& point, double stiffness) {
  load_.force += force;
  load_.moment += moment<dim>(point - pose_.reference, force);
  load_.stiffness += stiffness;
}

template <int dim> void Tool<dim>::end_step() {
  const double before = load_.power(velocity_);
  velocity_ = mover_.advance(step_, time_step_, load_);
  const double after = load_.power(velocity_);

  // Half of the step before t_n and half of the one after it; what was before t_0 is no work.
  power_ = step_ == 0 ? -before : -0.5 * (before + after);
  work_ = work_ahead_ - (step_ == 0 ? 0.0 : 0.5 * time_step_ * before);
  work_ahead_ = work_ - 0.5 * time_step_ * after;
}

template class Tool<2>;
template class Tool<3>;

} // namespace kerf::dem
