// How the radii of a packing are distributed.
#pragma once

#include "dem_core/packing/random.hpp"

#include <cstddef>
#include <vector>

namespace kerf::dem {

enum class RadiusLaw {
  uniform, // every radius from least to most is as likely
  power,   // density proportional to r^-exponent from least to most
  list,    // some radii, each with a weight
};

struct Radii {
  RadiusLaw law = RadiusLaw::uniform;
  double least = 0.0, most = 0.0; // of uniform and power, m
  double exponent = 0.0;          // of power
  std::vector<double> values;     // of list, m
  std::vector<double> weights;    // of list: number of particles, up to a factor; empty: all equal
};

/// @throws std::invalid_argument when a radius is not positive, least exceeds most, or a weight is
///         negative, not given for each value, or all of them are zero
void check(const Radii& radii);

/// The radius below which a share of the particles lies, m.
/// @param share  in [0, 1]
double quantile(const Radii& radii, double share);

/// Mean of r^power over the particles, m^power.
double mean_of_power(const Radii& radii, int power);

/// Radii in random order, m: one from each of `count` equal shares of the particles, so that a
/// small packing follows the law as closely as a large one.
std::vector<double> draw(const Radii& radii, std::size_t count, Random& random);

} // namespace kerf::dem
