// One step of the engine: what the forces do to the nodes, and its books.
#include "fem_core/engine.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::fem {
namespace {

constexpr std::size_t rows_per_block = 1024;

} // namespace

template <int dim> StepSettings<dim> Engine<dim>::step_settings() const {
  return {.time_step = time_step_,
          .first = step_ == 0,
          .gravity = settings_.gravity,
          .mass_damping = settings_.mass_damping,
          .local_damping = settings_.local_damping,
          .stop = stops()};
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
        boundary_.velocity(moved.node, moved.component, step_ - moved_since_, time_step_);
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
  double external2 = settings_.gravity.squaredNorm() * squared_masses_;
  Work external, of_interface;
  reactions_.assign(settings_.boundary.size(), Vec<dim>::Zero());
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    const Moved& moved = moved_[k];
    const double after = velocity_[moved.row][moved.component];
    const double reaction = mass_[moved.row] * (after - moved_before[k]) / time_step_ -
                            weight(moved.row)[moved.component] -
                            force_[moved.row][moved.component]; // N
    external2 += reaction * reaction;
    reactions_[boundary_.setting_of({moved.node, moved.component})][moved.component] += reaction;
    external += {.before = 0.5 * time_step_ * reaction * moved_before[k],
                 .after = 0.5 * time_step_ * reaction * after};
    displacement_[moved.row][moved.component] =
        initial_displacement_[k] +
        boundary_.displacement(moved.node, moved.component, step_ - moved_since_ + 1, time_step_);
  }
  for (const auto& [row, before, driving, resisting] : pushed) {
    const Vec<dim> half_way = 0.5 * time_step_ * before,
                   other_half = 0.5 * time_step_ * velocity_[row];
    external += {.before = driving.dot(half_way), .after = driving.dot(other_half)};
    external2 += driving.squaredNorm();
    sums_.damped += {.before = resisting.dot(half_way), .after = resisting.dot(other_half)};
  }
  for (std::size_t k = 0; k < interface_rows_.size(); ++k) {
    const Vec<dim> f = interface_force_[interface_rows_[k]];
    external2 += f.squaredNorm();
    of_interface += {.before = 0.5 * time_step_ * f.dot(interface_before[k]),
                     .after = 0.5 * time_step_ * f.dot(velocity_[interface_rows_[k]])};
  }
  external += sums_.gravity;
  external_work_.add(external, first);
  interface_work_.add(of_interface, first);
  damped_work_.add(sums_.damped, first);
  forces_are_current_ = false;
  finish_step(external2);
  ++step_;
}

/// How far the body is from rest, and whether it passed a peak of its kinetic energy. Less than a
/// tenth below the peak may be a fast motion beside a slow one that still gains speed.
template <int dim> void Engine<dim>::finish_step(double external2) {
  const double unbalanced2 = std::max(0.0, sums_.unbalanced2), all = unbalanced2 + external2;
  unbalanced_force_ = all > 0.0 ? std::sqrt(unbalanced2 / all) : 0.0;
  if (stops()) {
    peak_ = {};
    return;
  }
  peak_.energy = std::max(peak_.energy, sums_.kinetic);
  peak_.passed = sums_.kinetic < 0.9 * peak_.energy;
}

/// Of the plain rows, by patches as when those finish them.
template <int dim> void Engine<dim>::advance_plain() {
  const StepSettings<dim> step = step_settings();
  const auto num_patches = static_cast<std::int64_t>(patches_.patches.size());
  patch_sums_.assign(patches_.patches.size(), {});
#pragma omp parallel for schedule(static) if (num_patches > 1)
  for (std::int64_t p = 0; p < num_patches; ++p) {
    const Patch& patch = patches_.patches[static_cast<std::size_t>(p)];
    advance<dim>(step, patch.num_own, mass_.data() + patch.first_row, weighed(patch.first_row),
                 force_.at(patch.first_row), nullptr, velocity_.at(patch.first_row),
                 displacement_.at(patch.first_row), patch_sums_[static_cast<std::size_t>(p)]);
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
    advance<dim>(step, std::min(rows_per_block, count - begin), &mass_[row], weighed(row),
                 force_.at(row), moved_.empty() ? nullptr : prescribed_.at(begin),
                 velocity_.at(row), displacement_.at(row), sums[static_cast<std::size_t>(b)]);
  }
  sums_ = {};
  for (const RowSums<dim>& of_patch : patch_sums_)
    sums_ += of_patch;
  for (const RowSums<dim>& of_block : sums)
    sums_ += of_block;
}

template StepSettings<2> Engine<2>::step_settings() const;
template StepSettings<3> Engine<3>::step_settings() const;
template void Engine<2>::integrate();
template void Engine<3>::integrate();
template void Engine<2>::advance_plain();
template void Engine<3>::advance_plain();

} // namespace kerf::fem
