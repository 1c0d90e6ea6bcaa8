// A particle and a finite element engine coupled in one process, without broker or channel: what
// tests of the coupling physics step through.
#pragma once

#include "coupler/broker/coupling.hpp"
#include "dem_core/engine.hpp"
#include "fem_core/engine.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kerf::cases {

inline coupler::Declaration declare(const dem::Engine<2>& engine) {
  coupler::Declaration d;
  for (std::size_t i = 0; i < engine.size(); ++i) {
    const Vec<2> x = engine.particles().reference[i];
    d.ids.push_back(static_cast<std::int64_t>(i));
    d.positions.insert(d.positions.end(), x.begin(), x.end());
    d.radii.push_back(engine.particles().radius[i]);
  }
  d.stiffness = engine.stiffness();
  return d;
}

inline coupler::Declaration declare(const fem::Engine<2>& engine) {
  coupler::Declaration d;
  d.ids.resize(engine.mesh().num_nodes());
  std::iota(d.ids.begin(), d.ids.end(), 0);
  d.positions = engine.mesh().positions;
  d.nodes_per_element = 4;
  d.elements = engine.mesh().blocks[0].nodes;
  for (const auto& [tag, faces] : engine.mesh().boundary)
    for (const fem::Face& face : faces)
      for (const std::uint32_t a : engine.mesh().nodes_of_face(face))
        d.boundary[tag].push_back(a);
  return d;
}

/// Steps as run_engine() and the broker do.
class CoupledSystem {
public:
  CoupledSystem(const dem::Settings<2>& particles, const fem::Mesh<2>& mesh,
                const fem::Settings<2>& elements, const coupler::OverlapSettings& overlap)
      : dem(particles), fem(mesh, elements),
        coupling(coupler::make_overlap(overlap, declare(dem), declare(fem))) {
    dem.set_weights(coupling->side(0).weights);
    fem.set_weights(coupling->side(1).weights);
    double largest = std::max(dem.step_limit().omega2, fem.step_limit().omega2);
    std::vector<double> inverse_mass[2], omega2[2];
    for (int s = 0; s < 2; ++s) {
      const auto& points = coupling->side(s).points;
      inverse_mass[s].resize(2 * points.size());
      omega2[s].resize(points.size());
      for (auto* field : {&position_[s], &velocity_[s], &own_[s], &force_[s]})
        field->assign(2 * points.size(), 0.0);
    }
    dem.inverse_mass(coupling->side(0).points, inverse_mass[0]);
    fem.inverse_mass(coupling->side(1).points, inverse_mass[1]);
    dem.omega2(coupling->side(0).points, omega2[0]);
    fem.omega2(coupling->side(1).points, omega2[1]);
    const auto [a, b] =
        coupling->coupled_omega2({inverse_mass[0], omega2[0]}, {inverse_mass[1], omega2[1]});
    critical_step = 2.0 / std::sqrt(std::max({largest, a, b}));
  }

  void start(double time_step) {
    coupling->start(time_step);
    dem.start(time_step);
    fem.start(time_step);
  }

  void step() {
    const auto &particles = coupling->side(0).points, &nodes = coupling->side(1).points;
    dem.motion(particles, position_[0], velocity_[0]);
    fem.motion(nodes, position_[1], velocity_[1]);
    dem.compute_own_forces();
    fem.compute_own_forces();
    dem.own_forces(particles, own_[0]);
    fem.own_forces(nodes, own_[1]);
    const coupler::Coupling::Motion a{position_[0], velocity_[0], own_[0]},
        b{position_[1], velocity_[1], own_[1]};
    coupling->compute(steps_done, a, b, force_[0], force_[1]);
    coupling->enter_books(steps_done, a, b, force_[0], force_[1]);
    dem.add_interface_forces(particles, force_[0]);
    fem.add_interface_forces(nodes, force_[1]);
    dem.integrate();
    fem.integrate();
    ++steps_done;
  }

  /// Kinetic, elastic and stored energy of everything at the last t_n, J.
  double energy() const {
    const dem::Energies d = dem.energies();
    const fem::Energies f = fem.energies();
    return d.kinetic + d.elastic + f.kinetic + f.elastic + coupling->book().stored_energy;
  }

  /// Forces of the coupling on particles (0) and nodes (1) in the last step, [n][2] N.
  const std::vector<double>& force(int side) const { return force_[side]; }

  dem::Engine<2> dem;
  fem::Engine<2> fem;
  std::unique_ptr<coupler::Coupling> coupling;
  double critical_step = 0.0;
  std::uint64_t steps_done = 0;

private:
  std::vector<double> position_[2], velocity_[2], own_[2], force_[2];
};

} // namespace kerf::cases
