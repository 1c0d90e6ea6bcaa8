#include "dem_core/change.hpp"

#include "dem_core/contact_constants.hpp"
#include "dem_core/engine.hpp"
#include "dem_core/gravity.hpp"

namespace kerf::dem {

template <int dim> void Engine<dim>::change(const Change<dim>& change) {
  if (change.damping) {
    damping_ = *change.damping;
    loads_.damping.clear(); // of the step before
  }
  if (change.gravity) {
    // The trapezoidal rule has the old weight in the first half of a step and the new one in the
    // second: the potential changes at u^n - v^(n-1/2) dt / 2.
    const double half = 0.5 * time_step_;
    weight_work_at_start_ +=
        weight_work(*change.gravity, particles_, half) - weight_work(gravity_, particles_, half);
    weight_work_at_start_ +=
        clusters_.weight_work(*change.gravity, 0.5) - clusters_.weight_work(gravity_, 0.5);
    gravity_ = *change.gravity;
  }
  if (change.friction) {
    materials_.set_friction(*change.friction);
    set_constants(contacts_, particles_, materials_);
  }
  if (change.boundary) {
    Boundary<dim> boundary(*change.boundary, particles_.reference, step_);
    clusters_.carry_members(particles_, boundary);
    boundary_ = std::move(boundary);
    boundary_.advance(step_, time_step_);
    reactions_.replace_sets(change.boundary->size());
  }
  for (const auto& [index, motion] : change.tools)
    tools_.at(index).redirect(motion, static_cast<double>(step_) * time_step_);
  if (change.bond_gap) {
    bonds_at_start_ +=
        bond_pairs(contacts_, particles_, materials_, *change.bond_gap, skin_.width(), period_);
    skin_ = Skin<dim>(skin_.width(), particles_.displacement);
    ++renewals_;
  }
  forces_are_current_ = false;
}

template void Engine<2>::change(const Change<2>&);
template void Engine<3>::change(const Change<3>&);

} // namespace kerf::dem
