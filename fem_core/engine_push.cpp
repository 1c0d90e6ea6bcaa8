// What acts on nodes that have been moved: loads, dashpots and walls, which need the velocity
// behind the step.
#include "fem_core/engine.hpp"

#include <Eigen/LU>

namespace kerf::fem {

template <int dim> bool Engine<dim>::is_held(std::uint32_t row, int component) const {
  return boundary_.is_prescribed(patches_.node_of_row[row], component);
}

/// Time over which the forces of this step change the velocities: v^(1/2) = v^0 + a dt/2, and
/// likewise where what is free starts anew from rest.
template <int dim> double Engine<dim>::span_of_step() const {
  return step_ == 0 || stops() ? 0.5 * time_step_ : time_step_;
}

/// Adds a force to a row that has been advanced, which gives it another velocity. Damping stays
/// what it was before, but for what a stop takes.
template <int dim>
void Engine<dim>::push(std::uint32_t row, const Vec<dim>& before, const Vec<dim>& after,
                       const Vec<dim>& force) {
  const double m = mass_[row], span = step_ == 0 ? 0.5 * time_step_ : time_step_;
  const Vec<dim> old = velocity_[row], change = after - old, gravity = weight(row);
  const Vec<dim> resisted = force_[row] + gravity - m / span * (old - before); // N, by damping
  const Vec<dim> resists = stops() ? Vec<dim>(resisted + force - m / span * change) : resisted;
  velocity_[row] = after;
  displacement_[row] += time_step_ * change;
  for (int i = 0; i < dim; ++i)
    if (!is_held(row, i)) {
      const double f = force_[row][i] + gravity[i];
      sums_.unbalanced2 += (f + force[i]) * (f + force[i]) - f * f;
    }
  force_[row] += force;
  if (step_ == 0) { // v^(-1/2) = 2 v^0 - v^(1/2) changes as well, and their mean stays
    sums_.kinetic += 0.5 * m * ((2.0 * before - after).dot(after) - (2.0 * before - old).dot(old));
  } else {
    sums_.kinetic += 0.5 * m * before.dot(change);
    sums_.momentum += 0.5 * m * change;
  }
  sums_.gravity.after += 0.5 * time_step_ * gravity.dot(change);
  for (int i = 0; i < dim; ++i)
    if (!is_held(row, i))
      sums_.damped += {.before = 0.5 * time_step_ * (resists[i] - resisted[i]) * before[i],
                       .after = 0.5 * time_step_ * (resists[i] * after[i] - resisted[i] * old[i])};
}

/// What loads, dashpots and walls act on, in this order, with the velocities before the step.
template <int dim> std::vector<typename Engine<dim>::Pushed> Engine<dim>::pushed_rows() const {
  std::vector<Pushed> pushed;
  const auto add = [&](std::uint32_t node) {
    const std::uint32_t row = patches_.row_of_node[node];
    pushed.push_back({row, velocity_[row], Vec<dim>::Zero(), Vec<dim>::Zero()});
  };
  for (const std::uint32_t node : loads_.nodes())
    add(node);
  for (const auto& absorbing : absorbing_.nodes())
    add(absorbing.node);
  for (std::size_t wall = 0; wall < walls_.size(); ++wall)
    for (const std::uint32_t node : walls_.nodes(wall))
      add(node);
  return pushed;
}

/// The dashpots act with the mean of the velocities before and after, which is stable for every
/// step: (M/dt + C/2) v^(n+1/2) = M/dt v - C/2 v^(n-1/2) + f, where v is what the other forces
/// give.
template <int dim> void Engine<dim>::push_by_dashpots(std::span<Pushed> pushed) {
  using Matrix = Eigen::Matrix<double, dim, dim>;
  std::vector<double> incoming(absorbing_.nodes().size() * dim);
  absorbing_.incoming(static_cast<double>(step_) * time_step_, incoming);
  for (std::size_t k = 0; k < absorbing_.nodes().size(); ++k) {
    auto& [row, before, driving, resisting] = pushed[loads_.nodes().size() + k];
    if (!(mass_[row] > 0.0))
      continue;
    const Matrix& damper = absorbing_.nodes()[k].damper;
    const Vec<dim> old = velocity_[row], wave = Eigen::Map<const Vec<dim>>(&incoming[k * dim]);
    driving = support_[k] + wave;
    const double D = mass_[row] / span_of_step();
    Matrix A = D * Matrix::Identity() + 0.5 * damper;
    const Vec<dim> from = stops() ? Vec<dim>(Vec<dim>::Zero()) : before;
    Vec<dim> b = D * old - 0.5 * damper * from + wave;
    for (int i = 0; i < dim; ++i)
      if (is_held(row, i)) {
        A.row(i) = Vec<dim>::Unit(i).transpose();
        b[i] = old[i];
      }
    const Vec<dim> after = A.inverse() * b;
    resisting = 0.5 * damper * (from + after);
    push(row, before, after, wave - resisting);
  }
}

template <int dim> void Engine<dim>::push_by_walls(std::span<Pushed> pushed) {
  std::size_t k = loads_.nodes().size() + absorbing_.nodes().size();
  for (std::size_t wall = 0; wall < walls_.size(); ++wall) {
    wall_forces_[wall].setZero();
    for (const std::uint32_t node : walls_.nodes(wall)) {
      auto& [row, before, driving, resisting] = pushed[k++];
      if (!(mass_[row] > 0.0))
        continue;
      Vec<dim> added =
          walls_.impulse(wall, mesh_.position(node) + displacement_[row], velocity_[row],
                         static_cast<double>(step_ + 1) * time_step_, time_step_);
      for (int i = 0; i < dim; ++i)
        if (is_held(row, i))
          added[i] = 0.0;
      if (added.isZero(0.0))
        continue;
      driving = mass_[row] / span_of_step() * added; // N
      push(row, before, velocity_[row] + added, driving);
      wall_forces_[wall] += driving;
    }
  }
}

template bool Engine<2>::is_held(std::uint32_t, int) const;
template bool Engine<3>::is_held(std::uint32_t, int) const;
template double Engine<2>::span_of_step() const;
template double Engine<3>::span_of_step() const;
template std::vector<Engine<2>::Pushed> Engine<2>::pushed_rows() const;
template std::vector<Engine<3>::Pushed> Engine<3>::pushed_rows() const;
template void Engine<2>::push_by_dashpots(std::span<Pushed>);
template void Engine<3>::push_by_dashpots(std::span<Pushed>);
template void Engine<2>::push_by_walls(std::span<Pushed>);
template void Engine<3>::push_by_walls(std::span<Pushed>);

} // namespace kerf::fem
