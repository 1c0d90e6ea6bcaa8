// A box fixed in space, and what the particles in it do on average.
#pragma once

#include "dem_core/contact.hpp"
#include "dem_core/particles.hpp"
#include "dem_core/stress.hpp"

#include <cstddef>
#include <string>

namespace kerf::dem {

/// True when a box holds that image of a point which is nearest to its centre.
template <int dim>
bool contains(const Box<dim>& box, const Period<dim>& period, const Vec<dim>& point) {
  const Vec<dim> centre = 0.5 * (box.lower + box.upper);
  return box.contains(centre + period.shortest(point - centre));
}

template <int dim> struct Probe {
  std::string name;
  Box<dim> box;
};

/// Means over a box, which sees every particle and contact once. Means of nothing are not a number.
template <int dim> struct Reading {
  std::size_t particles = 0;        // with their centre in the box
  Symmetric<dim> stress;            // Pa
  Symmetric<dim> strain;            // since the start; see gauge.hpp
  Vec<dim> velocity;                // by volume, m/s
  double coordination_number = 0.0; // contacts of a particle that are bonded or pressed together
  double solid_fraction = 0.0;      // volume of these particles over that of the box
};

/// The stress is 1 / V sum branch x force over the contacts whose point of contact is in the box,
/// V its volume; forces are those without weight.
/// @see J. Christoffersen, M.M. Mehrabadi & S. Nemat-Nasser, J. Appl. Mech. 48 (1981) 339-344,
///      doi:10.1115/1.3157619
template <int dim>
Reading<dim> read_probe(const Box<dim>& box, const Period<dim>& period,
                        const Contacts<dim>& contacts, const Particles<dim>& particles);

} // namespace kerf::dem
