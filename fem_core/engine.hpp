// The engine: a finite element body that steps in time.
#pragma once

#include "common/state.hpp"
#include "fem_core/absorbing.hpp"
#include "fem_core/boundary.hpp"
#include "fem_core/change.hpp"
#include "fem_core/element_bounds.hpp"
#include "fem_core/energy.hpp"
#include "fem_core/integrate.hpp"
#include "fem_core/internal_force.hpp"
#include "fem_core/loads.hpp"
#include "fem_core/mesh.hpp"
#include "fem_core/rigid_walls.hpp"
#include "fem_core/settings.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kerf::fem {

/// Mean of the points of an element, without alpha, and its energy.
template <int dim> struct ElementState {
  Symmetric<double, dim> stress{}; // Cauchy, Pa
  double energy = 0.0;             // internal, with alpha, J
  std::vector<double> history;     // as history_of() names it
};

/// An explicit finite element body with lumped mass. Points are its nodes; arrays of vectors are
/// [n][dim]. Nodes without mass are inert: they keep their place. The results have the same bits
/// for any number of threads.
///
///     Engine<2> engine(make_box<2>({.size = …, .count = …}), {.materials = …});
///     engine.start(0.8 * 2.0 / std::sqrt(engine.step_limit().omega2));
///     for (…) engine.integrate();
///
/// With couplings a step is compute_own_forces(), add_interface_forces(), integrate().
template <int dim> class Engine {
public:
  /// @throws InputError, std::invalid_argument as its parts do
  Engine(Mesh<dim> mesh, Settings<dim> settings);

  /// Gives the share of the elements in the blended virtual work; before start().
  /// @param alpha  [num_nodes] from 0 to 1; empty: one everywhere
  void set_weights(std::span<const double> alpha);

  /// The bound of the whole body as it has deformed, with what bulk viscosity takes.
  /// @throws std::runtime_error when an element has turned inside out
  StepLimit step_limit() const;
  /// The first element whose Jacobian is not positive; of those in finite strain.
  std::optional<std::uint32_t> first_inverted() const;
  /// "element 3 (tag rock)"
  std::string name_of(std::uint32_t element) const;
  /// Blended inverse masses, 1/kg; 0 where the motion is prescribed and at inert nodes.
  void inverse_mass(std::span<const std::uint32_t> nodes, std::span<double> out) const;
  /// Largest bound of the elements around each node, rad²/s²; 0 without elements.
  void omega2(std::span<const std::uint32_t> nodes, std::span<double> out) const;

  /// Puts the body into its initial state.
  /// @throws std::invalid_argument unless the time step, s, is positive
  void start(double time_step);

  /// Gives all nodes that have mass another motion, between two steps.
  /// @param displacement, velocity  [num_nodes][dim] u^n, m, and v^(n-1/2), m/s
  void set_motion(std::span<const double> displacement, std::span<const double> velocity);

  /// Changes what a change names, between two steps.
  /// @throws InputError for an unknown region or what the parts refuse; nothing has changed then
  void change(const Change<dim>& change);

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
  /// Internal forces and loads at x^n; also takes back the interface forces of the last step.
  void compute_own_forces();
  /// Resultants without the interface forces, gravity, damping and the reactions, N.
  void own_forces(std::span<const std::uint32_t> nodes, std::span<double> force) const;
  void add_interface_forces(std::span<const std::uint32_t> nodes, std::span<const double> force);
  /// From t_n to t_(n+1); computes the own forces too unless that was done.
  void integrate();

  /// Energies and momentum at the t_n of the last integrate().
  Energies energies() const;
  Vec<dim> momentum() const { return sums_.momentum; }

  const Mesh<dim>& mesh() const { return mesh_; }
  const Settings<dim>& settings() const { return settings_; }
  std::vector<double> mass() const;         // [num_nodes] kg
  std::vector<double> displacement() const; // [num_nodes][dim] u^n, m
  /// [num_nodes][dim] since the last change that reset it, m
  std::vector<double> displacement_since_reset() const;
  std::vector<double> velocity() const; // [num_nodes][dim] v^(n-1/2), m/s
  /// Elements that take part, ascending.
  const std::vector<std::uint32_t>& active_elements() const { return active_; }
  /// The setting that an element has its material from.
  std::size_t material_of(std::uint32_t element) const { return material_of_[element]; }
  /// One that takes part, at the displacements of this moment.
  ElementState<dim> element_state(std::uint32_t element) const;
  /// Force of the support on the body at the last t_n, of one of the boundary settings, N.
  Vec<dim> reaction(std::size_t setting) const { return reactions_[setting]; }
  /// Force of a rigid wall on the body in the last step, N.
  Vec<dim> wall_force(std::size_t wall) const { return wall_forces_[wall]; }
  /// The first node whose motion is no longer a finite number.
  std::optional<std::uint32_t> first_non_finite() const;

private:
  friend struct StateParts;

  struct Moved { // a prescribed component of a node with mass
    std::uint32_t row;
    int component;
    std::uint32_t node;
  };

  struct Pushed { // by a load, a dashpot or a wall during a step
    std::uint32_t row;
    Vec<dim> before;             // v^(n-1/2), m/s
    Vec<dim> driving, resisting; // forces whose work is booked as external, and as damped, N
  };

  ElementModel<dim> model_of(std::uint32_t element) const;
  ElementModel<dim> deformed_model_of(std::uint32_t element) const;
  void assign_materials();
  void find_active();
  void make_groups();
  void make_masses();
  void set_in_situ_stress();
  void support_absorbing();
  Space space() const {
    return settings_.plane == Plane::axisymmetric ? Space::axisymmetric : Space::plane;
  }
  StepSettings<dim> step_settings() const;
  Row<dim> sum_of_parts(std::size_t special) const;
  void average_dilatation(std::uint32_t group, const PatchMotion<dim>& motion);
  void add_loads();
  void make_scratch();
  void compute_forces(bool finish);
  void advance_plain();
  void advance_special();
  std::vector<Pushed> pushed_rows() const;
  void push_by_dashpots(std::span<Pushed> pushed);
  void push_by_walls(std::span<Pushed> pushed);
  void push(std::uint32_t row, const Vec<dim>& before, const Vec<dim>& after,
            const Vec<dim>& force);
  double span_of_step() const;
  bool is_held(std::uint32_t row, int component) const;
  std::vector<double> by_node(const Rows<dim>& rows) const;

  Mesh<dim> mesh_;
  Settings<dim> settings_;
  Boundary<dim> boundary_;
  Loads<dim> loads_;
  Absorbing<dim> absorbing_;
  RigidWalls<dim> walls_;
  std::vector<std::uint32_t> material_of_; // [num_elements] setting

  // With the weights.
  std::vector<double> alpha_; // [num_nodes]; empty: one
  std::vector<bool> removed_; // [num_elements]
  std::vector<std::uint32_t> active_;
  Patches patches_;
  std::vector<GroupKernel> groups_;
  std::vector<std::uint32_t> group_of_; // [num_elements]
  std::vector<std::uint32_t> place_;    // [num_elements] in the arrays of the group
  Rows<dim> reference_;                 // of the rows of every patch
  std::vector<double> mass_;            // [rows]
  std::vector<Moved> moved_;

  // At t_n.
  double time_step_ = 0.0;
  std::int64_t step_ = 0, changed_at_ = 0; // where tables of boundaries and loads begin
  Rows<dim> displacement_, velocity_;
  std::vector<double> initial_displacement_; // [moved], when their tables begin
  Rows<dim> origin_;                         // of displacement_since_reset()
  std::vector<Vec<dim>> support_; // [absorbing nodes] that keeps the in-situ stress there, N
  Rows<dim> force_;               // own, of special rows; of all, after compute_own_forces()
  Rows<dim> parts_;               // of special rows, what each patch adds
  bool forces_are_current_ = false;
  Rows<dim> prescribed_;                   // velocities of special rows, m/s; NaN where free
  std::vector<PatchScratch<dim>> scratch_; // [threads]
  std::vector<std::uint32_t> interface_rows_;
  Rows<dim> interface_force_;                     // [rows]; empty until there is one
  ElementWork element_work_{};                    // of all steps
  std::vector<ElementWork> patch_work_;           // of the last forces
  std::vector<RowSums<dim>> patch_sums_;          // of the plain rows of the last step
  RowSums<dim> sums_;                             // of all rows of the last step
  std::vector<double> load_force_;                // [loads_.nodes()][dim] of this step, N
  std::vector<Vec<dim>> reactions_, wall_forces_; // of the last step, N
  WorkBook damped_work_, external_work_, interface_work_;
};

} // namespace kerf::fem
