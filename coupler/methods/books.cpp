#include "coupler/methods/books.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace kerf::coupler {

template <int dim>
Resultant<dim> resultant(std::span<const double> position, std::span<const double> force) {
  // Sums of their own for every fourth point do not wait for one another.
  std::array<Resultant<dim>, 4> part;
  for (std::size_t i = 0, lane = 0; i < force.size(); i += dim, lane = (lane + 1) % part.size()) {
    Resultant<dim>& sum = part[lane];
    const Vec<dim> x = Eigen::Map<const Vec<dim>>(position.data() + i);
    const Vec<dim> f = Eigen::Map<const Vec<dim>>(force.data() + i);
    sum.force += f;
    sum.moment += moment<dim>(x, f);
    sum.force_size += f.template lpNorm<1>();
    sum.moment_size += x.template lpNorm<1>() * f.template lpNorm<1>();
  }
  for (std::size_t lane = 1; lane < part.size(); ++lane) {
    part[0].force += part[lane].force;
    part[0].moment += part[lane].moment;
    part[0].force_size += part[lane].force_size;
    part[0].moment_size += part[lane].moment_size;
  }
  return part[0];
}

double power(std::span<const double> force, std::span<const double> velocity) {
  // Sums of their own for every eighth product do not wait for one another.
  constexpr std::size_t lanes = 8;
  std::array<double, lanes> sum{};
  const std::size_t whole = force.size() - force.size() % lanes;
  for (std::size_t i = 0; i < whole; i += lanes)
    for (std::size_t l = 0; l < lanes; ++l)
      sum[l] += force[i + l] * velocity[i + l];
  for (std::size_t i = whole; i < force.size(); ++i)
    sum[i - whole] += force[i] * velocity[i];
  return std::accumulate(sum.begin(), sum.end(), 0.0);
}

template <int dim> double largest_violation(std::span<const double> chi) {
  double largest2 = 0.0;
  for (std::size_t i = 0; i < chi.size(); i += dim)
    largest2 = std::max(largest2, Eigen::Map<const Vec<dim>>(chi.data() + i).squaredNorm());
  return std::sqrt(largest2);
}

template <int dim>
double penalty_energy(std::span<const double> chi, std::span<const double> stiffness) {
  double twice = 0.0;
  for (std::size_t i = 0; i < stiffness.size(); ++i)
    twice += stiffness[i] * Eigen::Map<const Vec<dim>>(chi.data() + dim * i).squaredNorm();
  return 0.5 * twice;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template Resultant<dim> resultant<dim>(std::span<const double>, std::span<const double>);        \
  template double largest_violation<dim>(std::span<const double>);                                 \
  template double penalty_energy<dim>(std::span<const double>, std::span<const double>);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)
#undef KERF_INSTANTIATE

} // namespace kerf::coupler
