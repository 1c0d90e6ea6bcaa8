// The 1D model problem: a chain of discs that runs into a bar of elements. Chain and bar have the
// same stiffness and the same mass per length.
#pragma once

#include "coupler/broker/coupling.hpp"
#include "dem_core/settings.hpp"
#include "fem_core/mesh/box.hpp"
#include "fem_core/settings.hpp"
#include "tests/cases/coupled_system.hpp"

#include <numbers>

namespace kerf::cases {

struct ChainAndBar {
  double spacing = 1e-3;          // d, m
  int element_ratio = 1;          // h / d
  int width = 4;                  // of the overlap, elements
  int particles_outside = 12;     // of the overlap
  int elements_outside = 12;      // of the overlap
  double density = 3000.0;        // of the discs, kg/m³
  double normal_stiffness = 2e10; // N/m per metre
  coupler::OverlapSettings overlap{.name = "joint", .boundary = "left"};

  double h() const { return spacing * element_ratio; }
  double zone() const { return width * h(); } // m
  double particle_mass() const { return density * std::numbers::pi * spacing * spacing / 4.0; }
  int particles() const { return particles_outside + width * element_ratio; }
  double particle_x(int i) const { return (i - particles_outside + 0.5) * spacing; } // m

  dem::Settings<2> dem_settings() const {
    dem::Settings<2> s;
    for (int i = 0; i < particles(); ++i) { // half a spacing off both ends of the overlap
      s.positions.emplace_back(particle_x(i), 0.5 * h());
      s.radii.push_back(0.5 * spacing);
    }
    s.material.density = density;
    s.material.normal_stiffness = normal_stiffness;
    return s;
  }
  fem::Mesh<2> mesh() const {
    const int n = width + elements_outside;
    return fem::make_box<2>({.origin = Vec<2>::Zero(),
                             .size = Vec<2>(n * h(), h()),
                             .count = {static_cast<std::uint32_t>(n), 1}});
  }
  fem::Settings<2> fem_settings() const {
    fem::Settings<2> s;
    // E h (area of the bar per metre) = k_n d;  rho h d = m
    s.materials = {{.material = {.law = fem::IsotropicElastic::from_young(
                                     particle_mass() / (spacing * h()),
                                     normal_stiffness * spacing / h(), 0.0)},
                    .region = {},
                    .box = {}}};
    fem::BoundarySetting<2> straight;
    straight.tag = "all";
    straight.components = {false, true};
    s.boundary.push_back(straight);
    return s;
  }
  coupler::OverlapSettings overlap_settings() const {
    coupler::OverlapSettings s = overlap;
    s.width = zone();
    return s;
  }
  CoupledSystem system(const dem::Settings<2>& particles_in, const fem::Settings<2>& bar) const {
    return {particles_in, mesh(), bar, overlap_settings()};
  }
  CoupledSystem system() const { return system(dem_settings(), fem_settings()); }
};

} // namespace kerf::cases
