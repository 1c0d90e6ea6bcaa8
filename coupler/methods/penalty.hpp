// The penalty method: springs between particles and their material points in the mesh.
#pragma once

#include "coupler/methods/locate.hpp"

#include <span>
#include <vector>

namespace kerf::coupler {

/// How the penalty stiffness varies over the overlap.
enum class StiffnessProfile {
  blended, // 4 alpha (1 - alpha) kappa k_n: largest in the middle, none where a share vanishes
  uniform, // kappa k_n
};

/// Stiffness k_DF of each point, N/m.
///
/// @param alpha      [n] share of the elements at the particle's centre
/// @param stiffness  [n] normal stiffness k_n of the particle's contacts, N/m
/// @param ratio      kappa = k_DF / k_n
std::vector<double> penalty_stiffness(std::span<const double> alpha,
                                      std::span<const double> stiffness, double ratio,
                                      StiffnessProfile profile);

/// Constraint chi = x_D - N x_F - offset of each particle, Rojek (2008) eq. 39, m.
///
/// @param particles  [n][dim] positions x_D
/// @param nodes      [m][dim] positions x_F
/// @param offset     [n][dim] value of x_D - N x_F in the reference configuration: zero but for
///                   round-off and for the images of a periodic mesh
/// @param chi        [n][dim] receives the constraint
template <int dim>
void constraint(const Interpolation<dim>& N, std::span<const double> particles,
                std::span<const double> nodes, std::span<const double> offset,
                std::span<double> chi);

/// Forces of the penalty: -k chi on the particles and N^T k chi on the nodes, eq. 56.
///
/// @param chi             [n][dim] m
/// @param stiffness       [n] k_DF, N/m
/// @param particle_force  [n][dim] receives the force, N
/// @param node_force      [m][dim] receives the force, N
template <int dim>
void penalty_forces(const Interpolation<dim>& N, std::span<const double> chi,
                    std::span<const double> stiffness, std::span<double> particle_force,
                    std::span<double> node_force);

/// Largest share that the penalty adds to the eigenvalues of M^-1 K, per point, rad²/s².
///
/// Any theta > 0 gives (x - y)² <= (1 + theta) x² + (1 + 1/theta) y²: the spring of a point is
/// bounded by one to ground on each side. theta = m_D / m_F, with m_F the mass that the mesh
/// offers at the point, makes the bound exact for a single spring: k (1/m_D + 1/m_F).
///
/// @param particle_inverse_mass  [n][dim] blended, 1/kg; 0 where prescribed
/// @param node_inverse_mass      [m][dim] blended, 1/kg
/// @param particle_omega2        [n] receives the bound
/// @param node_omega2            [m] receives the bound
template <int dim>
void penalty_omega2(const Interpolation<dim>& N, std::span<const double> stiffness,
                    std::span<const double> particle_inverse_mass,
                    std::span<const double> node_inverse_mass, std::span<double> particle_omega2,
                    std::span<double> node_omega2);

} // namespace kerf::coupler
