// One step of the engine: forces, then what they do to the nodes.
#include "fem_core/engine.hpp"

#include <Eigen/LU>
#include <omp.h>

#include <algorithm>

namespace kerf::fem {
namespace {

constexpr std::size_t rows_per_block = 1024;

} // namespace

template <int dim> void Engine<dim>::compute_own_forces() {
  for (const std::uint32_t row : interface_rows_)
    interface_force_[row].setZero();
  interface_rows_.clear();
  compute_forces(false);
  forces_are_current_ = true;
}

/// Computes the internal forces of all patches. A patch that need not wait for others finishes its
/// own rows while they are in the cache.
template <int dim> void Engine<dim>::compute_forces(bool finish) {
  // There has been no increment before the first step.
  const PatchMotion<dim> motion{reference_, displacement_, velocity_,
                                step_ == 0 ? 0.0 : time_step_};
  for (std::uint32_t g = 0; g < groups_.size(); ++g)
    if (groups_[g].compute_dilatation != nullptr)
      average_dilatation(g, motion);
  const StepSettings<dim> step = step_settings();
  const auto num_patches = static_cast<std::int64_t>(patches_.patches.size());
  patch_work_.resize(patches_.patches.size());
  patch_sums_.assign(patches_.patches.size(), {});
  make_scratch();
#pragma omp parallel if (num_patches > 1)
  {
    PatchScratch<dim>& scratch = scratch_[static_cast<std::size_t>(omp_get_thread_num())];
#pragma omp for schedule(static)
    for (std::int64_t p = 0; p < num_patches; ++p) {
      const auto k = static_cast<std::size_t>(p);
      const Patch& patch = patches_.patches[k];
      patch_work_[k] =
          compute_patch<dim>(patches_, patch, groups_[patch.group], motion, Wanted::force, scratch);
      std::copy_n(scratch.force.at(patch.num_own), patch.num_shared * row_size<dim>,
                  parts_.at(patch.first_shared));
      if (finish)
        advance<dim>(step, patch.num_own, &mass_[patch.first_row], scratch.force.data(), nullptr,
                     velocity_.at(patch.first_row), displacement_.at(patch.first_row),
                     patch_sums_[k]);
      else
        std::copy_n(scratch.force.data(), patch.num_own * row_size<dim>,
                    force_.at(patch.first_row));
    }
  }
  for (const ElementWork& of_patch : patch_work_) {
    element_work_.internal += of_patch.internal;
    element_work_.dissipated += of_patch.dissipated;
    element_work_.hourglass += of_patch.hourglass;
    element_work_.viscous += of_patch.viscous;
  }
  const auto num_special = static_cast<std::int64_t>(patches_.num_special);
#pragma omp parallel for schedule(static) if (num_special > 1000)
  for (std::int64_t k = 0; k < num_special; ++k) {
    const Row<dim> sum = sum_of_parts(static_cast<std::size_t>(k));
    std::copy_n(sum.x, row_size<dim>, force_.at(patches_.num_plain + static_cast<std::size_t>(k)));
  }
  add_loads();
}

/// For every thread that may come.
template <int dim> void Engine<dim>::make_scratch() {
  while (scratch_.size() < static_cast<std::size_t>(omp_get_max_threads()))
    scratch_.emplace_back(patches_);
}

/// What the patches add up at a special row, in their order.
template <int dim> Row<dim> Engine<dim>::sum_of_parts(std::size_t special) const {
  Row<dim> sum;
  for (std::uint32_t k = patches_.first_part[special]; k < patches_.first_part[special + 1]; ++k)
    for (int i = 0; i < row_size<dim>; ++i)
      sum.x[i] += parts_.at(patches_.parts[k])[i];
  return sum;
}

/// Gives the nodes of a group the mean dilatation of its elements around them.
template <int dim>
void Engine<dim>::average_dilatation(std::uint32_t group, const PatchMotion<dim>& motion) {
  parts_.set_zero();
  std::vector<double>& mean = groups_[group].dilatation;
  mean.assign(patches_.num_rows(), 0.0);
  const auto num_patches = static_cast<std::int64_t>(patches_.patches.size());
  make_scratch();
#pragma omp parallel if (num_patches > 1)
  {
    PatchScratch<dim>& scratch = scratch_[static_cast<std::size_t>(omp_get_thread_num())];
#pragma omp for schedule(static)
    for (std::int64_t p = 0; p < num_patches; ++p) {
      const Patch& patch = patches_.patches[static_cast<std::size_t>(p)];
      if (patch.group != group)
        continue;
      compute_patch<dim>(patches_, patch, groups_[group], motion, Wanted::dilatation, scratch);
      std::copy_n(scratch.force.at(patch.num_own), patch.num_shared * row_size<dim>,
                  parts_.at(patch.first_shared));
      for (std::uint32_t k = 0; k < patch.num_own; ++k)
        mean[patch.first_row + k] = scratch.force.at(k)[0] / scratch.force.at(k)[1];
    }
  }
  for (std::size_t k = 0; k < patches_.num_special; ++k)
    if (const Row<dim> sum = sum_of_parts(k); sum.x[1] > 0.0)
      mean[patches_.num_plain + k] = sum.x[0] / sum.x[1];
}

template <int dim> void Engine<dim>::add_loads() {
  const auto nodes = loads_.nodes();
  std::vector<double> u(nodes.size() * dim);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    Eigen::Map<Vec<dim>>(u.data() + k * dim) = displacement_[patches_.row_of_node[nodes[k]]];
  loads_.compute(static_cast<double>(step_ - changed_at_) * time_step_, u, load_force_);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    force_[patches_.row_of_node[nodes[k]]] += Eigen::Map<const Vec<dim>>(&load_force_[k * dim]);
}

template <int dim> StepSettings<dim> Engine<dim>::step_settings() const {
  return {.time_step = time_step_,
          .first = step_ == 0,
          .gravity = settings_.gravity,
          .mass_damping = settings_.mass_damping,
          .local_damping = settings_.local_damping};
}

template <int dim>
void Engine<dim>::own_forces(std::span<const std::uint32_t> nodes, std::span<double> force) const {
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (int i = 0; i < dim; ++i)
      force[k * dim + i] = force_[patches_.row_of_node[nodes[k]]][i] +
                           mass_[patches_.row_of_node[nodes[k]]] * settings_.gravity[i];
}

template <int dim>
void Engine<dim>::add_interface_forces(std::span<const std::uint32_t> nodes,
                                       std::span<const double> force) {
  if (interface_force_.size() == 0)
    interface_force_ = Rows<dim>(patches_.num_rows());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::uint32_t row = patches_.row_of_node[nodes[k]];
    interface_force_[row] += Eigen::Map<const Vec<dim>>(&force[k * dim]);
    interface_rows_.push_back(row);
  }
}

template <int dim> void Engine<dim>::integrate() {
  std::sort(interface_rows_.begin(), interface_rows_.end());
  interface_rows_.erase(std::unique(interface_rows_.begin(), interface_rows_.end()),
                        interface_rows_.end());
  std::vector<Vec<dim>> interface_before;
  for (const std::uint32_t row : interface_rows_) {
    force_[row] += interface_force_[row];
    interface_before.push_back(velocity_[row]);
  }
  std::vector<double> moved_before;
  for (const Moved& moved : moved_) {
    moved_before.push_back(velocity_[moved.row][moved.component]);
    prescribed_[moved.row - patches_.num_plain][moved.component] =
        boundary_.velocity(moved.node, moved.component, step_ - changed_at_, time_step_);
  }

  std::vector<Pushed> pushed = pushed_rows();

  if (forces_are_current_)
    advance_plain();
  else
    compute_forces(true);
  advance_special();

  for (std::size_t k = 0; k < loads_.nodes().size(); ++k)
    pushed[k].driving = Eigen::Map<const Vec<dim>>(&load_force_[k * dim]);
  push_by_dashpots(pushed);
  push_by_walls(pushed);

  const bool first = step_ == 0;
  Work external, of_interface;
  reactions_.assign(settings_.boundary.size(), Vec<dim>::Zero());
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    const Moved& moved = moved_[k];
    const double after = velocity_[moved.row][moved.component];
    const double reaction = mass_[moved.row] * ((after - moved_before[k]) / time_step_ -
                                                settings_.gravity[moved.component]) -
                            force_[moved.row][moved.component]; // N
    reactions_[boundary_.setting_of({moved.node, moved.component})][moved.component] += reaction;
    external += {.before = 0.5 * time_step_ * reaction * moved_before[k],
                 .after = 0.5 * time_step_ * reaction * after};
    displacement_[moved.row][moved.component] =
        initial_displacement_[k] +
        boundary_.displacement(moved.node, moved.component, step_ - changed_at_ + 1, time_step_);
  }
  for (const auto& [row, before, driving, resisting] : pushed) {
    const Vec<dim> half_way = 0.5 * time_step_ * before,
                   other_half = 0.5 * time_step_ * velocity_[row];
    external += {.before = driving.dot(half_way), .after = driving.dot(other_half)};
    sums_.damped += {.before = resisting.dot(half_way), .after = resisting.dot(other_half)};
  }
  for (std::size_t k = 0; k < interface_rows_.size(); ++k) {
    const Vec<dim> f = interface_force_[interface_rows_[k]];
    of_interface += {.before = 0.5 * time_step_ * f.dot(interface_before[k]),
                     .after = 0.5 * time_step_ * f.dot(velocity_[interface_rows_[k]])};
  }
  external += sums_.gravity;
  external_work_.add(external, first);
  interface_work_.add(of_interface, first);
  damped_work_.add(sums_.damped, first);
  forces_are_current_ = false;
  ++step_;
}

/// Of the plain rows, by patches as when those finish them.
template <int dim> void Engine<dim>::advance_plain() {
  const StepSettings<dim> step = step_settings();
  const auto num_patches = static_cast<std::int64_t>(patches_.patches.size());
  patch_sums_.assign(patches_.patches.size(), {});
#pragma omp parallel for schedule(static) if (num_patches > 1)
  for (std::int64_t p = 0; p < num_patches; ++p) {
    const Patch& patch = patches_.patches[static_cast<std::size_t>(p)];
    advance<dim>(step, patch.num_own, mass_.data() + patch.first_row, force_.at(patch.first_row),
                 nullptr, velocity_.at(patch.first_row), displacement_.at(patch.first_row),
                 patch_sums_[static_cast<std::size_t>(p)]);
  }
}

template <int dim> void Engine<dim>::advance_special() {
  const StepSettings<dim> step = step_settings();
  const std::size_t first = patches_.num_plain, count = patches_.num_special;
  const std::size_t blocks = (count + rows_per_block - 1) / rows_per_block;
  std::vector<RowSums<dim>> sums(blocks);
#pragma omp parallel for schedule(static) if (blocks > 1)
  for (std::int64_t b = 0; b < static_cast<std::int64_t>(blocks); ++b) {
    const std::size_t begin = static_cast<std::size_t>(b) * rows_per_block;
    const std::size_t row = first + begin;
    advance<dim>(step, std::min(rows_per_block, count - begin), &mass_[row], force_.at(row),
                 moved_.empty() ? nullptr : prescribed_.at(begin), velocity_.at(row),
                 displacement_.at(row), sums[static_cast<std::size_t>(b)]);
  }
  sums_ = {};
  for (const RowSums<dim>& of_patch : patch_sums_)
    sums_ += of_patch;
  for (const RowSums<dim>& of_block : sums)
    sums_ += of_block;
}

/// Of the laws of total strain the energy is that of the displacements, u^n = u^(n+1) - v dt.
template <int dim> Energies Engine<dim>::energies() const {
  ElementWork work = element_work_;
  Rows<dim> u = displacement_;
  for (std::size_t row = 0; row < u.size(); ++row)
    u[row] -= time_step_ * velocity_[row];
  const PatchMotion<dim> motion{reference_, u, velocity_, time_step_};
  const auto num_patches = static_cast<std::int64_t>(patches_.patches.size());
  std::vector<ElementWork> of_patches(patches_.patches.size());
#pragma omp parallel if (num_patches > 1)
  {
    PatchScratch<dim> scratch(patches_);
#pragma omp for schedule(static)
    for (std::int64_t p = 0; p < num_patches; ++p) {
      const Patch& patch = patches_.patches[static_cast<std::size_t>(p)];
      const GroupKernel& group = groups_[patch.group];
      if (!group.increments) // which computing the energy does not change
        of_patches[static_cast<std::size_t>(p)] = compute_patch<dim>(
            patches_, patch, const_cast<GroupKernel&>(group), motion, Wanted::energy, scratch);
    }
  }
  for (const ElementWork& of_patch : of_patches) {
    work.internal += of_patch.internal;
    work.hourglass += of_patch.hourglass;
  }
  return {.kinetic = sums_.kinetic,
          .elastic = work.internal - work.dissipated,
          .dissipated = work.dissipated,
          .hourglass = work.hourglass,
          .damped = damped_work_.at_step() + work.viscous,
          .external_work = external_work_.at_step(),
          .interface_work = interface_work_.at_step()};
}

template <int dim> bool Engine<dim>::is_held(std::uint32_t row, int component) const {
  return boundary_.is_prescribed(patches_.node_of_row[row], component);
}

/// Time over which the forces of this step change the velocities: v^(1/2) = v^0 + a dt/2.
template <int dim> double Engine<dim>::span_of_step() const {
  return step_ == 0 ? 0.5 * time_step_ : time_step_;
}

/// Adds a force to a row that has been advanced, which gives it another velocity. Damping stays
/// what it was before.
template <int dim>
void Engine<dim>::push(std::uint32_t row, const Vec<dim>& before, const Vec<dim>& after,
                       const Vec<dim>& force) {
  const double m = mass_[row], span = span_of_step();
  const Vec<dim> old = velocity_[row], change = after - old, gravity = m * settings_.gravity;
  const Vec<dim> resisted = force_[row] + gravity - m / span * (old - before); // N, by damping
  velocity_[row] = after;
  displacement_[row] += time_step_ * change;
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
      sums_.damped.after += 0.5 * time_step_ * resisted[i] * change[i];
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
    const Vec<dim> old = velocity_[row];
    driving = support_[k] + Eigen::Map<const Vec<dim>>(&incoming[k * dim]);
    const double D = mass_[row] / span_of_step();
    Matrix A = D * Matrix::Identity() + 0.5 * damper;
    Vec<dim> b = D * old - 0.5 * damper * before + driving;
    for (int i = 0; i < dim; ++i)
      if (is_held(row, i)) {
        A.row(i) = Vec<dim>::Unit(i).transpose();
        b[i] = old[i];
      }
    const Vec<dim> after = A.inverse() * b;
    resisting = 0.5 * damper * (before + after);
    push(row, before, after, driving - resisting);
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

template void Engine<2>::compute_own_forces();
template void Engine<3>::compute_own_forces();
template void Engine<2>::own_forces(std::span<const std::uint32_t>, std::span<double>) const;
template void Engine<3>::own_forces(std::span<const std::uint32_t>, std::span<double>) const;
template void Engine<2>::add_interface_forces(std::span<const std::uint32_t>,
                                              std::span<const double>);
template void Engine<3>::add_interface_forces(std::span<const std::uint32_t>,
                                              std::span<const double>);
template void Engine<2>::integrate();
template void Engine<3>::integrate();
template Energies Engine<2>::energies() const;
template Energies Engine<3>::energies() const;

} // namespace kerf::fem
