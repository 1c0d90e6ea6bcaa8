// Stress of particles: what their contacts carry.
#pragma once

#include "dem_core/contact.hpp"
#include "dem_core/particles.hpp"

#include <vector>

namespace kerf::dem {

template <int dim> using Matrix = Eigen::Matrix<double, dim, dim>;

/// A symmetric tensor by its components xx yy xy in 2D, xx yy zz yz xz xy in 3D.
template <int dim> using Symmetric = Eigen::Matrix<double, dim == 2 ? 3 : 6, 1>;

template <int dim> Symmetric<dim> symmetric_part(const Matrix<dim>& m) {
  if constexpr (dim == 2)
    return {m(0, 0), m(1, 1), 0.5 * (m(0, 1) + m(1, 0))};
  else
    return {m(0, 0),
            m(1, 1),
            m(2, 2),
            0.5 * (m(1, 2) + m(2, 1)),
            0.5 * (m(0, 2) + m(2, 0)),
            0.5 * (m(0, 1) + m(1, 0))};
}

/// Mean stress of each particle, 1 / V sum arm x force over its contacts, Pa; [n]. V is the volume
/// of the particle itself: a body of them has the mean stress times its solid fraction. The forces
/// are those without weight. The antisymmetric part, which turns the particle, is left out.
/// @see J. Christoffersen, M.M. Mehrabadi & S. Nemat-Nasser, J. Appl. Mech. 48 (1981) 339-344,
///      doi:10.1115/1.3157619
template <int dim>
std::vector<Symmetric<dim>> particle_stress(const Contacts<dim>& contacts,
                                            const Particles<dim>& particles);

} // namespace kerf::dem
