#include "fem_core/time_step.hpp"

#include "fem_core/mass.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace kerf::fem {
namespace {

template <int dim>
double solve(const Elements<dim>& elements, std::size_t e, const LinearElastic& material) {
  constexpr int size = element_nodes<dim> * dim;
  Eigen::Matrix<double, size, 1> scale; // M_e^(-1/2)
  const NodeValues<dim> mass = element_mass(elements, e, material.density);
  for (int i = 0; i < size; ++i)
    scale[i] = 1.0 / std::sqrt(mass[i / dim]);
  using Matrix = Eigen::Matrix<double, size, size>;
  const Matrix A =
      scale.asDiagonal() * element_stiffness(elements, e, material) * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix>(A, Eigen::EigenvaluesOnly).eigenvalues()[size - 1];
}

/// Whether two elements have the same shape and weights up to the rounding of their coordinates.
template <int dim> bool alike(const Elements<dim>& elements, std::size_t a, std::size_t b) {
  constexpr double rounding = 1e-12;
  for (int q = 0; q < gauss_points<dim>; ++q) {
    const auto of_a = elements.gradient(a, q);
    const auto of_b = elements.gradient(b, q);
    if (!((of_a - of_b).cwiseAbs().maxCoeff() <= rounding * of_a.cwiseAbs().maxCoeff()))
      return false;
    const double volume = elements.volume_at(a, q);
    if (!(std::abs(volume - elements.volume_at(b, q)) <= rounding * volume))
      return false;
  }
  return true;
}

} // namespace

template <int dim>
Eigen::Matrix<double, element_nodes<dim> * dim, element_nodes<dim> * dim>
element_stiffness(const Elements<dim>& elements, std::size_t element,
                  const LinearElastic& material) {
  Eigen::Matrix<double, element_nodes<dim> * dim, element_nodes<dim> * dim> K;
  K.setZero();
  for (int q = 0; q < gauss_points<dim>; ++q) {
    const auto gradient = elements.gradient(element, q);
    for (int a = 0; a < element_nodes<dim>; ++a)
      for (int b = 0; b < element_nodes<dim>; ++b) {
        const Vec<dim> g_a = gradient.col(a);
        const Vec<dim> g_b = gradient.col(b);
        // B_a^T C B_b of the isotropic law, written out
        K.template block<dim, dim>(a * dim, b * dim) +=
            elements.volume_at(element, q) *
            (material.lambda * g_a * g_b.transpose() + material.mu * g_b * g_a.transpose() +
             material.mu * g_a.dot(g_b) * Tensor<dim>::Identity());
      }
  }
  return K;
}

template <int dim>
std::vector<double> element_omega2(const Elements<dim>& elements, const LinearElastic& material) {
  std::vector<double> omega2(elements.size());
  // Most elements of a structured mesh are like the one before. Blocks of a fixed size start anew,
  // so that the result does not depend on the number of threads.
  constexpr std::size_t block = 256;
  const auto blocks = static_cast<std::int64_t>((elements.size() + block - 1) / block);
#pragma omp parallel for schedule(dynamic) if (blocks > 1)
  for (std::int64_t k = 0; k < blocks; ++k) {
    std::size_t solved = static_cast<std::size_t>(k) * block;
    const std::size_t end = std::min(elements.size(), solved + block);
    for (std::size_t e = solved; e < end; ++e) {
      const bool known = e > static_cast<std::size_t>(k) * block && alike(elements, solved, e);
      omega2[e] = known ? omega2[solved] : solve(elements, e, material);
      if (!known)
        solved = e;
    }
  }
  return omega2;
}

template Eigen::Matrix<double, 8, 8> element_stiffness<2>(const Elements<2>&, std::size_t,
                                                          const LinearElastic&);
template Eigen::Matrix<double, 24, 24> element_stiffness<3>(const Elements<3>&, std::size_t,
                                                            const LinearElastic&);
template std::vector<double> element_omega2<2>(const Elements<2>&, const LinearElastic&);
template std::vector<double> element_omega2<3>(const Elements<3>&, const LinearElastic&);

} // namespace kerf::fem
