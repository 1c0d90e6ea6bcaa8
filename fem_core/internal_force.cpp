#include "fem_core/internal_force.hpp"

#include "common/instruction_set.hpp"

#include <algorithm>
#include <cstring>

namespace kerf {

namespace baseline {
fem::PatchKernel kernel_of(const fem::KernelKey& key);
}
namespace avx2 {
fem::PatchKernel kernel_of(const fem::KernelKey& key);
}
namespace avx512 {
fem::PatchKernel kernel_of(const fem::KernelKey& key);
}

namespace fem {
namespace {

/// Copies the rows of a patch, own ones first.
template <int dim, class Value>
void copy_rows(const Patches& patches, const Patch& patch, Value value, Rows<dim>& to) {
  for (std::uint32_t k = 0; k < patch.num_own; ++k)
    value(patch.first_row + k, to.at(k));
  for (std::uint32_t k = 0; k < patch.num_shared; ++k)
    value(patches.shared[patch.first_shared + k], to.at(patch.num_own + k));
}

/// The part of an array of a group that belongs to a patch; null when there is no array.
template <class Number> auto* part(Number& array, std::size_t per_batch, const Patch& patch) {
  return array.empty() ? nullptr : array.data() + patch.first_batch * per_batch;
}

/// The part of an array of rows.
template <int dim> Ahead part(const Rows<dim>& rows, std::size_t first, std::size_t count) {
  return {rows.at(first), count * sizeof(Row<dim>)};
}

} // namespace

template <int dim> PatchScratch<dim>::PatchScratch(const Patches& patches) {
  std::size_t most = 0;
  for (const Patch& patch : patches.patches)
    most = std::max<std::size_t>(most, patch.num_rows());
  for (Rows<dim>* rows : {&reference, &motion, &force})
    rows->resize(most);
  dilatation.resize(most);
}

template <int dim>
ElementWork compute_patch(const Patches& patches, const Patch& patch, GroupKernel& group,
                          const PatchMotion<dim>& motion, Wanted wanted,
                          PatchScratch<dim>& scratch) {
  constexpr std::size_t size = sizeof(Row<dim>);
  const bool rate = group.kinematics == Kinematics::rate;
  const double* reference = motion.reference.at(patch.first_copy);
  if (rate) {
    const double* const X = reference;
    copy_rows(
        patches, patch,
        [&](std::uint32_t row, double* to) {
          const std::size_t k = (to - scratch.reference.data());
          for (int i = 0; i < row_size<dim>; ++i)
            to[i] = X[k + i] + motion.displacement.at(row)[i];
        },
        scratch.reference);
    reference = scratch.reference.data();
  }
  const Rows<dim>& moved = rate || group.increments ? motion.velocity : motion.displacement;
  copy_rows(
      patches, patch, [&](std::uint32_t row, double* to) { std::memcpy(to, moved.at(row), size); },
      scratch.motion);
  if (!group.dilatation.empty() && wanted != Wanted::dilatation) {
    std::copy_n(group.dilatation.data() + patch.first_row, patch.num_own,
                scratch.dilatation.data());
    for (std::uint32_t k = 0; k < patch.num_shared; ++k)
      scratch.dilatation[patch.num_own + k] =
          group.dilatation[patches.shared[patch.first_shared + k]];
  }
  std::memset(scratch.force.data(), 0, patch.num_rows() * size);

  const Shape shape = patches.groups[patch.group].shape;
  const auto corners = static_cast<std::size_t>(nodes_of(shape)) * batch_size;
  const std::size_t batches = patches.num_batches(patch.group);
  const auto per_batch = [&](const std::vector<double>& array) { return array.size() / batches; };
  PatchView view{
      .num_elements = patch.num_elements,
      .nodes = patches.nodes[patch.group].data() + patch.first_batch * corners,
      .reference = reference,
      .motion = scratch.motion.data(),
      .motion_scale = rate || group.increments ? motion.time_step : 1.0,
      .force = scratch.force.data(),
      .alpha = part(group.alpha, per_batch(group.alpha), patch),
      .length = part(group.length, per_batch(group.length), patch),
      .dilatation = scratch.dilatation.data(),
      .stress = part(group.stress, per_batch(group.stress), patch),
      .history = part(group.history, per_batch(group.history), patch),
      .hourglass = part(group.hourglass, per_batch(group.hourglass), patch),
      .time_step = motion.time_step,
      .wants_energy = wanted == Wanted::energy,
      .law = group.law,
      .moduli = group.moduli,
      .constants = group.constants,
      .ahead = {},
      .work = {},
  };
  if constexpr (dim == 3) // in 2D it costs as much as it gains
    if (const Patch* const next = &patch + 1;
        next < patches.patches.data() + patches.patches.size()) {
      view.ahead[0] = part(motion.reference, next->first_copy, next->num_rows());
      view.ahead[1] = part(motion.displacement, next->first_row, next->num_own);
      view.ahead[2] = part(motion.velocity, next->first_row, next->num_own);
    }
  (wanted == Wanted::dilatation ? group.compute_dilatation : group.compute)(view);
  return view.work;
}

PatchKernel find_kernel(const KernelKey& key) {
  return dispatch(baseline::kernel_of, avx2::kernel_of, avx512::kernel_of)(key);
}

template class PatchScratch<2>;
template class PatchScratch<3>;
template ElementWork compute_patch(const Patches&, const Patch&, GroupKernel&,
                                   const PatchMotion<2>&, Wanted, PatchScratch<2>&);
template ElementWork compute_patch(const Patches&, const Patch&, GroupKernel&,
                                   const PatchMotion<3>&, Wanted, PatchScratch<3>&);

} // namespace fem
} // namespace kerf
