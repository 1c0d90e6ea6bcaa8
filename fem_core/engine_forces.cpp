// The forces of a step, and the energies, which need the same passes over the elements.
#include "fem_core/engine.hpp"

#include <omp.h>

#include <algorithm>

namespace kerf::fem {

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
        advance<dim>(step, patch.num_own, &mass_[patch.first_row], weighed(patch.first_row),
                     scratch.force.data(), nullptr, velocity_.at(patch.first_row),
                     displacement_.at(patch.first_row), patch_sums_[k]);
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
  loads_.compute(static_cast<double>(step_ - loaded_since_) * time_step_, u, load_force_);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    force_[patches_.row_of_node[nodes[k]]] += Eigen::Map<const Vec<dim>>(&load_force_[k * dim]);
  for (std::size_t k = 0; k < support_.size(); ++k)
    force_[patches_.row_of_node[absorbing_.nodes()[k].node]] += support_[k];
}

template <int dim>
void Engine<dim>::own_forces(std::span<const std::uint32_t> nodes, std::span<double> force) const {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::uint32_t row = patches_.row_of_node[nodes[k]];
    const Vec<dim> sum = force_[row] + weight(row);
    std::copy_n(sum.data(), dim, &force[k * dim]);
  }
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

template void Engine<2>::compute_own_forces();
template void Engine<3>::compute_own_forces();
template void Engine<2>::compute_forces(bool);
template void Engine<3>::compute_forces(bool);
template void Engine<2>::own_forces(std::span<const std::uint32_t>, std::span<double>) const;
template void Engine<3>::own_forces(std::span<const std::uint32_t>, std::span<double>) const;
template void Engine<2>::add_interface_forces(std::span<const std::uint32_t>,
                                              std::span<const double>);
template void Engine<3>::add_interface_forces(std::span<const std::uint32_t>,
                                              std::span<const double>);
template Energies Engine<2>::energies() const;
template Energies Engine<3>::energies() const;

} // namespace kerf::fem
