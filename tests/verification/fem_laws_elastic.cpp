// The linear elastic laws against their compliance, and the isotropic solid that bounds them.
#include "fem_core/laws/transversely_isotropic.hpp"
#include "tests/cases/law_point.hpp"
#include "tests/verification/verification.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <vector>

namespace kerf {
namespace {

using cases::Random;
using cases::ScalarMath;
using cases::Tensor;
using fem::IsotropicElastic;
using fem::TransverselyIsotropic;
using Matrix = Eigen::Matrix3d;

Matrix matrix(const Tensor<3>& a) {
  Matrix m;
  m << a[0], a[5], a[4], a[5], a[1], a[3], a[4], a[3], a[2];
  return m;
}
Tensor<3> in_space(const Tensor<2>& a) {
  return {a[0], a[1], a[2], 0.0, 0.0, a[3]};
}

TransverselyIsotropic::Parameters slate(const std::array<double, 3>& axis) {
  return {.density = 2700.0,
          .young_in_plane = 60e9,
          .young_normal = 25e9,
          .poisson_in_plane = 0.22,
          .poisson_normal = 0.28,
          .shear_normal = 12e9,
          .axis = axis};
}

/// Strain of a stress from the engineering constants, in axes whose third one is n.
Matrix strain_of(const Matrix& stress, const TransverselyIsotropic::Parameters& p) {
  const Eigen::Vector3d n = Eigen::Vector3d(p.axis.data()).normalized();
  Matrix R;
  R.col(2) = n;
  R.col(0) = n.unitOrthogonal();
  R.col(1) = n.cross(R.col(0));
  const Matrix s = R.transpose() * stress * R;
  const double G_p = p.young_in_plane / (2.0 * (1.0 + p.poisson_in_plane));
  const double S_pn = p.poisson_normal / p.young_in_plane;
  Matrix e = Matrix::Zero();
  e(0, 0) = (s(0, 0) - p.poisson_in_plane * s(1, 1)) / p.young_in_plane - S_pn * s(2, 2);
  e(1, 1) = (s(1, 1) - p.poisson_in_plane * s(0, 0)) / p.young_in_plane - S_pn * s(2, 2);
  e(2, 2) = s(2, 2) / p.young_normal - S_pn * (s(0, 0) + s(1, 1));
  e(0, 1) = e(1, 0) = s(0, 1) / (2.0 * G_p);
  e(0, 2) = e(2, 0) = s(0, 2) / (2.0 * p.shear_normal);
  e(1, 2) = e(2, 1) = s(1, 2) / (2.0 * p.shear_normal);
  return R * e * R.transpose();
}

// Reference: the compliance matrix of the engineering constants, turned. Tolerance: rounding times
// the condition of the stiffness, about 10.
TEST(TransverselyIsotropic, its_stress_is_the_inverse_of_the_compliance_for_any_axis) {
  Random random;
  double worst = 0.0;
  for (int n = 0; n < 100; ++n) {
    const auto p = slate({random(), random(), random()});
    const auto law = TransverselyIsotropic::from(p, 3);
    const auto strain = random.tensor<3>(1e-3);
    const Matrix back = strain_of(matrix(law.stress<ScalarMath, 3>(strain)), p);
    worst = std::max(worst, (back - matrix(strain)).norm() / matrix(strain).norm());
  }
  for (int n = 0; n < 100; ++n) {
    const auto p = n % 2 == 0 ? slate({random(), random(), 0.0}) : slate({0.0, 0.0, 1.0});
    const auto law = TransverselyIsotropic::from(p, 2);
    const auto strain = random.tensor<2>(1e-3);
    const Matrix back = strain_of(matrix(in_space(law.stress<ScalarMath, 2>(strain))), p);
    worst = std::max(worst, (back - matrix(in_space(strain))).norm() / 1e-3);
  }
  verify({"transversely isotropic elasticity, any axis, 2D and 3D",
          "compliance of E_p, E_n, nu_p, nu_pn, G_n", 1e-14, "rounding"},
         worst);
}

TEST(TransverselyIsotropic, equal_constants_are_the_isotropic_law) {
  Random random;
  const double E = 60e9, nu = 0.22;
  const auto isotropic = IsotropicElastic::from_young(2700.0, E, nu);
  const auto law = TransverselyIsotropic::from({.density = 2700.0,
                                                .young_in_plane = E,
                                                .young_normal = E,
                                                .poisson_in_plane = nu,
                                                .poisson_normal = nu,
                                                .shear_normal = isotropic.moduli.mu,
                                                .axis = {1.0, 2.0, 3.0}},
                                               3);
  const auto strain = random.tensor<3>(1e-3);
  const auto a = law.stress<ScalarMath, 3>(strain), b = isotropic.stress<ScalarMath, 3>(strain);
  for (int k = 0; k < 6; ++k)
    EXPECT_NEAR(a[k], b[k], 1e-14 * E * 1e-3);
  EXPECT_NEAR(law.bound().uniaxial(), isotropic.moduli.uniaxial(), 1e-6 * E);
}

// Reference: the eigenvalues of C' - C, on strains in an orthonormal basis. That C' is not far
// above is a claim about the time step, which goes with the root of C11'.
TEST(TransverselyIsotropic, its_bound_is_stiffer_for_every_strain_but_not_by_much) {
  Random random;
  std::vector<double> over;
  for (int n = 0; n < 200; ++n) {
    auto p = slate({random(), random(), random()});
    p.young_normal = p.young_in_plane * std::pow(4.0, random());
    p.shear_normal = 20e9 * std::pow(3.0, random());
    p.poisson_in_plane = 0.25 + 0.24 * random();
    p.poisson_normal = 0.25 + 0.2 * random();
    const double most =
        std::sqrt((1.0 - p.poisson_in_plane) * p.young_in_plane / (2.0 * p.young_normal));
    p.poisson_normal = std::min(p.poisson_normal, 0.8 * most);
    const auto law = TransverselyIsotropic::from(p, 3);
    const auto bound = law.bound();
    Eigen::Matrix<double, 6, 6> above;
    for (int k = 0; k < 6; ++k) {
      Tensor<3> unit{};
      unit[k] = k < 3 ? 1.0 : std::sqrt(0.5);
      const auto stress = law.stress<ScalarMath, 3>(unit), stiffer = bound.stress(unit);
      for (int m = 0; m < 6; ++m) {
        above(m, k) = (m < 3 ? 1.0 : std::sqrt(2.0)) * (stiffer[m] - stress[m]);
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(above);
    EXPECT_GE(solver.eigenvalues()[0], -1e-12 * bound.uniaxial());
    const double C11 = law.lambda + 2.0 * law.mu_p, C13 = law.lambda + law.alpha;
    const double C33 = C13 + law.alpha + 4.0 * law.mu_n - 2.0 * law.mu_p + law.beta;
    over.push_back(bound.uniaxial() / std::max(C11, C33));
  }
  std::sort(over.begin(), over.end());
  EXPECT_LT(over[100], 1.02);
  EXPECT_LT(over.back(), 1.7);
}

// Reference: Hooke's law, written with E and nu. Tolerance: rounding.
TEST(IsotropicElastic, uniaxial_shear_and_hydrostatic_strain_have_the_stress_of_Hooke) {
  const double E = 30e9, nu = 0.2, e = 1e-3;
  const auto law = IsotropicElastic::from_young(2600.0, E, nu);
  const auto bar = law.stress<ScalarMath, 3>({e, -nu * e, -nu * e, 0.0, 0.0, 0.0});
  const auto mean = law.stress<ScalarMath, 2>({e, e, e, 0.0});
  const auto shear = law.stress<ScalarMath, 3>({0.0, 0.0, 0.0, 0.0, e, 0.0});
  verify({"isotropic elasticity: bar, pressure, shear", "Hooke's law with E and nu", 1e-15,
          "rounding"},
         std::max({std::abs(bar[0] / (E * e) - 1.0), std::abs(bar[1] / (E * e)),
                   std::abs(mean[2] / (E * e / (1.0 - 2.0 * nu)) - 1.0),
                   std::abs(shear[4] / (E * e / (1.0 + nu)) - 1.0)}));
  EXPECT_EQ(shear[3], 0.0);
  EXPECT_DOUBLE_EQ((law.energy_density<ScalarMath, 3>({e, -nu * e, -nu * e, 0.0, 0.0, 0.0})),
                   0.5 * E * e * e);
}

} // namespace
} // namespace kerf
