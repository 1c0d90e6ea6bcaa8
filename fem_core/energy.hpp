// Energies of a body and the books of the work that is done on it.
#pragma once

#include <cmath>
#include <limits>

namespace kerf::fem {

/// Energies at t_n and the work done until then, J (per metre of thickness in 2D). The balance is
/// kinetic + elastic + dissipated + hourglass + damped - external_work - interface_work, which
/// stays what it was at the start: of linear bodies to round-off, otherwise to second order in the
/// time step.
struct Energies {
  double kinetic = 0.0;        // 1/2 v^(n-1/2) . M v^(n+1/2)
  double elastic = 0.0;        // work of the stress that was not dissipated
  double dissipated = 0.0;     // by plastic flow and damage
  double hourglass = 0.0;      // in the control of the hourglass modes
  double damped = 0.0;         // by damping and viscosity
  double external_work = 0.0;  // of the reactions where the motion is prescribed, loads and gravity
  double interface_work = 0.0; // of the forces of the couplings

  double balance() const {
    return kinetic + elastic + dissipated + hourglass + damped - external_work - interface_work;
  }
};

/// Kinetic energy over the size of the elastic one; infinite where nothing is stored.
inline double kinetic_ratio(const Energies& energies) {
  return energies.elastic != 0.0 ? energies.kinetic / std::abs(energies.elastic)
                                 : std::numeric_limits<double>::infinity();
}

/// Work of the forces f_n of one step, f_n . v dt/2: with the velocity before t_n, and with the one
/// after it. Together they are the trapezoidal rule.
struct Work {
  double before = 0.0; // with v^(n-1/2), J
  double after = 0.0;  // with v^(n+1/2), J

  Work& operator+=(const Work& other) {
    before += other.before;
    after += other.after;
    return *this;
  }
};

/// The work of all steps so far.
class WorkBook {
public:
  /// The first step of a run has no time before it, and counts the second half only.
  void add(const Work& work, bool first_step) {
    at_step_ = first_step ? total_ : total_ + work.before;
    total_ = at_step_ + work.after;
  }
  /// Work done until the t_n of the step added last, J.
  double at_step() const { return at_step_; }

private:
  friend struct StateParts;

  double total_ = 0.0;   // J
  double at_step_ = 0.0; // J
};

} // namespace kerf::fem
