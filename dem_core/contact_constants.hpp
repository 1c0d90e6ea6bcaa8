// The constants of every contact, from the materials and the sizes of its particles.
#pragma once

#include "dem_core/contact.hpp"
#include "dem_core/materials.hpp"

namespace kerf::dem {

/// Normal and tangential stiffness of a bond, and of a linear contact.
template <int dim> ContactStiffness bond_springs(const Mixture& mixture, double r_i, double r_j);

/// Sets every constant of the contacts but their weight: one number for all where they are equal.
/// What was bonded is linear. With r = min(r_i, r_j), R* = r_i r_j / (r_i + r_j) and m* likewise:
///
/// - stiffness from a contact modulus E_c: k_n = 4 E_c R*, in 2D k_n = E_c; k_t = ratio k_n;
/// - strengths from stresses: R = sigma A, A = pi (lambda r)², in 2D 2 lambda r; lambda is the bond
///   radius ratio, one where not given;
/// - Hertz-Mindlin: k_n = 4/3 E* sqrt(R*), k_t = 8 G* sqrt(R*), for particles of one material
///   E* = E / (2 (1 - nu²)), G* = E / (4 (1 + nu) (2 - nu)); others as Materials says;
/// - bonds with moments: k_b = k_n I / A and k_w = k_t J / A of their cross-section; the stress at
///   its edge is that of the force F_n + |M_b| A r / I, or |F_T| + |M_w| A r / J;
/// - rolling resistance of contacts without bond: k_b = k_t R*², bounded by mu_r R* |F_n|;
/// - dashpots from the coefficient of restitution e, beta = -ln e / sqrt(pi² + ln² e):
///   c = 2 beta sqrt(m* k), Hertz-Mindlin 2 sqrt(5/6) beta sqrt(m* k') with the stiffness of now.
/// @see D.O. Potyondy & P.A. Cundall, Int. J. Rock Mech. Min. Sci. 41 (2004) 1329,
///      doi:10.1016/j.ijrmms.2004.09.011; J. Ai et al., Powder Technol. 206 (2011) 269,
///      doi:10.1016/j.powtec.2010.09.030; T. Antypov & J.A. Elliott, EPL 94 (2011) 50004,
///      doi:10.1209/0295-5075/94/50004
template <int dim>
void set_constants(Contacts<dim>& contacts, const Particles<dim>& particles,
                   const Materials& materials);

/// Those of a contact without bond between two radii, as above.
struct PairConstants {
  bool is_hertzian = false;
  double normal_stiffness = 0.0, tangential_stiffness = 0.0, bending_stiffness = 0.0;
  double normal_viscosity = 0.0, tangential_viscosity = 0.0;
};
template <int dim>
PairConstants pair_constants(const Mixture& mixture, const std::array<double, 2>& density,
                             double r_i, double r_j);

} // namespace kerf::dem
