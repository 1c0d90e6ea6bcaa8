// The neo-Hookean law against its energy, and for tiny strains against Hooke's law.
#include "fem_core/laws/neo_hookean.hpp"
#include "tests/cases/law_point.hpp"
#include "tests/verification/verification.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::Random;
using cases::ScalarMath;
using fem::Gradient;
using fem::NeoHookean;
using Matrix = Eigen::Matrix3d;

Gradient<double, 3> gradient(const Matrix& H) {
  return {H(0, 0), H(0, 1), H(0, 2), H(1, 0), H(1, 1), H(1, 2), H(2, 0), H(2, 1), H(2, 2)};
}
/// Of a plane deformation, without its stretch out of plane.
Gradient<double, 2> in_plane(const Matrix& H) {
  return {H(0, 0), H(0, 1), H(1, 0), H(1, 1), H(2, 2)};
}
Matrix random_matrix(Random& random, double size, bool plane) {
  Matrix H;
  for (int k = 0; k < 9; ++k)
    H(k) = size * random();
  if (plane)
    H(0, 2) = H(1, 2) = H(2, 0) = H(2, 1) = 0.0;
  return H;
}

// Reference: tau F^-T = d psi / d F with psi = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)² written
// in matrices, by central differences of 1e-5 in long double. Tolerance: their truncation, 1e-10.
TEST(NeoHookean, its_stress_is_the_derivative_of_its_energy) {
  using Long = Eigen::Matrix<long double, 3, 3>;
  Random random;
  const auto law = NeoHookean::from(cases::rock());
  const auto psi = [&](const Long& F) {
    const long double lnJ = std::log(F.determinant());
    return 0.5L * law.moduli.mu * (F.squaredNorm() - 3.0L) - law.moduli.mu * lnJ +
           0.5L * law.moduli.lambda * lnJ * lnJ;
  };
  double worst = 0.0, energy_error = 0.0;
  for (int n = 0; n < 60; ++n) {
    const bool plane = n % 2 == 0;
    const Matrix H = random_matrix(random, 0.3, plane);
    const Long F = (Matrix::Identity() + H).cast<long double>();
    Matrix P;
    for (int k = 0; k < 9; ++k) {
      Long more = F, less = F;
      more(k) += 1e-5L;
      less(k) -= 1e-5L;
      P(k) = static_cast<double>((psi(more) - psi(less)) / 2e-5L);
    }
    const Matrix tau = P * F.cast<double>().transpose();
    Matrix found;
    if (plane) {
      const auto t = law.kirchhoff<ScalarMath, 2>(in_plane(H));
      found << t[0], t[3], 0.0, t[3], t[1], 0.0, 0.0, 0.0, t[2];
    } else {
      const auto t = law.kirchhoff<ScalarMath, 3>(gradient(H));
      found << t[0], t[5], t[4], t[5], t[1], t[3], t[4], t[3], t[2];
    }
    worst = std::max(worst, (found - tau).norm() / tau.norm());
    const double energy = plane ? law.energy_density<ScalarMath, 2>(in_plane(H))
                                : law.energy_density<ScalarMath, 3>(gradient(H));
    energy_error = std::max(energy_error, std::abs(energy / static_cast<double>(psi(F)) - 1.0));
  }
  verify({"neo-Hookean Kirchhoff stress, 2D and 3D", "finite differences of the energy", 3e-9,
          "truncation, (1e-5)² times derivatives at strains of 0.3"},
         worst);
  verify({"neo-Hookean energy, 2D and 3D", "psi of matrices in long double", 1e-13, "rounding"},
         energy_error);
}

// Reference: Hooke's law for the symmetric part of H; the next terms are H². Tolerance: 10 |H|, and
// rounding.
TEST(NeoHookean, a_tiny_strain_keeps_its_digits) {
  Random random;
  const auto law = NeoHookean::from(cases::rock());
  double stress_error = 0.0, energy_error = 0.0;
  for (const double size : {1e-9, 1e-14, 1e-20})
    for (int n = 0; n < 20; ++n) {
      const Matrix H = random_matrix(random, size, false);
      const Matrix e = 0.5 * (H + H.transpose());
      const fem::Symmetric<double, 3> strain{e(0, 0), e(1, 1), e(2, 2), e(1, 2), e(0, 2), e(0, 1)};
      const auto tau = law.kirchhoff<ScalarMath, 3>(gradient(H));
      const auto difference = tau - law.moduli.stress(strain);
      const double excess = std::max(
          0.0, std::sqrt(contract(difference, difference) / contract(tau, tau)) - 10.0 * size);
      stress_error = std::max(stress_error, excess);
      const double energy = law.energy_density<ScalarMath, 3>(gradient(H));
      energy_error = std::max(
          energy_error,
          std::max(0.0, std::abs(energy / law.moduli.energy_density(strain) - 1.0) - 10.0 * size));
    }
  verify({"neo-Hookean stress of strains from 1e-20 to 1e-9", "Hooke's law", 1e-15, "rounding"},
         stress_error);
  verify({"neo-Hookean energy of strains from 1e-20 to 1e-9", "Hooke's law", 1e-14,
          "rounding, of a sum whose parts are larger"},
         energy_error);
}

TEST(NeoHookean, a_rotation_has_no_stress) {
  const auto law = NeoHookean::from(cases::rock());
  const Matrix R = Eigen::AngleAxisd(2.0, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).matrix();
  const auto tau = law.kirchhoff<ScalarMath, 3>(gradient(R - Matrix::Identity()));
  for (const double component : tau.c)
    EXPECT_NEAR(component, 0.0, 1e-14 * law.moduli.uniaxial());
}

TEST(NeoHookean, an_inverted_element_is_not_a_number) {
  const auto law = NeoHookean::from(cases::rock());
  const Gradient<double, 2> H{-1.5, 0.0, 0.0, 0.0, 0.0};
  EXPECT_TRUE(std::isnan((law.kirchhoff<ScalarMath, 2>(H)[0])));
}

} // namespace
} // namespace kerf
