// The engine: a finite element body that steps in time.
#pragma once

#include "common/state.hpp"
#include "fem_core/boundary.hpp"
#include "fem_core/elements.hpp"
#include "fem_core/energy.hpp"
#include "fem_core/mesh.hpp"
#include "fem_core/settings.hpp"
#include "fem_core/time_step.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kerf::fem {

/// An explicit finite element body of linear elastic quad4 or hex8 with small strain and lumped
/// mass. Points are its nodes; arrays of vectors are [n][dim]. Nodes without mass are inert: they
/// keep their place. The results have the same bits for any number of threads.
///
///     Engine<2> engine(make_box<2>({.size = …, .count = …}), {.material = …});
///     engine.start(0.8 * 2.0 / std::sqrt(engine.step_limit().omega2));
///     for (…) { engine.compute_own_forces(); engine.integrate(); }
template <int dim> class Engine {
public:
  /// @throws InputError, std::invalid_argument as its parts do
  Engine(Mesh<dim> mesh, Settings<dim> settings);

  /// Gives the share of the elements in the blended virtual work; before start().
  /// @param alpha  [num_nodes] from 0 to 1; empty: one everywhere
  void set_weights(std::span<const double> alpha);

  /// The bound of the whole body.
  StepLimit step_limit() const;
  /// Blended inverse masses, 1/kg; 0 where the motion is prescribed and at inert nodes.
  void inverse_mass(std::span<const std::uint32_t> nodes, std::span<double> out) const;
  /// Largest bound of the elements around each node, rad²/s²; 0 without elements.
  void omega2(std::span<const std::uint32_t> nodes, std::span<double> out) const;

  /// Puts the body into its initial state.
  /// @throws std::invalid_argument unless the time step, s, is positive
  void start(double time_step);

  std::uint64_t step() const { return static_cast<std::uint64_t>(step_); } // n, between two steps
  /// All that steps have changed, between two steps.
  State state() const;
  /// @throws std::invalid_argument when a state is of another model
  void check_model(const State& state) const;
  /// Goes on from the state of another engine with the same mesh and settings; after start().
  /// @throws std::invalid_argument when it is of another model
  void restore(const State& state);

  /// x^n, m, and v^(n-1/2), m/s (v^0 before the first step); prescribed components give the
  /// velocity with which they are about to move, v^(n+1/2).
  void motion(std::span<const std::uint32_t> nodes, std::span<double> position,
              std::span<double> velocity) const;
  /// Internal forces at x^n; also takes back the interface forces of the last step.
  void compute_own_forces();
  /// Resultants without the interface forces and the reactions, N.
  void own_forces(std::span<const std::uint32_t> nodes, std::span<double> force) const;
  void add_interface_forces(std::span<const std::uint32_t> nodes, std::span<const double> force);
  /// From t_n to t_(n+1).
  void integrate();

  /// Energies and momentum at the t_n of the last integrate().
  Energies energies() const;
  Vec<dim> momentum() const;

  const Mesh<dim>& mesh() const { return mesh_; }
  const Elements<dim>& elements() const { return elements_; } // those that take part
  const LinearElastic& material() const { return settings_.material; }
  std::span<const double> mass() const { return mass_; }                 // [num_nodes] kg
  std::span<const double> displacement() const { return displacement_; } // u^n, m
  std::span<const double> velocity() const { return velocity_; }         // v^(n-1/2), m/s
  /// The first node whose motion is no longer a finite number.
  std::optional<std::uint32_t> first_non_finite() const;

private:
  friend struct StateParts;

  void move_boundary();
  Work reaction_work() const;
  Work interface_work() const;

  Mesh<dim> mesh_;
  Settings<dim> settings_;
  Boundary<dim> boundary_;

  // With the weights.
  Elements<dim> elements_;
  std::vector<double> mass_;           // [num_nodes]
  std::vector<double> inverse_mass_;   // [num_nodes][dim]
  std::vector<double> element_omega2_; // [elements]
  std::vector<Prescribed> moved_;      // prescribed components of nodes with mass

  // At t_n; after integrate() also what it was before.
  double time_step_ = 0.0;
  std::int64_t step_ = 0;
  std::vector<double> displacement_, displacement_before_; // [num_nodes][dim]
  std::vector<double> velocity_, velocity_before_;         // [num_nodes][dim]
  std::vector<double> initial_displacement_;               // [moved]
  std::vector<double> element_force_;                      // [elements][element_nodes][dim]
  std::vector<double> own_force_, interface_force_;        // [num_nodes][dim]
  bool has_interface_force_ = false;
  WorkBook external_work_, interface_work_;
};

} // namespace kerf::fem
