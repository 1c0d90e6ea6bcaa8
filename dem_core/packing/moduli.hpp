// Elastic moduli and density of a bonded packing.
#pragma once

#include "dem_core/neighbours.hpp"

#include <cstddef>

namespace kerf::dem {

inline constexpr int strains(int dim) {
  return dim == 2 ? 3 : 6;
}

/// In 2D per metre of thickness.
template <int dim> struct Moduli {
  /// Stress over strain, Pa: xx yy xy in 2D, xx yy zz yz xz xy in 3D, shear strains doubled.
  Eigen::Matrix<double, strains(dim), strains(dim)> stiffness;
  double C11 = 0.0, C12 = 0.0, C66 = 0.0; // means over the axes, Pa
  double isotropy = 0.0;                  // 2 C66 / (C11 - C12), one of an isotropic solid
  double coordination_number = 0.0;       // 2 bonds / particles
  double bulk_density_factor = 0.0;       // bulk density over that of the particles: 1 - porosity
  std::size_t measured_particles = 0;     // with a closed cell
};

/// Stretches the packing: the outermost particles follow a homogeneous strain without turning, all
/// others move and turn into equilibrium. Stress, volume and density are those of the particles
/// with a closed power cell: sum of arm x force over their bonds, over the volume of the cells.
///
/// @param bonds                 pairs of particles, ascending
/// @param normal_stiffness      k_n of every bond, N/m
/// @param tangential_stiffness  k_t of every bond, N/m
/// @throws std::invalid_argument when a bond joins particles with the same centre, no cell is
/// closed,
///         or there is no equilibrium because the bonds do not hold the particles
template <int dim>
Moduli<dim> moduli(std::span<const Vec<dim>> position, std::span<const double> radius,
                   std::span<const Pair> bonds, double normal_stiffness,
                   double tangential_stiffness);

} // namespace kerf::dem
