// Central differences in time, row by row.
#pragma once

#include "fem_core/energy.hpp"
#include "fem_core/rows.hpp"

namespace kerf::fem {

/// What a step does to every row.
template <int dim> struct StepSettings {
  double time_step = 0.0;              // s
  bool first = false;                  // v is v^0 then, and v^(1/2) = v^0 + a dt/2
  Vec<dim> gravity = Vec<dim>::Zero(); // m/s²
  double mass_damping = 0.0;           // a of the force -a m v, 1/s
  double local_damping = 0.0;          // share of the resultant that opposes the motion
};

/// Sums over rows of a step.
template <int dim> struct RowSums {
  double kinetic = 0.0;                 // 1/2 v^(n-1/2) . M v^(n+1/2), J
  Vec<dim> momentum = Vec<dim>::Zero(); // at t_n, with the mean of both velocities, N s
  Work damped;                          // that damping took
  Work gravity;

  RowSums& operator+=(const RowSums& other) {
    kinetic += other.kinetic;
    momentum += other.momentum;
    damped += other.damped;
    gravity += other.gravity;
    return *this;
  }
};

/// a = F/m, v^(n+1/2) = v^(n-1/2) + a dt, u^(n+1) = u^n + v^(n+1/2) dt; Rojek (2008) eqs 3-5.
///
/// @param mass    [count] kg, positive
/// @param force   [count] resultants without gravity and damping, N
/// @param prescribed  [count] velocities that are given, m/s; NaN where a component is free; null:
///                    all are
/// @param velocity, displacement  [count] v^(n-1/2), m/s, and u^n, m; receive the next ones
template <int dim>
void advance(const StepSettings<dim>& step, std::size_t count, const double* mass,
             const double* force, const double* prescribed, double* velocity, double* displacement,
             RowSums<dim>& sums);

} // namespace kerf::fem
