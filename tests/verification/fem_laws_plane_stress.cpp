// Laws in plane stress against closed forms and against three dimensions with a free face.
#include "fem_core/laws/plane_stress.hpp"
#include "fem_core/laws/transversely_isotropic.hpp"
#include "tests/cases/law_point.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::LawPoint;
using cases::Random;
using cases::ScalarMath;
using cases::Tensor;
using fem::DruckerPrager;
using fem::Hardening;
using fem::IsotropicDamage;
using fem::IsotropicElastic;
using fem::J2Plastic;
using fem::PlaneStress;

// Reference: sigma_x = E / (1 - nu²) (e_x + nu e_y), tau = E / (1 + nu) e_xy,
// e_z = -nu / (1 - nu) (e_x + e_y). Tolerance: rounding.
TEST(PlaneStress, the_elastic_law_is_that_of_E_over_one_minus_nu_squared) {
  const double E = 30e9, nu = 0.2;
  const Tensor<2> e{1e-3, -4e-4, 7.0, 3e-4}; // the strain zz is ignored
  const PlaneStress law(IsotropicElastic::from_young(2600.0, E, nu));
  const auto sigma = law.stress<ScalarMath, 2>(e);
  LawPoint<PlaneStress<IsotropicElastic>, 2> point(law);
  point.move(e);
  const double scale = E * 1e-3, zz = -nu / (1.0 - nu) * (e[0] + e[1]);
  double worst = 0.0;
  for (const auto& found : {sigma, point.stress})
    worst = std::max({worst, std::abs(found[0] - E / (1.0 - nu * nu) * (e[0] + nu * e[1])) / scale,
                      std::abs(found[1] - E / (1.0 - nu * nu) * (e[1] + nu * e[0])) / scale,
                      std::abs(found[3] - E / (1.0 + nu) * e[3]) / scale, std::abs(found[2])});
  verify({"plane stress, isotropic elastic", "E / (1 - nu²) (e_x + nu e_y)", 1e-15, "rounding"},
         worst);
  EXPECT_NEAR((law.strain_zz<ScalarMath, 2>(e)), zz, 1e-15 * 1e-3);
  EXPECT_NEAR(point.history[0], zz, 1e-15 * 1e-3);
}

TEST(PlaneStress, layers_normal_to_the_plane_have_the_moduli_of_a_sheet_of_both) {
  const fem::TransverselyIsotropic::Parameters p{.density = 2700.0,
                                                 .young_in_plane = 60e9,
                                                 .young_normal = 25e9,
                                                 .poisson_in_plane = 0.22,
                                                 .poisson_normal = 0.28,
                                                 .shear_normal = 12e9,
                                                 .axis = {0.0, 1.0, 0.0}};
  const PlaneStress law(fem::TransverselyIsotropic::from(p, 2));
  // Uniaxial stress along the axis: the strain across is -nu_np, with nothing along zz to hold it.
  const double e = 1e-3, nu_np = p.poisson_normal * p.young_normal / p.young_in_plane;
  const auto sigma = law.stress<ScalarMath, 2>({-nu_np * e, e, 0.0, 0.0});
  EXPECT_NEAR(sigma[1], p.young_normal * e, 1e-14 * 60e9 * e);
  EXPECT_NEAR(sigma[0], 0.0, 1e-14 * 60e9 * e);
}

// Reference: sigma_y(p) = E (eps - p) along a bar, and for equal strain along x and y
// sigma_y(p) = E / (1 - nu) (eps - p / 2), linear hardening; the thickness strain is elastic plus
// -p / 2, or -p. Tolerance: rounding of the two searches.
TEST(PlaneStress, J2_plasticity_follows_the_hardening_curve_of_bar_and_sheet) {
  const double E = 210e9, nu = 0.3, H = 5e9, sigma_0 = 300e6;
  const PlaneStress law(J2Plastic::from(cases::steel(), Hardening::linear(sigma_0, H)));
  LawPoint<PlaneStress<J2Plastic>, 2> bar(law), sheet(law);
  double worst = 0.0;
  for (int n = 0; n < 40; ++n) {
    bar.load(5e-4, {1});
    sheet.move({5e-4, 5e-4, 0.0, 0.0});
    const double e = bar.strain[0];
    const double p = std::max(0.0, (E * e - sigma_0) / (E + H)), sigma = E * (e - p);
    const double stiff = E / (1.0 - nu);
    const double p2 = std::max(0.0, (stiff * e - sigma_0) / (0.5 * stiff + H));
    const double sigma2 = stiff * (e - 0.5 * p2);
    worst = std::max({worst, std::abs(bar.stress[0] - sigma) / sigma_0,
                      std::abs(bar.history[1] + nu * sigma / E + 0.5 * p) / e,
                      std::abs(sheet.stress[1] - sigma2) / sigma_0,
                      std::abs(sheet.history[1] + 2.0 * nu * sigma2 / E + p2) / e});
  }
  EXPECT_GT(bar.history[0], 0.015);
  verify({"plane stress, J2 plasticity, bar and equibiaxial sheet, linear hardening",
          "sigma_y(p) = E (eps - p); E / (1 - nu) (eps - p / 2)", 1e-13,
          "rounding of the searches for the strains across"},
         worst);
}

// Reference: the law in plane strain, strained through the thickness as plane stress says: the same
// stress and a stress zz of zero. Tolerance: that of the search, 2e-15 of the stress of the whole
// increment taken elastically, which is up to 30 times the strength.
template <class Law> double worst_of_random_walk(const Law& law, double step) {
  Random random;
  double worst = 0.0;
  LawPoint<PlaneStress<Law>, 2> sheet(PlaneStress<Law>(law), 1e-3);
  LawPoint<Law, 2> block(law, 1e-3);
  for (int n = 0; n < 500; ++n) {
    auto increment = random.tensor<2>(step * std::pow(10.0, random()));
    sheet.history[Law::history] = 0.0;
    sheet.move(increment);
    increment[2] = sheet.history[Law::history];
    block.move(increment);
    const double scale = law.moduli.uniaxial() * 10.0 * step;
    for (int k = 0; k < 4; ++k)
      worst = std::max(worst, std::abs(sheet.stress[k] - block.stress[k]) / scale);
    block.stress = sheet.stress;
    std::copy_n(sheet.history.begin(), Law::history, block.history.begin());
  }
  return worst;
}
TEST(PlaneStress, incremental_laws_have_no_stress_through_the_thickness) {
  auto cut = cases::sandstone();
  cut.tension_cutoff = 1e6;
  auto associated = cases::sandstone();
  associated.dilation_angle = associated.friction_angle;
  const auto voce = Hardening::voce(300e6, 150e6, 200.0);
  const double worst = std::max(
      {worst_of_random_walk(J2Plastic::from(cases::steel(), voce), 2e-3),
       worst_of_random_walk(
           J2Plastic::from(cases::steel(), voce, fem::RateDependence::cowper_symonds(40.0, 5.0)),
           2e-3),
       worst_of_random_walk(DruckerPrager::from(cases::rock(), cases::sandstone()), 2e-3),
       worst_of_random_walk(DruckerPrager::from(cases::rock(), associated), 2e-3),
       worst_of_random_walk(DruckerPrager::from(cases::rock(), cut), 2e-3),
       worst_of_random_walk(cases::brittle_rock(), 1e-4)});
  verify({"plane stress, J2, Drucker-Prager and damage on random walks",
          "the law in plane strain with the strain zz found", 1e-14, "tolerance of the search"},
         worst);
}

// Reference: uniaxial stress, tau = mu (b - 1) + lambda ln J with b_y = b_z: the free stretches
// solve mu (b_y - 1) + lambda ln(l_x l_y²) = 0. Tolerance: rounding.
TEST(PlaneStress, the_neo_Hookean_sheet_thins_as_a_bar_in_uniaxial_stress) {
  const auto solid = fem::NeoHookean::from(cases::rock());
  const PlaneStress law(solid);
  const auto [lambda, mu] = solid.moduli;
  double worst = 0.0;
  for (const double h : {-0.9, -0.3, -1e-12, 1e-12, 0.5, 20.0}) {
    double low = -0.99, high = 9.0; // lateral stretch minus one
    for (int i = 0; i < 200; ++i) {
      const double y = 0.5 * (low + high);
      const double tau = mu * y * (2.0 + y) + lambda * (std::log1p(h) + 2.0 * std::log1p(y));
      (tau < 0.0 ? low : high) = y;
    }
    const double y = 0.5 * (low + high);
    const fem::Gradient<double, 2> H{h, 0.0, 0.0, y, 99.0};
    const auto found = law.with_thickness<ScalarMath, 2>(H);
    const auto tau = law.kirchhoff<ScalarMath, 2>(H);
    worst = std::max({worst, std::abs(found.zz / y - 1.0), std::abs(tau[1] / tau[0])});
  }
  verify({"plane stress, neo-Hookean, stretches 0.1 to 21 and strains of 1e-12",
          "uniaxial stress: both strains across are the same", 1e-14, "rounding"},
         worst);
}

} // namespace
} // namespace kerf
