// Prescribed motion: which components of which particles, and how fast they move.
#pragma once

#include "dem_core/settings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::dem {

template <int dim> class Boundary {
public:
  Boundary(std::vector<Prescription<dim>> prescriptions, std::span<const Vec<dim>> reference);

  /// Bit a: the velocity along axis a is prescribed; bit dim: all rotations are held at zero.
  std::uint8_t components(std::size_t i) const noexcept { return components_[i]; }
  bool prescribes(std::size_t i, int component) const noexcept {
    return (components_[i] >> component & 1u) != 0;
  }
  bool holds_rotation(std::size_t i) const noexcept { return prescribes(i, dim); }

  /// Particles with a prescribed component, ascending.
  std::span<const std::uint32_t> particles() const noexcept { return particles_; }

  /// Makes velocity() that of the step from t_n to t_(n+1), so that positions come out exact.
  void advance(std::uint64_t step, double time_step);

  /// v^(n+1/2) of the last advance(), m/s; meaningful in prescribed components only.
  const Vec<dim>& velocity(std::size_t i) const noexcept { return velocity_[i]; }

private:
  std::vector<Prescription<dim>> prescriptions_;
  std::vector<std::vector<std::uint32_t>> selected_; // particles of each prescription
  std::vector<std::uint8_t> components_;
  std::vector<std::uint32_t> particles_;
  std::vector<Vec<dim>> velocity_;
};

} // namespace kerf::dem
