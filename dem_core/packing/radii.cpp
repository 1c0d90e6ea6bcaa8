#include "dem_core/packing/radii.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace kerf::dem {

namespace {

void check_list(const Radii& radii) {
  if (radii.values.empty())
    throw std::invalid_argument("the list of radii is empty");
  for (const double value : radii.values)
    if (!(value > 0.0) || !std::isfinite(value))
      throw std::invalid_argument(fmt::format("the radius {} m must be positive", value));
  if (radii.weights.empty())
    return;
  if (radii.weights.size() != radii.values.size())
    throw std::invalid_argument(fmt::format("{} weights are given for {} radii",
                                            radii.weights.size(), radii.values.size()));
  for (const double weight : radii.weights)
    if (!(weight >= 0.0) || !std::isfinite(weight))
      throw std::invalid_argument(fmt::format("the weight {} must not be negative", weight));
  if (*std::max_element(radii.weights.begin(), radii.weights.end()) == 0.0)
    throw std::invalid_argument("all weights are zero");
}

double quantile_of_list(const Radii& radii, double share) {
  const auto weight = [&](std::size_t k) { return radii.weights.empty() ? 1.0 : radii.weights[k]; };
  double total = 0.0;
  for (std::size_t k = 0; k < radii.values.size(); ++k)
    total += weight(k);
  double below = 0.0;
  std::size_t last = 0;
  for (std::size_t k = 0; k < radii.values.size(); ++k) {
    if (weight(k) > 0.0)
      last = k;
    below += weight(k);
    if (share * total < below)
      return radii.values[k];
  }
  return radii.values[last];
}

} // namespace

void check(const Radii& radii) {
  if (radii.law == RadiusLaw::list)
    return check_list(radii);
  if (!(radii.least > 0.0) || !(radii.least <= radii.most) || !std::isfinite(radii.most))
    throw std::invalid_argument(fmt::format("radii from {} to {} m must be positive, the smaller "
                                            "one first",
                                            radii.least, radii.most));
  if (!std::isfinite(radii.exponent))
    throw std::invalid_argument(fmt::format("the exponent {} must be finite", radii.exponent));
}

double quantile(const Radii& radii, double share) {
  if (radii.law == RadiusLaw::list)
    return quantile_of_list(radii, share);
  const double least = radii.least, most = radii.most;
  if (radii.law == RadiusLaw::uniform)
    return least + share * (most - least);
  // The integral of r^-n is r^(1-n) / (1-n), or log r.
  const double power = 1.0 - radii.exponent, ratio = most / least;
  if (std::abs(power) < 1e-9)
    return least * std::pow(ratio, share);
  const double r = least * std::pow(1.0 + share * (std::pow(ratio, power) - 1.0), 1.0 / power);
  return std::clamp(r, least, most);
}

double mean_of_power(const Radii& radii, int power) {
  constexpr int shares = 20000; // error of a smooth law below 1e-8, of a list below 1 / shares
  double sum = 0.0;
  for (int k = 0; k < shares; ++k)
    sum += std::pow(quantile(radii, (k + 0.5) / shares), power);
  return sum / shares;
}

std::vector<double> draw(const Radii& radii, std::size_t count, Random& random) {
  std::vector<double> drawn(count);
  for (std::size_t k = 0; k < count; ++k)
    drawn[k] =
        quantile(radii, (static_cast<double>(k) + random.uniform()) / static_cast<double>(count));
  for (std::size_t k = count; k > 1; --k)
    std::swap(drawn[k - 1], drawn[random.below(k)]);
  return drawn;
}

} // namespace kerf::dem
