#include "fem_core/engine.hpp"

#include "common/ordered_sum.hpp"
#include "fem_core/initial.hpp"
#include "fem_core/integrate.hpp"
#include "fem_core/internal_force.hpp"
#include "fem_core/mass.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kerf::fem {

template <int dim>
Engine<dim>::Engine(Mesh<dim> mesh, Settings<dim> settings)
    : mesh_(std::move(mesh)), settings_(std::move(settings)), boundary_(mesh_, settings_.boundary) {
  std::vector<double> u(mesh_.num_nodes() * dim), v(u.size());
  add_initial<dim>(mesh_, settings_.initial, u, v); // throws now, not when the run starts
  set_weights({});
}

template <int dim> void Engine<dim>::set_weights(std::span<const double> alpha) {
  elements_ = make_elements(mesh_, alpha);
  mass_ = lumped_mass(elements_, settings_.material.density);
  element_omega2_ = element_omega2(elements_, settings_.material);
  inverse_mass_.assign(mass_.size() * dim, 0.0);
  for (std::size_t dof = 0; dof < inverse_mass_.size(); ++dof)
    if (mass_[dof / dim] > 0.0)
      inverse_mass_[dof] = 1.0 / mass_[dof / dim];
  moved_.clear();
  for (const Prescribed& entry : boundary_.entries())
    if (mass_[entry.node] > 0.0) {
      moved_.push_back(entry);
      inverse_mass_[std::size_t{entry.node} * dim + entry.component] = 0.0;
    }
}

template <int dim> StepLimit Engine<dim>::step_limit() const {
  const auto largest = std::max_element(element_omega2_.begin(), element_omega2_.end());
  if (largest == element_omega2_.end())
    return {.omega2 = 0.0, .limited_by = "no element"};
  return {.omega2 = *largest,
          .limited_by =
              fmt::format("element {}", elements_.number[largest - element_omega2_.begin()])};
}

template <int dim>
void Engine<dim>::inverse_mass(std::span<const std::uint32_t> nodes, std::span<double> out) const {
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (int i = 0; i < dim; ++i)
      out[k * dim + i] = inverse_mass_[std::size_t{nodes[k]} * dim + i];
}

template <int dim>
void Engine<dim>::omega2(std::span<const std::uint32_t> nodes, std::span<double> out) const {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    out[k] = 0.0;
    for (std::size_t c = elements_.first_corner[nodes[k]]; c < elements_.first_corner[nodes[k] + 1];
         ++c)
      out[k] = std::max(out[k], element_omega2_[elements_.corners[c] / element_nodes<dim>]);
  }
}

template <int dim> void Engine<dim>::start(double time_step) {
  if (!(time_step > 0.0))
    throw std::invalid_argument(fmt::format("the time step {} s must be positive", time_step));
  time_step_ = time_step;
  step_ = 0;
  const std::size_t size = mesh_.num_nodes() * dim;
  displacement_.assign(size, 0.0);
  velocity_.assign(size, 0.0);
  add_initial<dim>(mesh_, settings_.initial, displacement_, velocity_);
  for (std::size_t dof = 0; dof < size; ++dof)
    if (!(mass_[dof / dim] > 0.0))
      displacement_[dof] = velocity_[dof] = 0.0;
  initial_displacement_.clear();
  for (const Prescribed& p : moved_) {
    const std::size_t dof = std::size_t{p.node} * dim + p.component;
    initial_displacement_.push_back(displacement_[dof]);
    velocity_[dof] = boundary_.velocity(p.node, p.component, -1, time_step);
  }
  displacement_before_ = displacement_;
  velocity_before_ = velocity_;
  element_force_.assign(elements_.size() * element_nodes<dim> * dim, 0.0);
  own_force_.assign(size, 0.0);
  interface_force_.assign(size, 0.0);
  has_interface_force_ = false;
  external_work_ = interface_work_ = {};
}

template <int dim>
void Engine<dim>::motion(std::span<const std::uint32_t> nodes, std::span<double> position,
                         std::span<double> velocity) const {
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (int i = 0; i < dim; ++i) {
      const std::size_t dof = std::size_t{nodes[k]} * dim + i;
      position[k * dim + i] = mesh_.positions[dof] + displacement_[dof];
      const bool moved = boundary_.is_prescribed(nodes[k], i) && mass_[nodes[k]] > 0.0;
      velocity[k * dim + i] =
          moved ? boundary_.velocity(nodes[k], i, step_, time_step_) : velocity_[dof];
    }
}

template <int dim> void Engine<dim>::compute_own_forces() {
  compute_element_forces<dim>(elements_, settings_.material, displacement_, element_force_);
  gather_element_forces<dim>(elements_, element_force_, own_force_);
  if (has_interface_force_)
    std::fill(interface_force_.begin(), interface_force_.end(), 0.0);
  has_interface_force_ = false;
}

template <int dim>
void Engine<dim>::own_forces(std::span<const std::uint32_t> nodes, std::span<double> force) const {
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (int i = 0; i < dim; ++i)
      force[k * dim + i] = own_force_[std::size_t{nodes[k]} * dim + i];
}

template <int dim>
void Engine<dim>::add_interface_forces(std::span<const std::uint32_t> nodes,
                                       std::span<const double> force) {
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (int i = 0; i < dim; ++i)
      interface_force_[std::size_t{nodes[k]} * dim + i] += force[k * dim + i];
  has_interface_force_ = has_interface_force_ || !nodes.empty();
}

template <int dim> void Engine<dim>::integrate() {
  const Loads loads{
      .own = own_force_, .interface = interface_force_, .inverse_mass = inverse_mass_};
  if (step_ == 0)
    step_back_half(loads, time_step_, velocity_);
  advance(loads, time_step_, velocity_, displacement_, velocity_before_, displacement_before_);
  std::swap(velocity_, velocity_before_);
  std::swap(displacement_, displacement_before_);
  move_boundary();
  external_work_.add(reaction_work(), step_ == 0);
  interface_work_.add(has_interface_force_ ? interface_work() : Work{}, step_ == 0);
  ++step_;
}

/// Gives the prescribed components v^(n+1/2) and u^(n+1).
template <int dim> void Engine<dim>::move_boundary() {
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    const auto [node, component] = moved_[k];
    const std::size_t dof = std::size_t{node} * dim + component;
    velocity_[dof] = boundary_.velocity(node, component, step_, time_step_);
    displacement_[dof] =
        initial_displacement_[k] + boundary_.displacement(node, component, step_ + 1, time_step_);
  }
}

template <int dim> Work Engine<dim>::reaction_work() const {
  return ordered_sum(moved_.size(), [&](std::size_t k) {
    const std::size_t dof = std::size_t{moved_[k].node} * dim + moved_[k].component;
    const double before = velocity_before_[dof];
    const double after = velocity_[dof];
    const double reaction = mass_[moved_[k].node] * (after - before) / time_step_ -
                            own_force_[dof] - interface_force_[dof]; // N
    return Work{.before = 0.5 * time_step_ * reaction * before,
                .after = 0.5 * time_step_ * reaction * after};
  });
}

template <int dim> Work Engine<dim>::interface_work() const {
  return ordered_sum(interface_force_.size(), [&](std::size_t dof) {
    const double f = interface_force_[dof]; // N
    return Work{.before = 0.5 * time_step_ * f * velocity_before_[dof],
                .after = 0.5 * time_step_ * f * velocity_[dof]};
  });
}

template <int dim> Energies Engine<dim>::energies() const {
  return {.kinetic = kinetic_energy<dim>(mass_, velocity_before_, velocity_),
          .elastic = elastic_energy<dim>(elements_, settings_.material, displacement_before_),
          .external_work = external_work_.at_step(),
          .interface_work = interface_work_.at_step()};
}

template <int dim> Vec<dim> Engine<dim>::momentum() const {
  return fem::momentum<dim>(mass_, velocity_before_, velocity_);
}

template <int dim> std::optional<std::uint32_t> Engine<dim>::first_non_finite() const {
  for (std::size_t dof = 0; dof < displacement_.size(); ++dof)
    if (!std::isfinite(displacement_[dof]) || !std::isfinite(velocity_[dof]))
      return static_cast<std::uint32_t>(dof / dim);
  return std::nullopt;
}

template class Engine<2>;
template class Engine<3>;

} // namespace kerf::fem
