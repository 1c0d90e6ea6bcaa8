// Random dense packings of discs (2D) or spheres (3D).
#pragma once

#include "dem_core/packing/radii.hpp"
#include "dem_core/packing/region.hpp"
#include "dem_core/packing/relaxation.hpp"

#include <cstdint>
#include <optional>

namespace kerf::dem {

/// Raised when the same settings give other particles than before: packings that were kept are then
/// made again.
inline constexpr int packing_version = 2;

struct PackingSettings {
  Radii radii;
  double porosity = 0.0; // 1 - sum of the particle volumes / volume of the region
  /// With a number of particles the law of the radii is scaled to reach the porosity; otherwise
  /// the number follows from it.
  std::optional<std::size_t> count;
  std::uint64_t seed = 1;
};

/// Fills a region: random places, from which the particles are moved until their overlaps are
/// least. All of each particle is inside the wall.
///
/// @throws std::invalid_argument when the porosity is not between zero and one, the radii are not
///         valid, there are no or more than 2^32 particles, a periodic axis is shorter than two
///         diameters, or the region is too narrow for a particle
template <int dim>
ParticleSet<dim> pack(const Region<dim>& region, const PackingSettings& settings);

/// How dense a packing is. Overlaps are divided by the sum of the two radii.
struct PackingMeasures {
  double porosity = 0.0;
  double mean_overlap = 0.0; // of the pairs that overlap
  double largest_overlap = 0.0;
  double coordination_number = 0.0; // 2 * pairs that touch (gap below 1e-3) / particles
};

/// @param volume  of the region, m³, in 2D m²
template <int dim>
PackingMeasures measure(const ParticleSet<dim>& particles, double volume,
                        const Period<dim>& period);

/// Volume of a particle, m³; in 2D its area, m².
template <int dim> double particle_volume(double radius);

/// The particles whose centres are in a region.
template <int dim>
ParticleSet<dim> cut(const ParticleSet<dim>& particles, const Region<dim>& region);

} // namespace kerf::dem
