// Prescribed motion: which components of which particles, and how fast they move.
#pragma once

#include "dem_core/settings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::dem {

/// The motion that one particle is given.
template <int dim> struct PrescribedMotion {
  std::uint8_t components = 0;          // bit a: the velocity along axis a; bit dim: no rotation
  Vec<dim> velocity = Vec<dim>::Zero(); // v^(n+1/2) of the last advance(), m/s
  Vec<dim> velocity_before = Vec<dim>::Zero(); // v^(n-1/2) that the last integrate() found, m/s

  bool prescribes(int component) const noexcept { return (components >> component & 1u) != 0; }
  bool holds_rotation() const noexcept { return prescribes(dim); }
};

template <int dim> class Boundary {
public:
  /// @param begin  step from which the motions count their time
  Boundary(std::vector<Prescription<dim>> prescriptions, std::span<const Vec<dim>> reference,
           std::uint64_t begin = 0);

  bool prescribes(std::size_t i, int component) const noexcept {
    const PrescribedMotion<dim>* motion = of(i);
    return motion != nullptr && motion->prescribes(component);
  }
  bool holds_rotation(std::size_t i) const noexcept { return prescribes(i, dim); }

  /// Particles with a prescribed component, ascending.
  std::span<const std::uint32_t> particles() const noexcept { return particles_; }

  /// The motion of particle i, or null.
  const PrescribedMotion<dim>* of(std::size_t i) const noexcept {
    return entry_.empty() || entry_[i] == 0 ? nullptr : &motion_[entry_[i] - 1];
  }
  PrescribedMotion<dim>* of(std::size_t i) noexcept {
    return entry_.empty() || entry_[i] == 0 ? nullptr : &motion_[entry_[i] - 1];
  }

  /// Makes the velocities those of the step from t_n to t_(n+1), so that positions come out exact.
  void advance(std::uint64_t step, double time_step);

private:
  friend struct StateParts;

  std::vector<Prescription<dim>> prescriptions_;
  std::uint64_t begin_ = 0;                          // step
  std::vector<std::vector<std::uint32_t>> selected_; // particles of each prescription
  std::vector<std::uint32_t> particles_;
  std::vector<PrescribedMotion<dim>> motion_; // of each of particles_
  std::vector<std::uint32_t> entry_;          // [n] of motion_, from 1; 0: free; empty: all are
};

} // namespace kerf::dem
