// Material laws and functions in lanes, compiled for every set of instructions, for tests.
#pragma once

namespace kerf {

/// Points in columns; their number is a multiple of 8.
struct PointColumns {
  int count = 0;
  double* stress = nullptr;      // [components][count] Pa, in and out; of a hyperelastic law: out
  double* history = nullptr;     // [law.history][count]
  const double* input = nullptr; // [components][count] strain increment; or displacement gradient
  double* dissipated = nullptr;  // [count] J/m³
  double time_step = 0.0;        // s
};

enum class LaneFunction { logarithm, logarithm_of_one_plus, exponential };

namespace baseline {
template <class Law, int dim> void run_points(const Law& law, const PointColumns& points);
void apply(LaneFunction function, const double* x, double* y, int count);
} // namespace baseline
namespace avx2 {
template <class Law, int dim> void run_points(const Law& law, const PointColumns& points);
void apply(LaneFunction function, const double* x, double* y, int count);
} // namespace avx2
namespace avx512 {
template <class Law, int dim> void run_points(const Law& law, const PointColumns& points);
void apply(LaneFunction function, const double* x, double* y, int count);
} // namespace avx512

} // namespace kerf
