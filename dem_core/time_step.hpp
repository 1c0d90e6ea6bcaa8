// The largest stable time step: a bound of the highest frequency that is never below it.
#pragma once

#include "dem_core/boundary.hpp"
#include "dem_core/clusters.hpp"
#include "dem_core/contact.hpp"
#include "dem_core/particles.hpp"
#include "dem_core/tool.hpp"
#include "dem_core/wall_contacts.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace kerf::dem {

/// Largest Gershgorin row sum of M^-1 K of one particle, rad²/s², over its translations and
/// rotations that are not prescribed. The largest of all particles bounds omega_max² from above,
/// so that 2 / sqrt of it never exceeds the critical step of Rojek (2008) eq. 10.
///
/// K is the stiffness of the contacts that carry force, at their current normals, with the weights
/// of contacts, masses and inertias. Rotations count as r theta with inertia I / r²: in radians
/// the bound would depend on the unit of length. Members of clusters are prescribed; a particle
/// that touches one moves against the cluster.
/// @see S. Gershgorin, Izv. Akad. Nauk SSSR, Otd. Mat. (1931) 749-754
template <int dim>
double row_sum(const Contacts<dim>& contacts, const Incidence& incidence,
               const Particles<dim>& particles, const Boundary<dim>& boundary,
               const Clusters<dim>& clusters, std::size_t i);

/// The same of every free cluster, rad²/s²; 0 of others. Its rotation counts as L theta, L being
/// its extent, with its least moment of inertia over L². Its contacts with tools count as in
/// wall_sums(), those to come with one for each member.
template <int dim>
std::vector<double> cluster_sums(const Contacts<dim>& contacts, const Particles<dim>& particles,
                                 const Clusters<dim>& clusters, std::span<const Tool<dim>> tools,
                                 std::span<const WallContacts<dim>> wall_contacts);

/// Longest ratio of viscosity to stiffness of the contacts that carry, s; 0 without dashpots.
template <int dim>
double dashpot_time(const Contacts<dim>& contacts, const Particles<dim>& particles);

/// Dashpots act with the velocity of half a step before and shorten the critical step to
/// 2 / omega (sqrt(1 + xi²) - xi), where xi is their share of critical damping: viscosities are at
/// most `time` times stiffnesses, so xi <= omega time / 2.
/// @return the omega² without dashpots that has this critical step, rad²/s²
/// @see T. Belytschko & T.J.R. Hughes (eds), Computational Methods for Transient Analysis (1983),
///      chapter 1
double with_dashpots(double omega2, double time);

/// What tools add to the row sum of every particle, rad²/s²; [n].
///
/// The stiffness of a contact with a tool that moves as told only concerns its particle. So it adds
/// to the largest eigenvalue no more than its own one, max(k_n / m, k_t (1 / m + r² / I)), whatever
/// its normal is. A free tool of mass M adds the sum of max(k_n, k_t) / M of all its contacts, its
/// rotation likewise, to every particle that it touches; so its own limit is counted, too. As tools
/// come to touch what they do not touch yet, every particle counts one contact more: that with the
/// stiffest of the other tools.
/// @see H. Weyl, Math. Ann. 71 (1912) 441-479, doi:10.1007/BF01456804
template <int dim>
std::vector<double> wall_sums(std::span<const Tool<dim>> tools,
                              std::span<const WallContacts<dim>> contacts,
                              const Particles<dim>& particles, const Boundary<dim>& boundary);

} // namespace kerf::dem
