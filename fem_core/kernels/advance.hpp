// Central differences in time for the rows of nodes; Rojek (2008) eqs 3-5.
#pragma once

#include <cstddef>

namespace kerf::fem {

/// Rows side by side, and what is added up over them, by number of the row. In 3D a fourth number
/// fills a row, and is zero.
struct RowsView {
  std::size_t count;
  const double* mass;       // [count] kg, positive
  const double* weighed;    // [count] that gravity acts on, kg; null: mass
  const double* force;      // [count] resultants without gravity and damping, N
  const double* prescribed; // [count] velocities that are given, m/s; NaN where free; null: all are
  double* velocity;         // [count] v^(n-1/2), m/s; receives v^(n+1/2)
  double* displacement;     // [count] u^n, m; receives u^(n+1)
  double time_step;         // s
  bool first;               // v is v^0, and v^(1/2) = v^0 + a dt/2
  bool stop;                // starts from rest at this step
  double mass_damping;      // a of the force -a m v, 1/s
  double local_damping;     // share of the resultant that opposes the motion
  double gravity[4];        // m/s²

  // With the velocities before, [0], and after the step, [1]:
  double kinetic[4];     // v^(n-1/2) . M v^(n+1/2), J
  double momentum[2][4]; // M v, N s
  double fallen[2][4];   // the same of the weighed mass
  double lost[2][4];     // power of the damping, W
  double squares[4];     // of the resultants where they are free, N²
};

using AdvanceRows = void (*)(RowsView&);

} // namespace kerf::fem
