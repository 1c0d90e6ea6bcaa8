// Material laws: the isotropic linear elastic solid, in plane strain when the space is 2D.
#pragma once

#include <Eigen/Core>

namespace kerf::fem {

/// A symmetric stress or strain.
template <int dim> using Tensor = Eigen::Matrix<double, dim, dim>;

/// Isotropic, linear elastic, small strain: sigma = lambda tr(eps) I + 2 mu eps, tension positive.
struct LinearElastic {
  double density = 0.0; // of the bulk, kg/m³
  double lambda = 0.0;  // Lamé's first parameter, Pa
  double mu = 0.0;      // shear modulus, Pa

  template <int dim> Tensor<dim> stress(const Tensor<dim>& strain) const {
    return lambda * strain.trace() * Tensor<dim>::Identity() + 2.0 * mu * strain; // Pa
  }
  /// 1/2 eps : C : eps, J/m³
  template <int dim> double energy_density(const Tensor<dim>& strain) const {
    const double trace = strain.trace();
    return 0.5 * lambda * trace * trace + mu * strain.squaredNorm();
  }
};

/// From Young's modulus E, Pa, and Poisson's ratio nu.
/// @throws InputError unless density > 0, E > 0 and -1 < nu < 1/2
LinearElastic from_young(double density, double young_modulus, double poisson_ratio);

/// From the stiffness of uniaxial strain C11 = lambda + 2 mu and the coupling C12 = lambda, Pa.
/// @throws InputError unless density > 0 and every strain of the space stores energy:
///         C11 > C12 and C11 + (dimension - 1) C12 > 0
LinearElastic from_moduli(double density, double C11, double C12, int dimension);

} // namespace kerf::fem
