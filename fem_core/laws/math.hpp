// Mathematics of one point: what a material law computes with where it is written for lanes as
// well.
#pragma once

namespace kerf::fem {

/// The policy for one point. That for several side by side, with the same members, is
/// kerf::<set of instructions>::LaneMath.
struct ScalarMath {
  using Number = double;
  using Truth = bool;

  [[gnu::always_inline]] static double constant(double value) { return value; }
  [[gnu::always_inline]] static bool any(bool truth) { return truth; }
  [[gnu::always_inline]] static double select(bool truth, double yes, double no) {
    return truth ? yes : no;
  }
  [[gnu::always_inline]] static double smaller(double a, double b) { return a < b ? a : b; }
  [[gnu::always_inline]] static double larger(double a, double b) { return a > b ? a : b; }
  [[gnu::always_inline]] static double absolute(double x) { return __builtin_fabs(x); }
  [[gnu::always_inline]] static double square_root(double x) { return __builtin_sqrt(x); }
  [[gnu::always_inline]] static double exponential(double x) { return __builtin_exp(x); }
  [[gnu::always_inline]] static double logarithm(double x) { return __builtin_log(x); }
  /// log(1 + x), with all the digits of a tiny x
  [[gnu::always_inline]] static double logarithm_of_one_plus(double x) {
    return __builtin_log1p(x);
  }
  /// x^y for x > 0
  [[gnu::always_inline]] static double power(double x, double y) { return __builtin_pow(x, y); }
};

} // namespace kerf::fem
