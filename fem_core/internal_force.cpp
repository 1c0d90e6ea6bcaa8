#include "fem_core/internal_force.hpp"

#include "fem_core/parallel.hpp"

namespace kerf::fem {

template <int dim>
void compute_element_forces(const Elements<dim>& elements, const LinearElastic& material,
                            std::span<const double> displacement, std::span<double> element_force) {
  const auto size = static_cast<std::int64_t>(elements.size());
#pragma omp parallel for schedule(static) if (size >= least_parallel_size)
  for (std::int64_t e = 0; e < size; ++e) {
    const NodeVectors<dim> u = elements.relative_displacement(e, displacement);
    NodeVectors<dim> f = NodeVectors<dim>::Zero();
    for (int q = 0; q < gauss_points<dim>; ++q) {
      const Tensor<dim> sigma = material.stress<dim>(elements.strain(e, q, u));
      f += elements.volume_at(e, q) * sigma * elements.gradient(e, q); // B^T sigma, by columns
    }
    Eigen::Map<NodeVectors<dim>>(element_force.data() + e * f.size()) = f;
  }
}

template <int dim>
void gather_element_forces(const Elements<dim>& elements, std::span<const double> element_force,
                           std::span<double> node_force) {
  const auto num_nodes = static_cast<std::int64_t>(elements.num_nodes());
#pragma omp parallel for schedule(static) if (num_nodes >= least_parallel_size)
  for (std::int64_t a = 0; a < num_nodes; ++a) {
    Vec<dim> f = Vec<dim>::Zero();
    for (std::size_t k = elements.first_corner[a]; k < elements.first_corner[a + 1]; ++k)
      f -=
          Eigen::Map<const Vec<dim>>(element_force.data() + std::size_t{elements.corners[k]} * dim);
    Eigen::Map<Vec<dim>>(node_force.data() + a * dim) = f;
  }
}

template void compute_element_forces<2>(const Elements<2>&, const LinearElastic&,
                                        std::span<const double>, std::span<double>);
template void compute_element_forces<3>(const Elements<3>&, const LinearElastic&,
                                        std::span<const double>, std::span<double>);
template void gather_element_forces<2>(const Elements<2>&, std::span<const double>,
                                       std::span<double>);
template void gather_element_forces<3>(const Elements<3>&, std::span<const double>,
                                       std::span<double>);

} // namespace kerf::fem
