#include "dem_core/gauge.hpp"

#include <Eigen/LU>

#include <limits>

namespace kerf::dem {

template <int dim>
Matrix<dim> displacement_gradient(const Particles<dim>& particles,
                                  std::span<const std::uint32_t> group) {
  Vec<dim> mean_X = Vec<dim>::Zero(), mean_u = Vec<dim>::Zero();
  for (const std::uint32_t i : group) {
    mean_X += particles.reference[i] / static_cast<double>(group.size());
    mean_u += particles.displacement[i] / static_cast<double>(group.size());
  }
  Matrix<dim> u_X = Matrix<dim>::Zero(), X_X = Matrix<dim>::Zero(); // m²
  for (const std::uint32_t i : group) {
    const Vec<dim> X = particles.reference[i] - mean_X;
    u_X += (particles.displacement[i] - mean_u) * X.transpose();
    X_X += X * X.transpose();
  }
  Eigen::FullPivLU<Matrix<dim>> X_X_factors;
  X_X_factors.setThreshold(1e-9); // of the largest pivot: thinner groups span no space
  X_X_factors.compute(X_X);
  if (!X_X_factors.isInvertible())
    return Matrix<dim>::Constant(std::numeric_limits<double>::quiet_NaN());
  return u_X * X_X_factors.inverse(); // normal equations of the fit
}

template Matrix<2> displacement_gradient<2>(const Particles<2>&, std::span<const std::uint32_t>);
template Matrix<3> displacement_gradient<3>(const Particles<3>&, std::span<const std::uint32_t>);

} // namespace kerf::dem
