// Plane finite element bodies under dead loads, brought to rest.
#pragma once

#include "tests/cases/fem_bodies.hpp"

#include <map>
#include <stdexcept>

namespace kerf::cases {

/// The largest time step of an engine, s.
template <int dim> double critical_step(const fem::Engine<dim>& engine) {
  return 2.0 / std::sqrt(engine.step_limit().omega2);
}

/// Forces at nodes.
struct Load {
  std::vector<std::uint32_t> nodes;
  std::vector<double> force; // [nodes][2] N
};

/// The forces that do the work of a traction on the sides with a tag, by two Gauss points a side.
/// @param traction  of position and outward unit normal in the reference configuration, Pa
template <class Traction>
Load load_on(const fem::Mesh<2>& mesh, const std::string& tag, Traction traction) {
  std::map<std::uint32_t, Vec<2>> forces;
  for (const fem::Face& face : mesh.boundary.at(tag)) {
    const auto nodes = mesh.nodes_of_face(face);
    const Vec<2> a = mesh.position(nodes[0]), b = mesh.position(nodes[1]), along = b - a;
    const Vec<2> normal = Vec<2>(along[1], -along[0]).normalized(); // the body is on the left
    for (const double N : {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)}) {
      const Vec<2> F = 0.5 * along.norm() * traction(Vec<2>(a + N * along), normal);
      forces.try_emplace(nodes[0], Vec<2>::Zero()).first->second += (1.0 - N) * F;
      forces.try_emplace(nodes[1], Vec<2>::Zero()).first->second += N * F;
    }
  }
  Load load;
  for (const auto& [node, force] : forces) {
    load.nodes.push_back(node);
    load.force.insert(load.force.end(), force.begin(), force.end());
  }
  return load;
}

inline void step_under(fem::Engine<2>& engine, const Load& load) {
  engine.compute_own_forces();
  engine.add_interface_forces(load.nodes, load.force);
  engine.integrate();
}

/// Steps under a load until the body rests: its speed, times the time of the mass damping, is below
/// 1e-4 of its displacement. Damping of twice the lowest frequency is the fastest.
/// @return displacements, [num_nodes][2] m
/// @pre the engine has been started
/// @throws std::runtime_error when it still moves after a million steps
inline std::vector<double> settle(fem::Engine<2>& engine, const Load& load) {
  const auto largest = [](const std::vector<double>& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values))
        .lpNorm<Eigen::Infinity>();
  };
  for (int n = 1; n <= 1'000'000; ++n) {
    step_under(engine, load);
    if (n % 500 == 0 && largest(engine.velocity()) <
                            1e-5 * engine.settings().mass_damping * largest(engine.displacement()))
      return engine.displacement();
  }
  throw std::runtime_error("the body does not come to rest");
}

} // namespace kerf::cases
