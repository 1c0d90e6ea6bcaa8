// Small particle models that several tests and benchmarks start from.
#pragma once

#include "dem_core/engine.hpp"
#include "dem_core/lattice.hpp"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace kerf::cases {

inline constexpr double spacing = 1e-3; // of every lattice here, m

/// Rock of Rojek (2008) in 2D; in 3D the same stiffness per millimetre.
inline dem::Material rock(int dim, double tangential_ratio = 0.2) {
  dem::Material material;
  material.density = 2600.0;
  material.normal_stiffness = dim == 2 ? 1e10 : 1e7;
  material.tangential_stiffness = tangential_ratio * material.normal_stiffness;
  return material;
}

/// Particles of radius spacing / 2 that touch their nearest neighbours, bonded, unbreakable.
template <int dim>
dem::Settings<dim> lattice_model(dem::LatticeType type, std::array<int, dim> count,
                                 const dem::Material& material) {
  dem::Lattice<dim> lattice;
  lattice.type = type;
  lattice.spacing = spacing;
  lattice.count = count;
  dem::Settings<dim> settings;
  settings.positions = dem::lattice_points(lattice);
  settings.radii.assign(settings.positions.size(), 0.5 * spacing);
  settings.material = material;
  return settings;
}

/// Two equal particles that touch along a direction.
template <int dim>
dem::Settings<dim> pair_model(const Vec<dim>& direction, const dem::Material& material) {
  dem::Settings<dim> settings;
  settings.positions = {Vec<dim>::Zero(), spacing * direction.normalized()};
  settings.radii = {0.5 * spacing, 0.5 * spacing};
  settings.material = material;
  return settings;
}

/// A dense packing without order: a lattice shaken by a tenth of its spacing, radii from 0.35 to
/// 0.6 of it, bonded across gaps of up to 0.3 of the radii.
template <int dim>
dem::Settings<dim> irregular_model(int edge, const dem::Material& material, unsigned seed) {
  std::array<int, dim> count;
  count.fill(edge);
  auto settings = lattice_model<dim>(
      dim == 2 ? dem::LatticeType::triangular : dem::LatticeType::cubic, count, material);
  std::mt19937 random(seed);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(random()) / 4294967295.0;
  };
  for (std::size_t i = 0; i < settings.positions.size(); ++i) {
    for (int a = 0; a < dim; ++a)
      settings.positions[i][a] += uniform(-0.1, 0.1) * spacing;
    settings.radii[i] = uniform(0.35, 0.6) * spacing;
  }
  settings.gap_tolerance = 0.3;
  return settings;
}

/// Gives every particle a velocity of its own, each component from -size to size, m/s.
template <int dim> void shake(dem::Settings<dim>& settings, double size, unsigned seed) {
  std::mt19937 random(seed);
  const Vec<dim> reach = Vec<dim>::Constant(1e-3 * spacing);
  for (const Vec<dim>& x : settings.positions) {
    dem::InitialCondition<dim> condition;
    condition.box = Box<dim>{x - reach, x + reach};
    for (int a = 0; a < dim; ++a)
      condition.velocity[a] = size * (2.0 * static_cast<double>(random()) / 4294967295.0 - 1.0);
    settings.initial.push_back(condition);
  }
}

/// Prescribes motion of all particles within a millionth of a metre of a point.
template <int dim>
dem::Prescription<dim> prescribe_at(const Vec<dim>& x, dem::Motion motion,
                                    const Vec<dim>& velocity = Vec<dim>::Zero()) {
  const Vec<dim> reach = Vec<dim>::Constant(1e-6);
  dem::Prescription<dim> p;
  p.box = {x - reach, x + reach};
  p.components = (1u << dim) - 1u;
  p.motion = motion;
  p.velocity = velocity;
  return p;
}

/// One step without interface forces.
template <int dim> void step(dem::Engine<dim>& engine) {
  engine.compute_own_forces();
  engine.integrate();
}

/// M^-1/2 K M^-1/2 of an engine that rests in its reference configuration, by central differences
/// of its contact forces: per particle first the translations, then the rotations.
template <int dim> Eigen::MatrixXd scaled_stiffness(const dem::Engine<dim>& engine) {
  constexpr int dofs = dim + rotations<dim>;
  const auto n = engine.size();
  const auto size = static_cast<Eigen::Index>(n) * dofs;
  Eigen::VectorXd root_mass(size);
  for (std::size_t i = 0; i < n; ++i)
    for (int a = 0; a < dofs; ++a)
      root_mass[static_cast<Eigen::Index>(i) * dofs + a] =
          std::sqrt(a < dim ? engine.particles().mass[i] : engine.particles().inertia[i]);

  const auto response = [&](std::size_t i, int a, double size_of_move) {
    auto particles = engine.particles();
    auto contacts = engine.contacts();
    std::vector<dem::Aligned<Rot<dim>>> rotation(n);
    if (a < dim)
      particles.displacement[i][a] = size_of_move;
    else
      rotation[i][a - dim] = size_of_move;
    dem::Loads<dim> loads;
    dem::compute_contact_forces(contacts, particles, {particles.displacement, rotation, 1.0},
                                dem::ShearIncrement::midpoint, loads);
    Eigen::VectorXd all(size);
    for (std::size_t j = 0; j < n; ++j)
      all.segment<dofs>(static_cast<Eigen::Index>(j) * dofs) << loads.own[j].force,
          loads.own[j].moment;
    return all;
  };

  Eigen::MatrixXd K(size, size);
  for (std::size_t i = 0; i < n; ++i)
    for (int a = 0; a < dofs; ++a) {
      const double move = 1e-6 * (a < dim ? spacing : 1.0);
      K.col(static_cast<Eigen::Index>(i) * dofs + a) =
          -(response(i, a, move) - response(i, a, -move)) / (2.0 * move);
    }
  return root_mass.cwiseInverse().asDiagonal() * K * root_mass.cwiseInverse().asDiagonal();
}

/// Largest eigenvalue of M^-1 K, rad²/s².
template <int dim> double largest_eigenvalue(const dem::Engine<dim>& engine) {
  const Eigen::MatrixXd A = scaled_stiffness(engine);
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (A + A.transpose()),
                                                        Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

} // namespace kerf::cases
