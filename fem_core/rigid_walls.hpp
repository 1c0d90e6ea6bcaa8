// Rigid planes that nodes do not pass.
#pragma once

#include "fem_core/mesh.hpp"
#include "fem_core/settings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::fem {

template <int dim> class RigidWalls {
public:
  RigidWalls() = default;
  /// @throws InputError for an unknown tag, a normal of no length, or a negative friction
  RigidWalls(const Mesh<dim>& mesh, std::vector<WallSetting<dim>> settings);

  std::size_t size() const { return settings_.size(); }
  /// Those that a wall holds back, ascending.
  std::span<const std::uint32_t> nodes(std::size_t wall) const { return nodes_[wall]; }

  /// What a wall adds to the velocity of a node, so that it does not lie behind the wall at the end
  /// of the step: the impulse of a contact without rebound, and of friction, which takes at most
  /// what the node slides.
  ///
  /// @param position, velocity  at the end of the step, m, and of the step, m/s
  /// @param end                 time of the end of the step, s
  Vec<dim> impulse(std::size_t wall, const Vec<dim>& position, const Vec<dim>& velocity, double end,
                   double time_step) const;

private:
  std::vector<WallSetting<dim>> settings_;
  std::vector<std::vector<std::uint32_t>> nodes_;
};

} // namespace kerf::fem
