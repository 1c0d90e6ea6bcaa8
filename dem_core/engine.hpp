// The particle engine: a model, its state, and the calls of one time step in their order.
#pragma once

#include "common/state.hpp"
#include "dem_core/applied_forces.hpp"
#include "dem_core/boundary.hpp"
#include "dem_core/change.hpp"
#include "dem_core/clusters.hpp"
#include "dem_core/contact.hpp"
#include "dem_core/contact_forces.hpp"
#include "dem_core/crack.hpp"
#include "dem_core/energy.hpp"
#include "dem_core/in_situ_stress.hpp"
#include "dem_core/materials.hpp"
#include "dem_core/particles.hpp"
#include "dem_core/reactions.hpp"
#include "dem_core/settings.hpp"
#include "dem_core/tool.hpp"
#include "dem_core/wall_contacts.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kerf::dem {

struct StepLimit {
  double omega2 = 0.0;    // bound of the largest eigenvalue of M^-1 K, rad²/s²
  std::string limited_by; // the particle or cluster that has it
};

/// What mass scaling has added.
struct AddedMass {
  double added = 0.0, before = 0.0; // kg
  std::size_t particles = 0;        // heavier than they were; a cluster counts with all of its own
  double largest_factor = 1.0;
  std::uint32_t largest_id = 0; // of the particle that has it
};

/// Flat arrays of points are row-major, [points][dim]. A step is
///
///     engine.motion(…);               // x^n, v^(n-1/2)
///     engine.compute_own_forces();
///     engine.own_forces(…);           // if somebody needs them
///     engine.add_interface_forces(…); // if there are any
///     engine.integrate();             // a, v^(n+1/2), x^(n+1)
///     engine.energies();              // of t_n, if wanted
template <int dim> class Engine {
public:
  /// @throws std::invalid_argument when the model cannot exist: see make_particles(),
  ///         make_contacts(); also for a stiffness that is not positive
  explicit Engine(const Settings<dim>& settings);

  std::size_t size() const noexcept { return particles_.size(); }
  const Particles<dim>& particles() const noexcept { return particles_; }
  /// As of the last time that forces were computed.
  const Contacts<dim>& contacts() const noexcept { return contacts_; }
  const Boundary<dim>& boundary() const noexcept { return boundary_; }
  const Period<dim>& period() const noexcept { return period_; }

  /// Rigid tools and their contacts, in the order of the settings; of t_n after
  /// compute_own_forces(), velocities and works after integrate().
  std::span<const Tool<dim>> tools() const noexcept { return tools_; }
  std::span<const WallContacts<dim>> wall_contacts() const noexcept { return wall_contacts_; }
  const std::string& tool_name(std::size_t k) const { return tool_names_[k]; }

  /// Rigid clusters in the order of the settings; loads and works of t_n after integrate().
  const Clusters<dim>& clusters() const noexcept { return clusters_; }

  /// Mean normal stiffness of the bonds of each particle; of the material if it has none, N/m.
  std::vector<double> stiffness() const;
  std::size_t bonds_at_start() const noexcept { return bonds_at_start_; }
  std::size_t bonds() const noexcept { return contacts_.bonds(); }
  /// Every bond that broke since the start, in the order of time.
  std::span<const Crack<dim>> cracks() const noexcept { return cracks_; }
  std::size_t renewals() const noexcept { return renewals_; } // of the list of contacts
  double memory() const;                                      // of the large arrays, bytes

  /// Shares of the particles in the blended virtual work, before start().
  /// @param weight  [size] > 0; empty: one everywhere
  void set_weights(std::span<const double> weight);

  /// Of the stress at the start; nothing when the settings have none.
  const std::optional<InSituReport<dim>>& in_situ_stress() const noexcept {
    return in_situ_stress_;
  }
  StepLimit step_limit() const;
  /// What it may come to be with contacts that loose particles do not have yet; 0 when there are
  /// none. See contacts_to_come().
  StepLimit step_limit_to_come() const;
  AddedMass added_mass() const;
  /// Blended inverse mass, 0 where prescribed, 1/kg.
  void inverse_mass(std::span<const std::uint32_t> points, std::span<double> out) const;
  /// Own row sum of M^-1 K of each point, rad²/s²; [points]. See row_sum().
  void omega2(std::span<const std::uint32_t> points, std::span<double> out) const;

  /// Sets the initial velocities; once.
  /// @param time_step  s, > 0; it is not compared with step_limit() here
  void start(double time_step);

  std::uint64_t step() const noexcept { return step_; }    // n, between two steps
  double time_step() const noexcept { return time_step_; } // of start(), s
  /// All that steps have changed, between two steps.
  State state() const;
  /// @throws std::invalid_argument when a state is of another model
  void check_model(const State& state) const;
  /// Goes on from the state of another engine with the same settings; after set_weights() and
  /// start().
  /// @throws std::invalid_argument when it is of another model
  void restore(const State& state);

  /// Between two steps, after start(). Before restore(), of everything but bonds, it makes settings
  /// those that the state was made with.
  /// @throws std::invalid_argument for a value or a motion that cannot be
  void change(const Change<dim>& change);

  /// x^n in m and v^(n-1/2) in m/s (v^0 in the first step); prescribed components give v^(n+1/2).
  void motion(std::span<const std::uint32_t> points, std::span<double> position,
              std::span<double> velocity) const;
  /// Contacts, tools, weight, loads and damping at x^n. A second call in the same step changes
  /// nothing.
  void compute_own_forces();
  /// Everything but the interface force, N.
  void own_forces(std::span<const std::uint32_t> points, std::span<double> force) const;
  void add_interface_forces(std::span<const std::uint32_t> points, std::span<const double> force);
  /// Computes the own forces, too, unless that is done: each block of particles then goes through
  /// the whole step while it is in the cache. The bits are the same.
  void integrate();

  /// Of t_n, after integrate() of step n.
  Energies energies() const;
  Vec<dim> momentum() const;
  /// What holds a set of the boundary, and what is applied from outside; of t_n, after integrate().
  Reaction<dim> reaction(std::size_t set) const;
  const Reactions<dim>& reactions() const noexcept { return reactions_; }
  const AppliedForces<dim>& applied_forces() const noexcept { return applied_forces_; }
  /// Mean resultant over mean contact force at t_n, after integrate(); see balance.hpp.
  double unbalanced_force() const;

  /// First particle whose position or rotation rate is not finite.
  std::optional<std::uint32_t> first_not_finite() const;
  /// First particle whose centre is outside of a box.
  std::optional<std::uint32_t> first_outside(const Box<dim>& box) const;

private:
  friend struct StateParts;

  void add_tools(const Settings<dim>& settings);
  void load_bonds(const InSituStress<dim>& stress);
  void scale_mass();
  std::vector<double> row_sums() const;
  std::vector<double> cluster_sums() const;
  void book_step();
  void forget_interface_forces();
  double compute_forces(bool moves);
  double move();

  Materials materials_;
  Damping damping_;
  ShearIncrement shear_increment_;
  std::vector<InitialCondition<dim>> initial_;
  Period<dim> period_;
  Particles<dim> particles_;
  Boundary<dim> boundary_;
  Clusters<dim> clusters_;
  Reactions<dim> reactions_;
  AppliedForces<dim> applied_forces_;
  Contacts<dim> contacts_;
  Skin<dim> skin_;
  std::vector<std::string> tool_names_;
  std::vector<Tool<dim>> tools_;
  std::vector<WallContacts<dim>> wall_contacts_;
  std::optional<InSituReport<dim>> in_situ_stress_;
  std::optional<MassScaling> mass_scaling_;
  Vec<dim> gravity_;                              // m/s²
  double weight_work_at_start_ = 0.0;             // J
  std::vector<Aligned<Rot<dim>>> start_rotation_; // made before the start, rad
  std::size_t bonds_at_start_ = 0;
  std::size_t renewals_ = 0;
  double travelled_ = 0.0; // see Increment, m

  double time_step_ = 0.0;
  std::uint64_t step_ = 0;
  bool forces_are_current_ = false;
  Loads<dim> loads_;
  std::vector<std::uint32_t> touched_;   // particles with an interface force
  std::vector<std::uint8_t> is_touched_; // [n], or empty until there is one
  bool interface_forces_are_old_ = false;
  std::vector<Crack<dim>> cracks_;
  Work work_;       // until t_n
  Work work_ahead_; // until t_(n+1/2)
};

} // namespace kerf::dem
