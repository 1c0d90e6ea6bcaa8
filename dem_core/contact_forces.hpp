// Forces of all contacts: the bonded linear law, its breakage, and the friction that remains.
#pragma once

#include "dem_core/contact.hpp"
#include "dem_core/contact_view.hpp"

#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace kerf::dem {

/// How far every particle has moved and turned since the forces were last computed: scale times
/// the two fields, which are velocities with scale = dt, or displacements with scale = 1.
template <int dim> struct Increment {
  std::span<const Aligned<Vec<dim>>> translation; // [n]
  std::span<const Aligned<Rot<dim>>> rotation;    // [n]
  double scale = 1.0;
  double time = 0.0; // that it took, s; 0: none, and dashpots do not act
  /// The way of the farthest particle of every step so far, summed up, m: pairs that are apart are
  /// not looked at before two particles can have closed their gap. Nan: not known.
  double travelled = std::numeric_limits<double>::quiet_NaN();
};

/// Force in N and moment in N m on a particle: one cache line, or half of one in 2D.
template <int dim> struct alignas(dim == 2 ? 32 : 64) Load {
  Vec<dim> force = Vec<dim>::Zero();
  Rot<dim> moment = Rot<dim>::Zero();
};

/// Loads on every particle.
template <int dim> struct Loads {
  std::vector<Load<dim>> own;            // [n] contacts and damping; behind them rows that wait
  std::vector<Load<dim>> damping;        // [n] the part of own that is damping; empty without it
  std::vector<Vec<dim>> interface_force; // [n] from outside, N; empty until there is one
};

/// A bond that was lost.
template <int dim> struct Break {
  std::uint32_t contact = 0;
  BreakMode mode = BreakMode::tension;
  double energy = 0.0;                // that it had stored, J
  Vec<dim> place = Vec<dim>::Zero();  // the point of contact, m
  Vec<dim> normal = Vec<dim>::Zero(); // from the first to the second
};

/// Called for every block of particles when its forces are complete and nobody looks at its
/// particles any more: they may move. Several calls may run at once.
using BlockWork = std::function<void(std::size_t block)>;

/// Brings every contact to the current positions and puts what it does to the particles in
/// loads.own, each particle summed in the same order for any number of threads.
///
/// Normal force F_n = k_n u_n (Rojek (2008) eq. 12). The tangential force is carried along with
/// the contact and grows by k_t times the tangential displacement of the points of contact during
/// the increment (eq. 13), seen from the first particle. A bond is lost at once, in both parts,
/// when F_n > R_n (eq. 14) or |F_T| > R_t (eq. 15), without weights; then only compression and
/// Coulomb friction |F_T| <= mu |F_n| remain. The loss of energy of a step is the mean force times
/// the slip that is not elastic, which is exact for the trapezoidal work of the scheme.
///
/// With ContactLaw::linear_with_moments and hertz_mindlin dashpots add c_n du_n/dt and c_t ds/dt
/// while a contact carries, the tangential one while it does not slide, and a spring resists the
/// relative rotation of the particles: see contact_constants.hpp, contact_laws.hpp.
/// @pre no two centres of a pair coincide
/// @param complete  what else there is to do for a block, while it is in the cache
/// @return the bonds that broke, ascending
template <int dim>
std::vector<Break<dim>> compute_contact_forces(Contacts<dim>& contacts,
                                               const Particles<dim>& particles,
                                               const Increment<dim>& increment, ShearIncrement rule,
                                               Loads<dim>& loads, const BlockWork& complete = {});

} // namespace kerf::dem
