// Forces of all contacts: the bonded linear law, its breakage, and the friction that remains.
#pragma once

#include "dem_core/contact.hpp"

#include <span>
#include <vector>

namespace kerf::dem {

/// How far every particle has moved and turned since the forces were last computed: scale times
/// the two fields, which are velocities with scale = dt, or displacements with scale = 1.
template <int dim> struct Increment {
  std::span<const Vec<dim>> translation; // [n]
  std::span<const Rot<dim>> rotation;    // [n]
  double scale = 1.0;
};

/// Forces on every particle.
template <int dim> struct Loads {
  std::vector<Vec<dim>> force;           // own resultant: contacts and damping, N
  std::vector<Rot<dim>> moment;          // own resultant, N m
  std::vector<Vec<dim>> damping_force;   // its part that is damping, N; empty without damping
  std::vector<Rot<dim>> damping_moment;  // N m; empty without damping
  std::vector<Vec<dim>> interface_force; // from outside, N
};

/// Brings every contact to the current positions and writes its force and couple.
///
/// Normal force F_n = k_n u_n (Rojek (2008) eq. 12). The tangential force is carried along with
/// the contact and grows by k_t times the tangential displacement of the points of contact during
/// the increment (eq. 13), seen from the first particle. A bond is lost at once, in both parts,
/// when F_n > R_n (eq. 14) or |F_T| > R_t (eq. 15), without weights; then only compression and
/// Coulomb friction |F_T| <= mu |F_n| remain. The loss of energy of a step is the mean force times
/// the slip that is not elastic, which is exact for the trapezoidal work of the scheme.
/// @pre no two centres of a pair coincide
template <int dim>
void update_contacts(Contacts<dim>& contacts, const Particles<dim>& particles,
                     const Increment<dim>& increment, ShearIncrement rule, double friction);

/// Sums forces and moments of the contacts on every particle, in the order of the contacts.
template <int dim> void gather_contacts(const Contacts<dim>& contacts, Loads<dim>& loads);

} // namespace kerf::dem
