// Prescribed motion: which components of which particles, and how fast they move.
#pragma once

#include "dem_core/settings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::dem {

/// The motion that one particle is given.
template <int dim> struct PrescribedMotion {
  std::uint8_t components = 0;          // bit a: the velocity along axis a; bit dim: the rotation
  Vec<dim> velocity = Vec<dim>::Zero(); // v^(n+1/2) of the last advance(), m/s
  Rot<dim> angular_velocity = Rot<dim>::Zero();        // likewise, rad/s
  Vec<dim> velocity_before = Vec<dim>::Zero();         // v^(n-1/2) that integrate() found, m/s
  Rot<dim> angular_velocity_before = Rot<dim>::Zero(); // likewise, rad/s

  bool prescribes(int component) const noexcept { return (components >> component & 1u) != 0; }
  bool holds_rotation() const noexcept { return prescribes(dim); }
};

/// The particles of one prescription, and what it prescribes to each: where two prescriptions meet
/// in one component, it is the later one's.
struct PrescribedSet {
  std::vector<std::uint32_t> particles; // ascending
  std::vector<std::uint8_t> components; // of each particle, as in PrescribedMotion
};

template <int dim> class Boundary {
public:
  /// @param begin  step from which the motions count their time
  /// @throws std::invalid_argument when the axis of a rotation has no length
  Boundary(std::vector<Prescription<dim>> prescriptions, std::span<const Vec<dim>> reference,
           std::uint64_t begin = 0);

  bool prescribes(std::size_t i, int component) const noexcept {
    const PrescribedMotion<dim>* motion = of(i);
    return motion != nullptr && motion->prescribes(component);
  }
  bool holds_rotation(std::size_t i) const noexcept { return prescribes(i, dim); }

  /// One for each prescription.
  std::span<const PrescribedSet> sets() const noexcept { return sets_; }

  /// The motion of particle i, or null.
  const PrescribedMotion<dim>* of(std::size_t i) const noexcept {
    return entry_.empty() || entry_[i] == 0 ? nullptr : &motion_[entry_[i] - 1];
  }
  PrescribedMotion<dim>* of(std::size_t i) noexcept {
    return entry_.empty() || entry_[i] == 0 ? nullptr : &motion_[entry_[i] - 1];
  }

  /// Takes over all components of particles that somebody else moves, through of().
  /// @param particles  [n] how many there are
  void carry(std::span<const std::uint32_t> carried, std::size_t particles);

  /// Makes the velocities those of the step from t_n to t_(n+1), so that positions come out exact.
  void advance(std::uint64_t step, double time_step);

private:
  friend struct StateParts;

  std::vector<Prescription<dim>> prescriptions_;
  std::uint64_t begin_ = 0; // step
  std::vector<PrescribedSet> sets_;
  std::vector<PrescribedMotion<dim>> motion_; // of each particle with a prescribed component
  std::vector<std::uint32_t> entry_;          // [n] of motion_, from 1; 0: free; empty: all are
};

} // namespace kerf::dem
