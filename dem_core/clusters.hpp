// Particles that are joined to rigid bodies, which move freely or as they are told.
#pragma once

#include "dem_core/boundary.hpp"
#include "dem_core/contact_forces.hpp"
#include "dem_core/damping.hpp"
#include "dem_core/particles.hpp"
#include "dem_core/rigid_body.hpp"
#include "dem_core/running_work.hpp"
#include "dem_core/settings.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace kerf::dem {

/// What acts on a cluster from all sides, about its centre.
template <int dim> struct ClusterLoad {
  Vec<dim> force = Vec<dim>::Zero();  // N
  Rot<dim> moment = Rot<dim>::Zero(); // N m

  ClusterLoad& operator+=(const ClusterLoad& other) {
    force += other.force;
    moment += other.moment;
    return *this;
  }
};

/// One rigid body. Its frame is that of space at the start, around its centre of mass.
template <int dim> struct Cluster {
  // What it is.
  std::vector<std::uint32_t> members; // ascending
  std::vector<Vec<dim>> arms;         // [members] from the centre at the start, m
  bool is_free = true;
  Vec<dim> start;                        // centre at the start, m
  double mass = 0.0;                     // kg
  double weighed_mass = 0.0;             // without mass scaling, kg
  Inertia<dim> inertia;                  // about the centre, in its frame, kg m²
  double extent = 0.0;                   // from the centre to the farthest surface, m
  double least_inertia = 0.0;            // about any axis, kg m²
  RigidVelocity<dim> initial;            // of a free one, beside that of its members
  std::optional<ToolMover<dim>> mover;   // of one that moves as told
  Vec<dim> reference = Vec<dim>::Zero(); // that it moves, at the start, m

  // Where it is, at t_n, and how it moves.
  Vec<dim> displacement = Vec<dim>::Zero(); // of the centre, m
  Orientation<dim> orientation;
  Vec<dim> velocity = Vec<dim>::Zero();         // v^(n-1/2), v^0 before the first step, m/s
  Rot<dim> angular_momentum = Rot<dim>::Zero(); // of a free one, likewise, in space, kg m²/s
  Rot<dim> rate = Rot<dim>::Zero();             // mean of the last step, omega^0 before, rad/s

  // Of the last step, which began at t_n.
  ClusterLoad<dim> load, damping;                  // load without damping
  Vec<dim> velocity_before = Vec<dim>::Zero();     // v^(n-1/2), m/s
  Rot<dim> rate_before = Rot<dim>::Zero();         // omega at t_n, of L^(n-1/2), rad/s
  Rot<dim> rate_after = Rot<dim>::Zero();          // omega at t_n, of L^(n+1/2), rad/s
  Vec<dim> displacement_before = Vec<dim>::Zero(); // at t_n, m
  Orientation<dim> orientation_before;             // at t_n
  RunningWork load_work, damping_work, drive_work; // J

  Vec<dim> centre() const { return start + displacement; } // m
  /// Inertia times a rate in space, kg m²/s.
  Rot<dim> momentum_of(const Orientation<dim>& at, const Rot<dim>& angular_velocity) const {
    return to_space<dim>(at, Rot<dim>(inertia * to_body<dim>(at, angular_velocity)));
  }
};

/// Loads of the members are summed, the body makes its step, and the members are carried along. To
/// the rest of the engine they are particles with prescribed motion, and contacts among them do not
/// exist.
///
/// A free cluster follows M dv/dt = F by central differences; its angular momentum in space grows
/// by the moment likewise, and between two such kicks it turns freely: see free_turn().
template <int dim> class Clusters {
public:
  Clusters() = default;
  /// Marks the members in the particles and takes them into the boundary.
  /// @param settings  members by box or by id
  /// @throws std::invalid_argument when a cluster has no members, an id does not exist, a particle
  ///         is in two of them or has a prescribed motion, or a mass or an inertia cannot be
  Clusters(std::span<const ClusterSettings<dim>> settings, Particles<dim>& particles,
           Boundary<dim>& boundary);

  /// Takes the members into another boundary.
  /// @throws std::invalid_argument when it prescribes the motion of one of them
  void carry_members(const Particles<dim>& particles, Boundary<dim>& boundary) const;

  std::size_t size() const noexcept { return clusters_.size(); }
  std::span<const Cluster<dim>> all() const noexcept { return clusters_; }
  /// The free cluster that a particle belongs to, or null.
  const Cluster<dim>* free_one_of(const Particles<dim>& particles, std::size_t i) const {
    if (particles.cluster.empty() || particles.cluster[i] == 0)
      return nullptr;
    const Cluster<dim>& cluster = clusters_[particles.cluster[i] - 1];
    return cluster.is_free ? &cluster : nullptr;
  }

  /// Multiplies masses and inertias by factors, from what they were at first.
  void scale_mass(std::span<const double> factor);

  /// Initial velocities: those that the members have on average, and the own ones.
  void start(Particles<dim>& particles);
  /// One step of all bodies; the boundary receives the motion of the members.
  void advance(const Loads<dim>& loads, const Damping& damping, const Vec<dim>& gravity,
               std::uint64_t step, double time_step, Boundary<dim>& boundary);
  /// Puts the members where they belong, free of the rounding of many steps.
  void place(Particles<dim>& particles) const;

  // Of t_n, after advance().
  double kinetic_energy() const; // J
  Vec<dim> momentum() const;     // N s
  double drive_work() const;     // of those that move as told, J
  double damping_work() const;   // J
  /// Since the start, J.
  /// @param share  of the last step that is already counted
  double weight_work(const Vec<dim>& gravity, double share = 0.0) const;

private:
  friend struct StateParts;
  std::vector<Cluster<dim>> clusters_;
};

} // namespace kerf::dem
