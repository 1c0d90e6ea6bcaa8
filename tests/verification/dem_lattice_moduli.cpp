// Elastic moduli of regular lattices, from the forces and energies of a homogeneous stretch.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include "dem_core/energy.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::LatticeType;

template <int dim> using Matrix = Eigen::Matrix<double, dim, dim>;

/// Mean stress of the particles inside a box under the homogeneous strain: half of every
/// contact's branch times force belongs to each of its particles. Pa (N/m in 2D over 1 m).
template <int dim>
Matrix<dim> stress(const dem::Engine<dim>& engine, const Matrix<dim>& strain,
                   const Box<dim>& inside, double volume) {
  auto particles = engine.particles();
  auto contacts = engine.contacts();
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles.displacement[i] = strain * particles.reference[i];
  const std::vector<dem::Aligned<Rot<dim>>> no_rotation(particles.size());
  dem::Loads<dim> loads;
  dem::compute_contact_forces(contacts, particles, {particles.displacement, no_rotation, 1.0},
                              dem::ShearIncrement::midpoint, loads);
  Matrix<dim> sum = Matrix<dim>::Zero();
  std::size_t count = 0;
  for (const Vec<dim>& x : particles.reference)
    count += inside.contains(x) ? 1 : 0;
  for (std::size_t k = 0; k < contacts.size(); ++k)
    for (const std::uint32_t i : {contacts.first[k], contacts.second[k]})
      if (inside.contains(particles.reference[i]))
        sum += 0.5 * contacts.reference_branch[k] *
               dem::contact_force(contacts, particles, k).transpose();
  return sum / (static_cast<double>(count) * volume);
}

template <int dim> Box<dim> interior(const dem::Settings<dim>& settings) {
  Vec<dim> lower = settings.positions.front(), upper = lower;
  for (const Vec<dim>& x : settings.positions) {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  const Vec<dim> skin = Vec<dim>::Constant(1.2 * spacing);
  return {lower + skin, upper - skin};
}

constexpr double small = 1e-7; // strain: what is quadratic in it stays below the tolerance 1e-6
const std::string source = "energy of the bonds of a cell",
                  reason = "nonlinear part at strains of 1e-7";

// Reference: C11 = sqrt(3)/4 (3 k_n + k_t), C12 = sqrt(3)/4 (k_n - k_t),
// C66 = (C11 - C12) / 2 by isotropy: homogenisation of the cell with its six bonds, whose energy
// per area is sum (k_n eps_n² + k_t eps_t²) d² / 4 over them. d is the spacing.
TEST(LatticeModuli, of_the_triangular_lattice_are_those_of_homogenisation) {
  for (const double ratio : {0.0, 0.2, 1.0}) {
    const auto material = rock(2, ratio);
    const double k_n = material.normal_stiffness, k_t = material.tangential_stiffness;
    const auto settings = cases::lattice_model<2>(LatticeType::triangular, {9, 10}, material);
    const dem::Engine<2> engine(settings);
    const double cell = 0.5 * std::numbers::sqrt3 * spacing * spacing; // m² of one particle
    const double C11 = std::numbers::sqrt3 / 4.0 * (3.0 * k_n + k_t);
    const double C12 = std::numbers::sqrt3 / 4.0 * (k_n - k_t);
    for (const int axis : {0, 1}) {
      Matrix<2> strain = Matrix<2>::Zero();
      strain(axis, axis) = small;
      const Matrix<2> s = stress<2>(engine, strain, interior(settings), cell) / small;
      verify({"C11 of the triangular lattice", source, 1e-6, reason}, s(axis, axis) / C11 - 1.0);
      verify({"C12 of the triangular lattice, over C11", source, 1e-6, reason},
             (s(1 - axis, 1 - axis) - C12) / C11);
    }
    Matrix<2> shear;
    shear << 0.0, small, small, 0.0;
    const Matrix<2> s = stress<2>(engine, shear, interior(settings), cell) / (2.0 * small);
    for (const double shear_stress : {s(0, 1), s(1, 0)})
      verify({"C66 of the triangular lattice, over C11", source, 1e-6, reason},
             (shear_stress - 0.5 * (C11 - C12)) / C11);
  }
}

// Reference: along the cube edges, C11 = sqrt(2) (k_n + k_t) / d, C12 = (k_n - k_t) / (sqrt(2) d);
// twelve bonds along the face diagonals, volume of a particle d³ / sqrt(2).
TEST(LatticeModuli, of_the_face_centred_cubic_lattice_are_those_of_homogenisation) {
  for (const double ratio : {0.0, 0.2, 1.0}) {
    const auto material = rock(3, ratio);
    const double k_n = material.normal_stiffness, k_t = material.tangential_stiffness;
    const auto settings = cases::lattice_model<3>(LatticeType::fcc, {4, 4, 4}, material);
    const dem::Engine<3> engine(settings);
    const double cell = spacing * spacing * spacing / std::numbers::sqrt2;
    const double C11 = std::numbers::sqrt2 * (k_n + k_t) / spacing;
    const double C12 = (k_n - k_t) / (std::numbers::sqrt2 * spacing);
    for (int axis = 0; axis < 3; ++axis) {
      Matrix<3> strain = Matrix<3>::Zero();
      strain(axis, axis) = small;
      const Matrix<3> s = stress<3>(engine, strain, interior(settings), cell) / small;
      for (int b = 0; b < 3; ++b)
        verify({"C11 and C12 of the face-centred lattice, over C11", source, 1e-6, reason},
               (s(b, b) - (b == axis ? C11 : C12)) / C11);
    }
  }
}

} // namespace
} // namespace kerf
