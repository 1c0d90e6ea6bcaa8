// Finite element bodies that several tests use.
#pragma once

#include "fem_core/engine.hpp"
#include "fem_core/mesh/box.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace kerf::cases {

/// A rock of round numbers: E = 10 GPa, nu = 0.25, so lambda = mu = 4 GPa.
inline const fem::IsotropicElastic rock = fem::IsotropicElastic::from_young(2500.0, 10e9, 0.25);

/// All of a body is of one material.
template <int dim>
std::vector<fem::MaterialSetting<dim>> of(const fem::Law& law,
                                          fem::Formulation formulation = fem::Formulation::full,
                                          bool finite_strain = false) {
  return {{.material = {.law = law, .finite_strain = finite_strain, .formulation = formulation},
           .region = {},
           .box = {}}};
}

/// Moves the nodes inside a box by up to `share` of the element size along each axis; the outline
/// stays what it was.
template <int dim> void distort(fem::Mesh<dim>& mesh, const fem::BoxMesh<dim>& box, double share) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-share, share);
  for (std::size_t a = 0; a < mesh.num_nodes(); ++a) {
    const Vec<dim> from_lower = mesh.position(a) - box.origin;
    const Vec<dim> from_upper = box.size - from_lower;
    if (from_lower.minCoeff() < 1e-9 || from_upper.minCoeff() < 1e-9)
      continue;
    for (int i = 0; i < dim; ++i)
      mesh.positions[a * dim + i] += any(random) * box.size[i] / static_cast<double>(box.count[i]);
  }
}

/// Some box of a few elements, distorted by a quarter of their size.
template <int dim>
fem::Mesh<dim> distorted_box(fem::Shape shape = dim == 2 ? fem::Shape::quad4 : fem::Shape::hex8) {
  fem::BoxMesh<dim> box;
  box.shape = shape;
  box.size = Vec<dim>::LinSpaced(dim, 3.0, 5.0) * 1e-3;
  box.count.fill(dim == 2 ? 4 : 3);
  fem::Mesh<dim> mesh = fem::make_box(box);
  distort(mesh, box, 0.25);
  return mesh;
}

/// Nodes with a tag that do not move in some components.
template <int dim>
fem::BoundarySetting<dim> held(const std::string& tag, const std::array<bool, dim>& components) {
  fem::BoundarySetting<dim> setting;
  setting.tag = tag;
  setting.components = components;
  return setting;
}

/// A displacement pulse along x that is there at the start.
template <int dim> fem::InitialSetting<dim> started(const fem::InitialPulse& pulse) {
  fem::InitialSetting<dim> setting;
  setting.pulse = pulse;
  return setting;
}

/// alpha that rises linearly from zero at x = begin to one at x = begin + width.
template <int dim>
std::vector<double> ramp(const fem::Mesh<dim>& mesh, double begin, double width) {
  std::vector<double> alpha;
  for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
    alpha.push_back(std::clamp((mesh.position(a)[0] - begin) / width, 0.0, 1.0));
  return alpha;
}

/// Numbers of all nodes.
template <int dim> std::vector<std::uint32_t> all_nodes(const fem::Engine<dim>& engine) {
  std::vector<std::uint32_t> nodes(engine.mesh().num_nodes());
  std::iota(nodes.begin(), nodes.end(), 0u);
  return nodes;
}

/// -F^int of all nodes for a displacement field.
/// @param by_increment  it is that of one step, from rest, for laws that store their stress
template <int dim>
std::vector<double> forces(fem::Engine<dim>& engine, const std::vector<double>& displacement,
                           bool by_increment = false) {
  engine.start(1.0);
  if (by_increment)
    engine.integrate();
  engine.set_motion(displacement,
                    by_increment ? displacement : std::vector<double>(displacement.size()));
  engine.compute_own_forces();
  std::vector<double> force(displacement.size());
  engine.own_forces(all_nodes(engine), force);
  return force;
}

/// The stiffness matrix of all nodes, column by column from the forces of unit displacements.
template <int dim> Eigen::MatrixXd stiffness(fem::Engine<dim>& engine, bool by_increment = false) {
  const auto size = static_cast<Eigen::Index>(engine.mesh().num_nodes()) * dim;
  Eigen::MatrixXd K(size, size);
  std::vector<double> u(static_cast<std::size_t>(size), 0.0);
  for (Eigen::Index j = 0; j < size; ++j) {
    u[static_cast<std::size_t>(j)] = 1.0;
    const std::vector<double> f = forces(engine, u, by_increment);
    K.col(j) = -Eigen::Map<const Eigen::VectorXd>(f.data(), size);
    u[static_cast<std::size_t>(j)] = 0.0;
  }
  return K;
}

/// Largest eigenvalue of the assembled M^-1 K, rad²/s²; nodes without mass do not count.
template <int dim> double largest_omega2(fem::Engine<dim>& engine) {
  const std::vector<double> mass = engine.mass();
  const Eigen::MatrixXd K = stiffness(engine);
  Eigen::VectorXd scale(K.rows());
  for (Eigen::Index i = 0; i < scale.size(); ++i) {
    const double m = mass[static_cast<std::size_t>(i / dim)];
    scale[i] = m > 0.0 ? 1.0 / std::sqrt(m) : 0.0;
  }
  const Eigen::MatrixXd A = scale.asDiagonal() * K * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

/// One step without other participants.
template <int dim> void step(fem::Engine<dim>& engine) {
  engine.compute_own_forces();
  engine.integrate();
}

} // namespace kerf::cases
