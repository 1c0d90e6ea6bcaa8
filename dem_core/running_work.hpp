// The work of a force that is known once a step.
#pragma once

namespace kerf::dem {

/// Force and velocity of central differences: F^n acts with v^(n-1/2) before t_n and with v^(n+1/2)
/// after it, each for half a step. What was before t_0 is no work of the run.
class RunningWork {
public:
  /// @param before, after  F^n . v^(n-1/2) and F^n . v^(n+1/2), W
  void add(double before, double after, double time_step, bool is_first_step) {
    power_ = is_first_step ? before : 0.5 * (before + after);
    work_ = ahead_ + (is_first_step ? 0.0 : 0.5 * time_step * before);
    ahead_ = work_ + 0.5 * time_step * after;
  }

  double power() const noexcept { return power_; } // at t_n, W
  double work() const noexcept { return work_; }   // from t_0 to t_n, J
  double ahead() const noexcept { return ahead_; } // from t_0 to t_(n+1/2), J

private:
  friend struct StateParts;

  double power_ = 0.0, work_ = 0.0;
  double ahead_ = 0.0; // work until t_(n+1/2), J
};

} // namespace kerf::dem
