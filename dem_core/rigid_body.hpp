// The motion of one free rigid body: central differences of its momentum and angular momentum.
#pragma once

#include "dem_core/orientation.hpp"

namespace kerf::dem {

/// Moment of inertia about the centre: one number in 2D, a tensor in 3D, kg m².
template <int dim> using Inertia = Eigen::Matrix<double, rotations<dim>, rotations<dim>>;

/// Turns a body for a time while nothing acts on it.
template <int dim> struct FreeTurn {
  Orientation<dim> turn; // what is added to the orientation, in space
  Rot<dim> mean_rate;    // the same as an angle over the time, rad/s
};

/// The midpoint rule for Euler's equations in the frame of the body, with m the mean of the angular
/// momentum before and after,
///
///     pi' - pi = dt m x J^-1 m,    R' = R cay(dt J^-1 m),
///
/// keeps the angular momentum in space, R pi = L, and the energy of rotation to round-off, and is
/// of second order. @see J.C. Simo & K.K. Wong, Int. J. Numer. Methods Eng. 31 (1991) 19-52,
/// doi:10.1002/nme.1620310103
///
/// @param inertia           in the frame of the body, kg m²
/// @param orientation       at the start
/// @param angular_momentum  in space, kg m²/s
/// @param time              s
template <int dim>
FreeTurn<dim> free_turn(const Inertia<dim>& inertia, const Orientation<dim>& orientation,
                        const Rot<dim>& angular_momentum, double time);

template <>
FreeTurn<2> free_turn<2>(const Inertia<2>&, const Orientation<2>&, const Rot<2>&, double);
template <>
FreeTurn<3> free_turn<3>(const Inertia<3>&, const Orientation<3>&, const Rot<3>&, double);

/// A vector of rotation in space, from the one in the frame of the body, and back.
template <int dim> Rot<dim> to_space(const Orientation<dim>& orientation, const Rot<dim>& v) {
  if constexpr (dim == 2)
    return v;
  else
    return orientation.turned(v);
}
template <int dim> Rot<dim> to_body(const Orientation<dim>& orientation, const Rot<dim>& v) {
  if constexpr (dim == 2)
    return v;
  else
    return orientation.turned_back(v);
}

} // namespace kerf::dem
