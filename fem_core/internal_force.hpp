// Internal forces of the elements, patch by patch; Rojek (2008) eqs 23, 24 and 44.
#pragma once

#include "fem_core/patches.hpp"
#include "fem_core/rows.hpp"

#include <algorithm>
#include <memory>
#include <vector>

namespace kerf::fem {

/// What the kernels are told of a group of elements.
struct GroupKernel {
  PatchKernel compute = nullptr;
  Kinematics kinematics = Kinematics::small;
  bool increments = false; // the law takes increments of strain, and its stress is stored
  int points = 1;          // of each element
  PointLaw law = {.parameters = nullptr, .respond = nullptr, .history = 0};
  std::shared_ptr<const void> parameters; // of the law
  Moduli moduli = {};
  ElementConstants constants = {};

  // Arrays of the group as PatchView has them; empty where there is nothing of the kind.
  std::vector<double> alpha, volume, length;
  PatchKernel compute_dilatation = nullptr;       // of nodal_pressure
  std::vector<double> dilatation;                 // [num_rows]
  std::vector<double> stress, history, hourglass; // change in every step
  std::vector<double> initial_history;

  void start() {
    std::fill(stress.begin(), stress.end(), 0.0);
    std::fill(hourglass.begin(), hourglass.end(), 0.0);
    history = initial_history;
  }
};

/// Motion of the nodes as the kernels need it.
template <int dim> struct PatchMotion {
  const Rows<dim>& reference;    // [Patches::num_copies()] X of the rows of every patch, m
  const Rows<dim>& displacement; // u^n, m
  const Rows<dim>& velocity;     // v^(n-1/2), m/s
  double time_step;              // from v, s; 0: there was no increment
};

/// Rows of one patch, one copy a thread.
template <int dim> class PatchScratch {
public:
  /// Sizes for the largest patch.
  explicit PatchScratch(const Patches& patches);

  Rows<dim> reference, motion, force;
  std::vector<double> dilatation;
};

/// What compute_patch() puts into scratch.force, own rows first.
enum class Wanted {
  force,      // -F^int; stress and history are followed
  energy,     // the same, but nothing is followed, and work.internal is the energy at u
  dilatation, // of the nodes of nodal_pressure: dilatation times volume, then volume
};

template <int dim>
ElementWork compute_patch(const Patches& patches, const Patch& patch, GroupKernel& group,
                          const PatchMotion<dim>& motion, Wanted wanted,
                          PatchScratch<dim>& scratch);

/// The kernel of this machine's instructions; null when there is none of the kind.
PatchKernel find_kernel(const KernelKey& key);

} // namespace kerf::fem
