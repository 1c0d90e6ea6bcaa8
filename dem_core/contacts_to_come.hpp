// Contacts that loose particles do not have yet, for a time step that will hold when they do.
#pragma once

#include "dem_core/boundary.hpp"
#include "dem_core/clusters.hpp"
#include "dem_core/contact.hpp"
#include "dem_core/materials.hpp"

#include <vector>

namespace kerf::dem {

/// What the critical step may come to be.
struct ContactsToCome {
  std::vector<double> particles; // row sum of M^-1 K, rad²/s²; 0 for those that have a bond
  std::vector<double> clusters;  // the same of free clusters
  double dashpot_time = 0.0;     // longest ratio of viscosity to stiffness, s
};

/// Row sums that particles without bonds would have among as many neighbours as can touch one of
/// their size: six discs of a triangular lattice, twelve spheres of an fcc lattice, or as many as
/// there are. Each contact has the stiffness of that with the largest particle; where it grows with
/// the overlap, at an overlap of a thousandth of the smaller radius. A cluster counts so many
/// contacts at its farthest point. It is an estimate: a particle can have more contacts with much
/// smaller ones, and be pressed harder.
template <int dim>
ContactsToCome contacts_to_come(const Materials& materials, const Contacts<dim>& contacts,
                                const Particles<dim>& particles, const Boundary<dim>& boundary,
                                const Clusters<dim>& clusters);

} // namespace kerf::dem
