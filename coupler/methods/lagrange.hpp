// The Lagrange multiplier method: forces that hold particles exactly to their material points.
#pragma once

#include "coupler/methods/locate.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <memory>
#include <span>
#include <vector>

namespace kerf::coupler {

/// Interface system of the multipliers, factorised once: S lambda = a, S = M_D^-1 + N M_F^-1 N^T.
///
/// This is Rojek (2008) eq. 52 with the accelerations eliminated instead of the multipliers
/// (eq. 53 gives the same motion), so that the broker needs masses and forces of interface points
/// only. Where a component is prescribed on a particle and on all its nodes there is nothing to
/// solve for: its multiplier is zero.
template <int dim> class LagrangeSystem {
public:
  /// @param particle_inverse_mass  [n][dim] blended, 1/kg; 0 where prescribed
  /// @param node_inverse_mass      [m][dim] blended, 1/kg; 0 where prescribed
  /// @throws std::runtime_error when S cannot be factorised
  LagrangeSystem(const Interpolation<dim>& N, std::span<const double> particle_inverse_mass,
                 std::span<const double> node_inverse_mass);

  /// Multipliers that change the relative acceleration of each particle to its point by -a.
  ///
  /// @param acceleration  [n][dim] relative acceleration to be taken away, m/s²
  /// @param lambda        [n][dim] receives the multipliers, N; -lambda acts on the particles,
  ///                      N^T lambda on the nodes
  void solve(std::span<const double> acceleration, std::span<double> lambda);

private:
  using Factor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;
  std::array<std::shared_ptr<Factor>, dim> factor_; // shared where components are alike
  std::array<std::vector<char>, dim> free_;         // [dim][n] rows that can move at all
  Eigen::VectorXd right_, solution_;
};

/// Forces of multipliers: -lambda on the particles, N^T lambda on the nodes, eq. 51.
///
/// @param lambda          [n][dim] N
/// @param particle_force  [n][dim] receives the force, N
/// @param node_force      [m][dim] receives the force, N
template <int dim>
void multiplier_forces(const Interpolation<dim>& N, std::span<const double> lambda,
                       std::span<double> particle_force, std::span<double> node_force);

} // namespace kerf::coupler
