// A quantity that follows a table of times.
#pragma once

#include <cstddef>
#include <vector>

namespace kerf {

/// Linear between the times of a table, constant before the first and after the last.
class TimeTable {
public:
  TimeTable() : TimeTable(0.0) {}
  /// The same value at all times.
  TimeTable(double value) : TimeTable({0.0}, {value}) {}
  /// @param times   [n] ascending, s
  /// @param values  [n]
  /// @throws std::invalid_argument when there are none, the sizes differ, the times do not ascend,
  ///         or a number is not finite
  TimeTable(std::vector<double> times, std::vector<double> values);

  double value(double t) const;
  /// From 0 to t, exact but for rounding.
  double integral(double t) const { return antiderivative(t) - at_zero_; }
  /// Over the time from begin to end, s, exact but for rounding.
  double mean(double begin, double end) const;

private:
  std::size_t next(double t) const; // first point after t
  double antiderivative(double t) const;

  std::vector<double> times_, values_;
  std::vector<double> sums_; // integral from the first time to each
  double at_zero_ = 0.0;     // antiderivative
};

} // namespace kerf
