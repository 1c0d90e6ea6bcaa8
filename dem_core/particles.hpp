// The bodies of the model: discs (per metre of thickness) or spheres, their masses and motion.
#pragma once

#include "common/vec.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace kerf::dem {

/// The least share of the virtual work that a particle or a contact keeps: with less, the blended
/// mass goes to zero faster than the blended stiffness and the critical step with it.
inline constexpr double least_share = 0.05;

/// Share of the virtual work from 1 - alpha, which goes on linearly beyond the zone of blending.
inline double bounded_share(double weight) {
  return std::clamp(weight, least_share, 1.0);
}

/// A vector in an aligned row of its own, as the kernels load it: in 3D a fourth number fills it.
template <class Vector> struct Aligned : Vector {
  Aligned() : Vector(Vector::Zero()) {}
  template <class Other> Aligned(const Eigen::MatrixBase<Other>& other) : Vector(other) {}
  using Vector::operator=;
};
template <> struct alignas(32) Aligned<Vec<3>> : Vec<3> {
  Aligned() : Vec<3>(Vec<3>::Zero()) {}
  template <class Other> Aligned(const Eigen::MatrixBase<Other>& other) : Vec<3>(other) {}
  using Vec<3>::operator=;
  double fill = 0.0;
};

/// All arrays have one entry a particle. Positions are kept as reference + displacement, so that
/// small displacements lose no digits; they are never wrapped into a period.
template <int dim> struct Particles {
  std::vector<Vec<dim>> reference;    // m
  std::vector<double> radius;         // m
  std::vector<double> density;        // kg/m³
  std::vector<std::uint8_t> material; // of each, see Materials; empty: there is only one
  std::vector<std::uint32_t> ids;     // what the user calls them

  std::vector<std::uint32_t> cluster; // rigid body of each, from 1; 0: none; empty: there are none

  std::vector<double> weight;    // 1 - alpha at the centre, > 1 beyond the zone; empty: all are one
  std::vector<double> mass;      // blended, kg; pi r² rho or 4/3 pi r³ rho
  std::vector<double> true_mass; // kg; empty: mass is not scaled
  std::vector<double> inertia;   // blended, kg m²; m r² / 2 or 2/5 m r²

  std::vector<Aligned<Vec<dim>>> displacement; // u^n, m
  std::vector<Aligned<Vec<dim>>> velocity;     // v^(n-1/2), v^0 before the first step, m/s
  std::vector<Aligned<Rot<dim>>>
      angular_velocity; // omega^(n-1/2), omega^0 before the first step, rad/s

  std::size_t size() const noexcept { return radius.size(); }
  Vec<dim> position(std::size_t i) const { return reference[i] + displacement[i]; }
  double weighed_mass(std::size_t i) const { return true_mass.empty() ? mass[i] : true_mass[i]; }
  bool is_member(std::size_t i) const noexcept { return !cluster.empty() && cluster[i] != 0; }
};

/// Particles are worked on in blocks of a fixed size, never of the number of threads, so that sums
/// have the same bits for any number of them.
inline constexpr std::uint32_t particles_per_block = 1024;

inline std::size_t count_blocks(std::size_t particles) {
  return (particles + particles_per_block - 1) / particles_per_block;
}
struct ParticleBlock {
  std::size_t begin, end;
};
inline ParticleBlock particle_block(std::size_t block, std::size_t particles) {
  const std::size_t begin = block * particles_per_block;
  return {begin, std::min(particles, begin + particles_per_block)};
}

/// Area of a disc, m², or volume of a sphere, m³.
template <int dim> double volume_of_radius(double radius) {
  if constexpr (dim == 2)
    return std::numbers::pi * radius * radius;
  else
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

/// Particles at rest with weight one.
/// @param ids  [n] what the user calls them, in error messages too; empty: their index
/// @throws std::invalid_argument when there are none, the sizes differ, a coordinate is not
///         finite, or a radius or the density is not positive
template <int dim>
Particles<dim> make_particles(std::span<const Vec<dim>> positions, std::span<const double> radii,
                              double density, std::span<const std::uint32_t> ids = {});

/// Scales masses and moments of inertia by bounded_share().
/// @param weight  [n] 1 - alpha of each particle; empty: one everywhere
/// @throws std::invalid_argument when the size is wrong or a weight is negative or not finite
template <int dim> void blend(Particles<dim>& particles, std::span<const double> weight);

} // namespace kerf::dem
