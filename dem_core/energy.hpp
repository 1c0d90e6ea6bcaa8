// Energies of the particles and the books of the work that goes in and out.
#pragma once

#include "dem_core/boundary.hpp"
#include "dem_core/contact_forces.hpp"
#include "dem_core/particles.hpp"

#include <cstdint>
#include <span>

namespace kerf::dem {

/// Energies at a time t_n, J (per metre of thickness in 2D). What the works bring and the
/// dissipations do not take is found in kinetic + elastic: to round-off in a linear system.
struct Energies {
  double kinetic = 0.0;        // 1/2 v^(n-1/2) . M v^(n+1/2), rotations too
  double elastic = 0.0;        // of the springs of the contacts, with weight
  double external_work = 0.0;  // of reactions to prescribed motion, applied forces, tools, weight
  double interface_work = 0.0; // of the interface forces
  double damping_dissipation = 0.0;  // of damping, and of dashpots to first order in dt
  double friction_dissipation = 0.0; // slip of contacts without bond
  double fracture_dissipation = 0.0; // energy that was stored in bonds when they broke
};

/// Of t_n, as long as the loads are those of the last integrate(); without members of clusters.
template <int dim>
double kinetic_energy(const Particles<dim>& particles, const Loads<dim>& loads,
                      const Boundary<dim>& boundary, double time_step);
template <int dim>
double elastic_energy(const Contacts<dim>& contacts, const Particles<dim>& particles);

/// Momentum at t_n, the mean of half a step before and after, N s; without members of clusters.
template <int dim>
Vec<dim> momentum(const Particles<dim>& particles, const Loads<dim>& loads,
                  const Boundary<dim>& boundary, double time_step);

/// Work that has crossed the edge of the system.
struct Work {
  double interface = 0.0, damping = 0.0; // J

  Work& operator+=(const Work& other) {
    interface += other.interface;
    damping += other.damping;
    return *this;
  }
};

/// The two halves of a step: the force of t_n with v^(n-1/2) before t_n, with v^(n+1/2) after it.
struct StepWork {
  Work before, after;

  StepWork& operator+=(const StepWork& other) {
    before += other.before;
    after += other.after;
    return *this;
  }
};

/// Work of one step, after integrate().
/// @param touched  particles with an interface force, each once
template <int dim>
StepWork step_work(const Particles<dim>& particles, const Loads<dim>& loads,
                   const Boundary<dim>& boundary, std::span<const std::uint32_t> touched,
                   double time_step);

} // namespace kerf::dem
