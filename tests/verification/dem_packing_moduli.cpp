// Elastic moduli of packings by a static stretch, against closed forms and a published fit.
#include "dem_core/bonding.hpp"
#include "dem_core/lattice.hpp"
#include "dem_core/packing/moduli.hpp"
#include "dem_core/packing/packing.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kerf {
namespace {

constexpr double d = 1e-3, k_n = 1.6e10; // spacing, m; N/m
const std::string source = "energy of the bonds of a cell";
const std::string reason = "weak spring to the ground that keeps the system solvable";

template <int dim>
dem::Moduli<dim> of_lattice(dem::LatticeType type, std::array<int, dim> count, double k_t) {
  const auto x = dem::lattice_points<dim>({.type = type, .spacing = d, .count = count});
  const std::vector<double> r(x.size(), 0.5 * d);
  return dem::moduli<dim>(x, r, dem::bonded_pairs<dim>(x, r, 1e-3, {}), k_n, k_t);
}

// Reference: homogenisation of the cell with its six bonds. The strain is homogeneous in a lattice,
// so only rounding and the weak spring to the ground are left.
TEST(PackingModuli, of_the_triangular_lattice_are_those_of_homogenisation) {
  for (const double ratio : {0.0, 0.2, 1.0}) {
    const double k_t = ratio * k_n, s = std::numbers::sqrt3 / 4.0;
    const auto m = of_lattice<2>(dem::LatticeType::triangular, {15, 16}, k_t);
    for (const double error :
         {m.C11 - s * (3.0 * k_n + k_t), m.C12 - s * (k_n - k_t), m.C66 - s * (k_n + k_t)})
      verify({"moduli of a packing that is a triangular lattice, over k_n", source, 1e-8, reason},
             error / k_n);
    EXPECT_NEAR(m.isotropy, 1.0, 1e-8);
    EXPECT_NEAR(m.bulk_density_factor, std::numbers::pi / (2.0 * std::numbers::sqrt3), 1e-12);
    EXPECT_EQ(m.measured_particles, 13u * 14u);
  }
}

// Reference: twelve bonds along the face diagonals, volume of a particle d³ / sqrt(2); sheared
// along the cube C66 = (k_n + k_t / 2 ...) follows from the same sum over the bonds:
// C_66 = sum (k_n n_x² n_y² + k_t (n_x² + n_y² - 4 n_x² n_y²) / 4) d² / (2 V).
TEST(PackingModuli, of_the_face_centred_cubic_lattice_are_those_of_homogenisation) {
  for (const double ratio : {0.0, 0.2, 1.0}) {
    const double k_t = ratio * k_n;
    const auto m = of_lattice<3>(dem::LatticeType::fcc, {4, 4, 4}, k_t);
    const double n4 = 4.0 * 0.25, n2 = 8.0 * 0.5; // sums of n_x² n_y² and of n_x² over the bonds
    const double C66 = (k_n * n4 + k_t * (2.0 * n2 - 4.0 * n4) / 4.0) / std::numbers::sqrt2 / d;
    for (const double error : {m.C11 - std::numbers::sqrt2 * (k_n + k_t) / d,
                               m.C12 - (k_n - k_t) / (std::numbers::sqrt2 * d), m.C66 - C66})
      verify({"moduli of a packing that is a face-centred lattice, over k_n / d", source, 1e-8,
              reason},
             error / (k_n / d));
    EXPECT_NEAR(m.bulk_density_factor, std::numbers::pi / (3.0 * std::numbers::sqrt2), 1e-12);
  }
}

// Reference: an independent program compressed such packings between plates; its fits over
// coordination numbers from 4.9 to 5.9 are E_2D = 18.15 + 6.93 (z - 5.4) GPa and
// nu_2D = 0.271 - 0.052 (z - 5.4), to within 5 %. In the plane E_2D = C11 - C12² / C11.
// The 2D lattice of 5000 discs scatters by about 2 % in its isotropy.
TEST(PackingModuli, of_an_irregular_packing_are_isotropic_and_those_of_its_compression) {
  const dem::BoxRegion<2> box({{0.0, 0.0}, {0.05, 0.05}});
  const auto p = dem::pack(box, {.radii = {.law = dem::RadiusLaw::power,
                                           .least = 0.262e-3,
                                           .most = 0.653e-3,
                                           .exponent = 3.56,
                                           .values = {},
                                           .weights = {}},
                                 .porosity = 0.13,
                                 .count = {}});
  const std::span<const Vec<2>> x(p.positions);
  for (const double z : {5.0, 5.4, 5.6}) {
    const double gap = dem::gap_tolerance_for<2>(z, x, p.radii, {});
    const auto m = dem::moduli<2>(x, p.radii, dem::bonded_pairs<2>(x, p.radii, gap, {}), 1.61129e10,
                                  0.3222e10);
    EXPECT_NEAR(m.coordination_number, z, 1e-3);
    EXPECT_NEAR(m.isotropy, 1.0, 0.05);
    EXPECT_NEAR(m.stiffness(0, 0), m.stiffness(1, 1), 0.05 * m.C11);
    const double E = 18.15e9 + 6.93e9 * (z - 5.4);
    const std::string fit = "an independent program, fit over coordination numbers";
    verify({"Young's modulus of an irregular packing", fit, 0.05, "scatter of the fit"},
           (m.C11 - m.C12 * m.C12 / m.C11) / E - 1.0);
    verify({"Poisson's ratio of an irregular packing, over 0.271", fit, 0.05, "scatter of the fit"},
           (m.C12 / m.C11 - (0.271 - 0.052 * (z - 5.4))) / 0.271);
    EXPECT_NEAR(m.bulk_density_factor, 0.87, 0.01); // without the looser layer along the walls
  }
}

// Where they overlap, particles cannot have fewer neighbours.
TEST(PackingModuli, refuse_a_coordination_number_below_that_of_touching_particles) {
  const std::vector<Vec<2>> x = {{0.0, 0.0}, {0.9, 0.0}, {1.8, 0.0}, {0.9, 0.9}};
  const std::vector<double> r(4, 0.5);
  EXPECT_THROW(dem::gap_tolerance_for<2>(0.5, x, r, {}), std::invalid_argument);
  EXPECT_THROW(dem::gap_tolerance_for<2>(9.0, x, r, {}), std::invalid_argument);
  EXPECT_NEAR(dem::gap_tolerance_for<2>(2.5, x, r, {}), std::hypot(0.9, 0.9) - 1.0, 1e-8);
}

} // namespace
} // namespace kerf
