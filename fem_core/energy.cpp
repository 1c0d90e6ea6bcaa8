#include "fem_core/energy.hpp"

#include "common/ordered_sum.hpp"

namespace kerf::fem {

template <int dim>
double kinetic_energy(std::span<const double> mass, std::span<const double> velocity_before,
                      std::span<const double> velocity_after) {
  return ordered_sum(mass.size(), [&](std::size_t a) {
    const Eigen::Map<const Vec<dim>> before(velocity_before.data() + a * dim);
    const Eigen::Map<const Vec<dim>> after(velocity_after.data() + a * dim);
    return 0.5 * mass[a] * before.dot(after);
  });
}

template <int dim>
Vec<dim> momentum(std::span<const double> mass, std::span<const double> velocity_before,
                  std::span<const double> velocity_after) {
  Vec<dim> sum;
  for (int i = 0; i < dim; ++i)
    sum[i] = ordered_sum(mass.size(), [&](std::size_t a) {
      return 0.5 * mass[a] * (velocity_before[a * dim + i] + velocity_after[a * dim + i]);
    });
  return sum;
}

template <int dim>
double element_energy(const Elements<dim>& elements, const LinearElastic& material,
                      std::span<const double> displacement, std::size_t element) {
  const NodeVectors<dim> u = elements.relative_displacement(element, displacement);
  double energy = 0.0;
  for (int q = 0; q < gauss_points<dim>; ++q)
    energy += elements.volume_at(element, q) *
              material.energy_density<dim>(elements.strain(element, q, u));
  return energy;
}

template <int dim>
Tensor<dim> element_stress(const Elements<dim>& elements, const LinearElastic& material,
                           std::span<const double> displacement, std::size_t element) {
  const NodeVectors<dim> u = elements.relative_displacement(element, displacement);
  Tensor<dim> sum = Tensor<dim>::Zero();
  for (int q = 0; q < gauss_points<dim>; ++q)
    sum += material.stress<dim>(elements.strain(element, q, u));
  return sum / gauss_points<dim>;
}

template <int dim>
double elastic_energy(const Elements<dim>& elements, const LinearElastic& material,
                      std::span<const double> displacement) {
  return ordered_sum(elements.size(), [&](std::size_t e) {
    return element_energy(elements, material, displacement, e);
  });
}

template double kinetic_energy<2>(std::span<const double>, std::span<const double>,
                                  std::span<const double>);
template double kinetic_energy<3>(std::span<const double>, std::span<const double>,
                                  std::span<const double>);
template Vec<2> momentum<2>(std::span<const double>, std::span<const double>,
                            std::span<const double>);
template Vec<3> momentum<3>(std::span<const double>, std::span<const double>,
                            std::span<const double>);
template double element_energy<2>(const Elements<2>&, const LinearElastic&, std::span<const double>,
                                  std::size_t);
template double element_energy<3>(const Elements<3>&, const LinearElastic&, std::span<const double>,
                                  std::size_t);
template Tensor<2> element_stress<2>(const Elements<2>&, const LinearElastic&,
                                     std::span<const double>, std::size_t);
template Tensor<3> element_stress<3>(const Elements<3>&, const LinearElastic&,
                                     std::span<const double>, std::size_t);
template double elastic_energy<2>(const Elements<2>&, const LinearElastic&,
                                  std::span<const double>);
template double elastic_energy<3>(const Elements<3>&, const LinearElastic&,
                                  std::span<const double>);

} // namespace kerf::fem
