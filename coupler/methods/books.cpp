#include "coupler/methods/books.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::coupler {

template <int dim>
Resultant<dim> resultant(std::span<const double> position, std::span<const double> force) {
  Resultant<dim> sum;
  for (std::size_t i = 0; i < force.size(); i += dim) {
    const Vec<dim> x = Eigen::Map<const Vec<dim>>(position.data() + i);
    const Vec<dim> f = Eigen::Map<const Vec<dim>>(force.data() + i);
    sum.force += f;
    sum.moment += moment<dim>(x, f);
    sum.force_size += f.template lpNorm<1>();
    sum.moment_size += x.template lpNorm<1>() * f.template lpNorm<1>();
  }
  return sum;
}

double power(std::span<const double> force, std::span<const double> velocity) {
  double sum = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i)
    sum += force[i] * velocity[i];
  return sum;
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
