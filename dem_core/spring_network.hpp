// Particles joined by springs at their contacts, for small displacements and rotations.
#pragma once

#include "dem_core/contact_forces.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace kerf::dem {

/// Between two particles, or between one and the ground.
template <int dim> struct Spring {
  static constexpr std::uint32_t ground = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t first = 0, second = ground;
  Vec<dim> branch = Vec<dim>::Zero(); // from the first centre to the second, or to the ground, m
  double share = 1.0;                 // of the branch that is arm of the first
  double k_n = 0.0, k_t = 0.0;        // N/m

  /// Force on the first when the second end moves by this past the first one, N.
  Vec<dim> force(const Vec<dim>& opening) const {
    return k_t * opening + (k_n - k_t) * (branch.dot(opening) / branch.squaredNorm()) * branch;
  }
};

template <int dim> class SpringNetwork {
public:
  static constexpr int unknowns = dim + rotations<dim>; // of a particle: moves, then turns

  /// @param is_held  [particles][unknowns] does not move
  SpringNetwork(std::vector<Spring<dim>> springs, std::vector<std::uint8_t> is_held);

  std::span<const Spring<dim>> springs() const noexcept { return springs_; }

  /// Changes the forces by those of the displacements that bring free particles into equilibrium.
  /// @param force  [springs] on the first of each, N
  /// @param load   [particles] from outside
  /// @return the largest resultant that is left on a free particle, over the mean force of the
  ///         springs; moments count over the mean branch
  double equilibrate(std::span<Vec<dim>> force, std::span<const Load<dim>> load) const;

private:
  using Values = Eigen::VectorXd; // [particles * unknowns]

  void add_to_particles(const Spring<dim>& spring, const Vec<dim>& force, Values& resultant) const;
  Vec<dim> opening(const Spring<dim>& spring, const Values& x) const;
  void free_only(Values& values) const;
  Values resultant(std::span<const Vec<dim>> force, std::span<const Load<dim>> load) const;
  Values solve(const Values& load) const;

  std::vector<Spring<dim>> springs_;
  std::vector<std::uint8_t> is_held_;
  Values inverse_diagonal_;
};

} // namespace kerf::dem
