// Bonds under stress at the start, in equilibrium.
#pragma once

#include "dem_core/boundary.hpp"
#include "dem_core/contact_forces.hpp"
#include "dem_core/stress.hpp"
#include "dem_core/wall_contacts.hpp"

#include <cstddef>
#include <span>
#include <stdexcept>

namespace kerf::dem {

/// A stress that a body cannot have.
struct ImpossibleStress : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// What a body begins with.
template <int dim> struct InSituReport {
  Symmetric<dim> wanted = Symmetric<dim>::Zero(); // mean over the measured part of the body, Pa
  Symmetric<dim> found = Symmetric<dim>::Zero();  // the same of the contacts, Pa
  double bulk_density = 0.0;                      // of that part, kg/m³
  double unbalanced = 0.0;        // largest resultant of a particle over the mean contact force
  std::size_t bonds = 0;          // that carry it
  std::size_t wall_contacts = 0;  // likewise
  std::size_t open_contacts = 0;  // with tools, which would have to pull
  std::size_t without_stress = 0; // particles with too few bonds
};

/// Gives bonds and contacts with tools forces that have a stress and are in equilibrium with the
/// loads, by their stress-free lengths and shear forces. Nothing moves.
///
/// The forces are those of the network of springs under a strain that varies as the stress does.
/// What is prescribed, and tools, follow the strain; all else finds its equilibrium. The strain is
/// chosen so that the mean stress, and the mean of its gradient along gravity, are the wanted ones.
/// Both are taken over the cells of particles with neighbours on all sides, in a body that is
/// periodic along all axes over all of it. Contacts with tools have no friction and do not pull;
/// bonds have no moments.
///
/// @param load  [particles] at the start from outside, weight too
/// @throws ImpossibleStress when there are no bonds, there is no equilibrium, what holds the
///         body cannot carry the stress, or a bond is too weak for it
template <int dim>
InSituReport<dim> set_in_situ_stress(const InSituStress<dim>& stress, const Vec<dim>& gravity,
                                     std::span<const Load<dim>> load,
                                     const Particles<dim>& particles, const Boundary<dim>& boundary,
                                     const Period<dim>& period, Contacts<dim>& contacts,
                                     std::span<WallContacts<dim>> wall_contacts);

} // namespace kerf::dem
