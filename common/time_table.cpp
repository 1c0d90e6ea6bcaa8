#include "common/time_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kerf {

TimeTable::TimeTable(std::vector<double> times, std::vector<double> values)
    : times_(std::move(times)), values_(std::move(values)) {
  if (times_.empty() || times_.size() != values_.size())
    throw std::invalid_argument(fmt::format("a table needs as many times as values, not {} and {}",
                                            times_.size(), values_.size()));
  for (std::size_t k = 0; k < times_.size(); ++k) {
    if (!std::isfinite(times_[k]) || !std::isfinite(values_[k]))
      throw std::invalid_argument(
          fmt::format("point {} of a table, {} at {} s, is not finite", k, values_[k], times_[k]));
    if (k > 0 && !(times_[k - 1] < times_[k]))
      throw std::invalid_argument(fmt::format("the times of a table must ascend, but {} s follows "
                                              "{} s",
                                              times_[k], times_[k - 1]));
  }
  sums_.assign(times_.size(), 0.0);
  for (std::size_t k = 1; k < times_.size(); ++k)
    sums_[k] = sums_[k - 1] + 0.5 * (values_[k - 1] + values_[k]) * (times_[k] - times_[k - 1]);
  at_zero_ = antiderivative(0.0);
}

std::size_t TimeTable::next(double t) const {
  return static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), t) -
                                  times_.begin());
}

double TimeTable::value(double t) const {
  const std::size_t k = next(t);
  if (k == 0)
    return values_.front();
  if (k == times_.size())
    return values_.back();
  const double share = (t - times_[k - 1]) / (times_[k] - times_[k - 1]);
  return values_[k - 1] + share * (values_[k] - values_[k - 1]);
}

double TimeTable::mean(double begin, double end) const {
  if (next(begin) == next(end)) // one straight piece: no difference of large integrals
    return value(0.5 * (begin + end));
  return (integral(end) - integral(begin)) / (end - begin);
}

double TimeTable::antiderivative(double t) const {
  const std::size_t k = std::max<std::size_t>(next(t), 1) - 1; // point before t, or the first
  return sums_[k] + 0.5 * (values_[k] + value(t)) * (t - times_[k]);
}

} // namespace kerf
