// Boundaries: nodes whose motion is prescribed.
#pragma once

#include "fem_core/mesh.hpp"
#include "fem_core/settings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::fem {

/// One prescribed component of a node.
struct Prescribed {
  std::uint32_t node;
  int component;
};

/// The prescribed motion of a body, in displacements since the start. Where two settings meet in
/// one component of a node, the later one counts. A step n goes from t_n = n dt to t_(n+1), with
/// the velocity that makes the displacements exact.
template <int dim> class Boundary {
public:
  /// @throws InputError for an unknown tag, a setting that selects no node or no component, or
  ///         a duration that is not positive
  Boundary(const Mesh<dim>& mesh, std::vector<BoundarySetting<dim>> settings);

  /// Ascending by node, then by component.
  std::span<const Prescribed> entries() const { return entries_; }
  bool is_prescribed(std::uint32_t node, int component) const {
    return setting_of_[std::size_t{node} * dim + component] != none;
  }

  /// Displacement at t_n since the start, m.
  double displacement(std::uint32_t node, int component, std::int64_t n, double time_step) const;
  /// Velocity from t_n to t_(n+1), m/s.
  double velocity(std::uint32_t node, int component, std::int64_t n, double time_step) const;

  /// The setting that prescribes a component.
  std::size_t setting_of(const Prescribed& entry) const {
    return setting_of_[std::size_t{entry.node} * dim + static_cast<std::size_t>(entry.component)];
  }

private:
  static constexpr std::uint32_t none = 0xffffffff;

  std::vector<BoundarySetting<dim>> settings_;
  std::vector<std::uint32_t> setting_of_; // [num_nodes][dim]
  std::vector<Prescribed> entries_;
};

} // namespace kerf::fem
