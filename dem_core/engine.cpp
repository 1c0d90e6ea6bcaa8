#include "dem_core/engine.hpp"

#include "common/ordered_sum.hpp"
#include "dem_core/balance.hpp"
#include "dem_core/contact_constants.hpp"
#include "dem_core/damping.hpp"
#include "dem_core/gravity.hpp"
#include "dem_core/initial.hpp"
#include "dem_core/integrate.hpp"
#include "dem_core/probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace kerf::dem {

namespace {

/// Gap up to which pairs are listed, m. A tenth of a diameter: the list of a bonded lattice holds
/// its bonds only, and is made again when a particle has moved by a twentieth.
double skin_width(std::span<const double> radius) {
  return 0.2 * std::accumulate(radius.begin(), radius.end(), 0.0) /
         static_cast<double>(radius.size());
}

template <int dim>
Particles<dim> make_bodies(const Settings<dim>& settings, const Materials& materials) {
  auto particles = make_particles<dim>(settings.positions, settings.radii,
                                       settings.material.density, settings.ids);
  set_materials(particles, settings.material_of, materials);
  return particles;
}

} // namespace

template <int dim>
Engine<dim>::Engine(const Settings<dim>& settings)
    : materials_(settings.material, settings.other_materials, settings.pairs),
      damping_(settings.damping), shear_increment_(settings.shear_increment),
      initial_(settings.initial), period_(settings.period),
      particles_(make_bodies(settings, materials_)),
      boundary_(settings.boundary, particles_.reference), reactions_(settings.boundary.size()),
      applied_forces_(settings.applied_forces, particles_), mass_scaling_(settings.mass_scaling),
      gravity_(settings.gravity), start_rotation_(particles_.size()) {
  clusters_ = Clusters<dim>(settings.clusters, particles_, boundary_);
  if (!gravity_.allFinite())
    throw std::invalid_argument("gravity must be finite");
  const double width = skin_width(particles_.radius);
  const bool has_bonds = settings.bonds && materials_.may_bond();
  contacts_ = make_contacts(particles_, materials_,
                            has_bonds ? std::optional(settings.gap_tolerance) : std::nullopt, width,
                            period_);
  skin_ = Skin<dim>(width, particles_.displacement); // before the initial displacement
  bonds_at_start_ = contacts_.bonds();
  add_tools(settings);
  if (settings.in_situ_stress)
    load_bonds(*settings.in_situ_stress);
  start_rotation_ = apply_initial_displacements<dim>(initial_, particles_);
  for (std::size_t i = 0; i < size(); ++i)
    if (particles_.is_member(i) &&
        !(particles_.displacement[i].isZero(0.0) && start_rotation_[i].isZero(0.0)))
      throw std::invalid_argument(fmt::format(
          "a pulse at the start would deform the cluster of particle {}", particles_.ids[i]));
  loads_.own.resize(size() + contacts_.waiting_rows());
  scale_mass();
}

template <int dim> void Engine<dim>::add_tools(const Settings<dim>& settings) {
  for (const ToolSettings<dim>& tool : settings.tools)
    try {
      tool_names_.push_back(tool.name);
      tools_.emplace_back(tool.shape, tool.motion);
      wall_contacts_.emplace_back(tool.material, tools_.back(), particles_, skin_.width(), period_);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("tool {}: {}", tool.name, error.what()));
    }
}

template <int dim> void Engine<dim>::load_bonds(const InSituStress<dim>& stress) {
  if (clusters_.size() > 0)
    throw ImpossibleStress("there are clusters, which have no stress");
  Loads<dim> outside; // of the start
  outside.own.resize(size());
  const ParticleBlock all{0, size()};
  add_weight(gravity_, particles_, all, outside);
  applied_forces_.begin_step(0.0, particles_);
  applied_forces_.add(all, outside);
  in_situ_stress_ = set_in_situ_stress<dim>(stress, gravity_, outside.own, particles_, boundary_,
                                            period_, contacts_, wall_contacts_);
}

template <int dim> std::vector<double> Engine<dim>::stiffness() const {
  std::vector<double> sum(size(), 0.0);
  std::vector<int> count(size(), 0);
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    if (contacts_.bonded[k])
      for (const std::uint32_t i : {contacts_.first[k], contacts_.second[k]}) {
        sum[i] += contacts_.normal_stiffness[k];
        ++count[i];
      }
  for (std::size_t i = 0; i < size(); ++i)
    sum[i] = count[i] > 0 ? sum[i] / count[i] : materials_.of(particles_, i).normal_stiffness;
  return sum;
}

template <int dim> double Engine<dim>::memory() const {
  constexpr std::size_t vec = sizeof(Vec<dim>), number = sizeof(double);
  constexpr std::size_t motion = 2 * sizeof(Aligned<Vec<dim>>) + sizeof(Aligned<Rot<dim>>);
  const std::size_t particle =
      2 * vec + motion + 3 * number + particles_.weight.size() / size() * number;
  const std::size_t rows = size() + contacts_.waiting_rows() + loads_.damping.size();
  return static_cast<double>(size() * particle + rows * sizeof(Load<dim>)) + contacts_.memory();
}

template <int dim> void Engine<dim>::set_weights(std::span<const double> weight) {
  blend(particles_, weight);
  if (!weight.empty())
    blend(contacts_, particles_);
  scale_mass();
}

template <int dim>
void Engine<dim>::inverse_mass(std::span<const std::uint32_t> points, std::span<double> out) const {
  assert(out.size() == points.size() * dim);
  for (std::size_t k = 0; k < points.size(); ++k)
    for (int a = 0; a < dim; ++a)
      out[k * dim + a] =
          boundary_.prescribes(points[k], a) ? 0.0 : 1.0 / particles_.mass[points[k]];
}

template <int dim> void Engine<dim>::start(double time_step) {
  if (!(time_step > 0.0) || !std::isfinite(time_step))
    throw std::invalid_argument(fmt::format("time step {} s must be positive", time_step));
  time_step_ = time_step;
  apply_initial_velocities<dim>(initial_, time_step, particles_);
  clusters_.start(particles_);
  boundary_.advance(0, time_step);
  weight_work_at_start_ = weight_work(gravity_, particles_, 0.0);
}

template <int dim>
void Engine<dim>::motion(std::span<const std::uint32_t> points, std::span<double> position,
                         std::span<double> velocity) const {
  assert(position.size() == points.size() * dim && velocity.size() == points.size() * dim);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::uint32_t i = points[k];
    for (int a = 0; a < dim; ++a) {
      position[k * dim + a] = particles_.reference[i][a] + particles_.displacement[i][a];
      velocity[k * dim + a] =
          boundary_.prescribes(i, a) ? boundary_.of(i)->velocity[a] : particles_.velocity[i][a];
    }
  }
}

template <int dim> void Engine<dim>::compute_own_forces() {
  if (!forces_are_current_)
    compute_forces(false);
}

/// Block by block. `moves`: every one makes its step as soon as it is complete.
/// @return the farthest that a particle has moved, m
template <int dim> double Engine<dim>::compute_forces(bool moves) {
  forget_interface_forces();
  if (skin_.is_worn(particles_.displacement)) {
    renew_contacts(contacts_, particles_, materials_, skin_.width(), period_);
    skin_ = Skin<dim>(skin_.width(), particles_.displacement);
    ++renewals_;
  }
  // The increment of the first step is the displacement from the reference configuration.
  Increment<dim> increment{particles_.velocity, particles_.angular_velocity, time_step_, time_step_,
                           travelled_};
  if (step_ == 0)
    increment = {particles_.displacement, start_rotation_, 1.0, 0.0, travelled_};
  const double tool_time = step_ == 0 ? 0.0 : time_step_;
  for (std::size_t k = 0; k < tools_.size(); ++k) {
    tools_[k].begin_step(step_, time_step_);
    wall_contacts_[k].begin_step(tools_[k], particles_, tool_time);
  }
  applied_forces_.begin_step(static_cast<double>(step_) * time_step_, particles_);
  if (damping_.is_on())
    loads_.damping.resize(size());

  std::vector<std::vector<ToolLoad<dim>>> on_tools(tools_.size());
  for (std::vector<ToolLoad<dim>>& parts : on_tools)
    parts.resize(contacts_.blocks());
  std::vector<double> farthest(contacts_.blocks(), 0.0); // m
  const auto complete = [&](std::size_t b) {
    const ParticleBlock block = particle_block(b, size());
    for (std::size_t k = 0; k < tools_.size(); ++k)
      on_tools[k][b] =
          wall_contacts_[k].compute(b, tools_[k], particles_, increment, tool_time, loads_);
    add_weight(gravity_, particles_, block, loads_);
    applied_forces_.add(block, loads_);
    add_damping(damping_, particles_, boundary_, block, loads_);
    if (moves)
      farthest[b] = dem::integrate(particles_, loads_, boundary_, block, time_step_, step_ == 0);
  };
  const std::vector<Break<dim>> breaks =
      compute_contact_forces(contacts_, particles_, increment, shear_increment_, loads_, complete);
  for (const Break<dim>& lost : breaks)
    cracks_.push_back(crack_of(lost, contacts_, step_, static_cast<double>(step_) * time_step_));
  for (std::size_t k = 0; k < tools_.size(); ++k)
    for (const ToolLoad<dim>& part : on_tools[k])
      tools_[k].add_load(part);
  forces_are_current_ = true;
  return *std::max_element(farthest.begin(), farthest.end());
}

/// With the forces that there are.
/// @return the farthest that a particle has moved, m
template <int dim> double Engine<dim>::move() {
  clusters_.advance(loads_, damping_, gravity_, step_, time_step_, boundary_);
  double farthest = 0.0;
  const auto blocks = static_cast<std::int64_t>(count_blocks(size()));
#pragma omp parallel for schedule(static) reduction(max : farthest) if (blocks > 1)
  for (std::int64_t b = 0; b < blocks; ++b)
    farthest =
        std::max(farthest, dem::integrate(particles_, loads_, boundary_, particle_block(b, size()),
                                          time_step_, step_ == 0));
  clusters_.place(particles_);
  return farthest;
}

template <int dim>
void Engine<dim>::own_forces(std::span<const std::uint32_t> points, std::span<double> force) const {
  assert(force.size() == points.size() * dim);
  for (std::size_t k = 0; k < points.size(); ++k)
    for (int a = 0; a < dim; ++a)
      force[k * dim + a] = loads_.own[points[k]].force[a];
}

template <int dim>
void Engine<dim>::add_interface_forces(std::span<const std::uint32_t> points,
                                       std::span<const double> force) {
  assert(force.size() == points.size() * dim);
  forget_interface_forces();
  loads_.interface_force.resize(size(), Vec<dim>::Zero());
  is_touched_.resize(size(), 0);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::uint32_t i = points[k];
    for (int a = 0; a < dim; ++a)
      loads_.interface_force[i][a] += force[k * dim + a];
    if (!is_touched_[i]) {
      is_touched_[i] = 1;
      touched_.push_back(i);
    }
  }
}

/// Those of the last step stay for its books until the next step begins.
template <int dim> void Engine<dim>::forget_interface_forces() {
  if (!interface_forces_are_old_)
    return;
  for (const std::uint32_t i : touched_) {
    loads_.interface_force[i].setZero();
    is_touched_[i] = 0;
  }
  touched_.clear();
  interface_forces_are_old_ = false;
}

template <int dim> void Engine<dim>::integrate() {
  assert(time_step_ > 0.0);
  if (clusters_.size() > 0) // their resultant needs all of their members
    compute_own_forces();
  const double farthest = forces_are_current_ ? move() : compute_forces(true);
  travelled_ += farthest;
  skin_.wear(farthest);
  for (std::size_t k = 0; k < tools_.size(); ++k) {
    tools_[k].end_step();
    wall_contacts_[k].wear(farthest);
  }
  book_step();
  interface_forces_are_old_ = true;
  ++step_;
  boundary_.advance(step_, time_step_);
  forces_are_current_ = false;
}

template <int dim> void Engine<dim>::book_step() {
  const StepWork step = step_work(particles_, loads_, boundary_, touched_, time_step_);
  work_ = work_ahead_;
  if (step_ > 0) // what was before t_0 is no work of this run
    work_ += step.before;
  work_ahead_ = work_;
  work_ahead_ += step.after;
  reactions_.book(particles_, loads_, boundary_, time_step_, step_ == 0);
  applied_forces_.book(static_cast<double>(step_) * time_step_, particles_, loads_, boundary_,
                       time_step_, step_ == 0);
}

template <int dim> Energies Engine<dim>::energies() const {
  Energies energies;
  energies.kinetic =
      kinetic_energy(particles_, loads_, boundary_, time_step_) + clusters_.kinetic_energy();
  energies.elastic = elastic_energy(contacts_, particles_);
  energies.external_work = reactions_.work() + applied_forces_.work() + clusters_.drive_work() +
                           clusters_.weight_work(gravity_);
  energies.interface_work = work_.interface;
  energies.damping_dissipation = -work_.damping - clusters_.damping_work();
  for (const ContactLosses& block : contacts_.losses) {
    energies.friction_dissipation += block.friction;
    energies.fracture_dissipation += block.fracture;
    energies.damping_dissipation += block.viscous;
  }
  energies.external_work += weight_work(gravity_, particles_, time_step_) - weight_work_at_start_;
  for (std::size_t k = 0; k < tools_.size(); ++k) {
    energies.elastic += wall_contacts_[k].elastic_energy();
    energies.external_work += tools_[k].work();
    energies.friction_dissipation += wall_contacts_[k].friction_loss();
  }
  return energies;
}

template <int dim> Vec<dim> Engine<dim>::momentum() const {
  return dem::momentum(particles_, loads_, boundary_, time_step_) + clusters_.momentum();
}

template <int dim> Reaction<dim> Engine<dim>::reaction(std::size_t set) const {
  return dem::reaction(particles_, loads_, boundary_, time_step_, set);
}

template <int dim> double Engine<dim>::unbalanced_force() const {
  return dem::unbalanced_force(contacts_, particles_, boundary_, loads_, clusters_);
}

template <int dim> std::optional<std::uint32_t> Engine<dim>::first_not_finite() const {
  for (std::uint32_t i = 0; i < size(); ++i)
    if (!particles_.displacement[i].allFinite() || !particles_.angular_velocity[i].allFinite())
      return i;
  return std::nullopt;
}

template <int dim>
std::optional<std::uint32_t> Engine<dim>::first_outside(const Box<dim>& box) const {
  for (std::uint32_t i = 0; i < size(); ++i)
    if (!contains(box, period_, particles_.position(i)))
      return i;
  return std::nullopt;
}

template class Engine<2>;
template class Engine<3>;

} // namespace kerf::dem
