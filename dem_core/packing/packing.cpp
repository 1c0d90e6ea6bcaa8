#include "dem_core/packing/packing.hpp"

#include "dem_core/neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>

namespace kerf::dem {

namespace {

/// Volume of a particle with the radius one.
template <int dim>
constexpr double unit_volume = dim == 2 ? std::numbers::pi : 4.0 / 3.0 * std::numbers::pi;

template <int dim> double total_volume(std::span<const double> radii) {
  double sum = 0.0;
  for (const double radius : radii)
    sum += particle_volume<dim>(radius);
  return sum;
}

/// Radii whose volumes add up to the solid part of the region.
template <int dim>
std::vector<double> choose_radii(const PackingSettings& settings, double solid, Random& random) {
  const double expected = settings.count.has_value()
                              ? static_cast<double>(*settings.count)
                              : solid / (unit_volume<dim> * mean_of_power(settings.radii, dim));
  if (!(expected >= 0.5) || expected > std::numeric_limits<std::uint32_t>::max())
    throw std::invalid_argument(fmt::format("the region would hold {:.3g} particles", expected));
  std::vector<double> radii =
      draw(settings.radii, static_cast<std::size_t>(std::llround(expected)), random);
  if (settings.count.has_value()) {
    const double scale = std::pow(solid / total_volume<dim>(radii), 1.0 / dim);
    for (double& radius : radii)
      radius *= scale;
  }
  return radii;
}

template <int dim> Vec<dim> random_point(const Region<dim>& region, Random& random) {
  const Box<dim> bounds = region.bounds();
  for (int attempt = 0; attempt < 100'000; ++attempt) {
    Vec<dim> point;
    for (int a = 0; a < dim; ++a)
      point[a] = bounds.lower[a] + random.uniform() * (bounds.upper[a] - bounds.lower[a]);
    if (region.contains(point))
      return point;
  }
  throw std::invalid_argument("the region fills almost nothing of the box around it");
}

template <int dim> void check_room(const Region<dim>& region, const ParticleSet<dim>& particles) {
  for (std::size_t i = 0; i < particles.radii.size(); ++i)
    if (const double depth = region.wall(particles.positions[i]).depth;
        depth < (1.0 - 1e-6) * particles.radii[i])
      throw std::invalid_argument(fmt::format(
          "the region is too narrow for a particle with a radius of {:.4g} m", particles.radii[i]));
}

} // namespace

template <int dim> double particle_volume(double radius) {
  return unit_volume<dim> * std::pow(radius, dim);
}

template <int dim>
ParticleSet<dim> pack(const Region<dim>& region, const PackingSettings& settings) {
  check(settings.radii);
  if (!(settings.porosity > 0.0 && settings.porosity < 1.0))
    throw std::invalid_argument(
        fmt::format("the porosity {} must be between 0 and 1", settings.porosity));
  Random random(settings.seed);
  ParticleSet<dim> particles;
  particles.radii =
      choose_radii<dim>(settings, (1.0 - settings.porosity) * region.volume(), random);
  const double diameter = 2.0 * *std::max_element(particles.radii.begin(), particles.radii.end());
  for (int a = 0; a < dim; ++a)
    if (const double length = region.period().length[a]; length > 0.0 && length < 2.0 * diameter)
      throw std::invalid_argument(
          fmt::format("the period of {} m along {} is below two diameters of {} m", length,
                      "xyz"[a], diameter));
  for (std::size_t i = 0; i < particles.radii.size(); ++i)
    particles.positions.push_back(random_point(region, random));

  constexpr std::size_t most_steps = 5'000;
  relax(region, particles, most_steps);
  check_room(region, particles);
  return particles;
}

template <int dim>
PackingMeasures measure(const ParticleSet<dim>& particles, double volume,
                        const Period<dim>& period) {
  constexpr double touching = 1e-3; // gap over the sum of the radii
  const auto& r = particles.radii;
  const double largest = *std::max_element(r.begin(), r.end());
  PackingMeasures measures;
  double overlapping = 0.0, contacts = 0.0;
  for (const Pair pair :
       find_pairs<dim>(particles.positions, r, 2.0 * touching * largest, period)) {
    const double sum = r[pair.first] + r[pair.second];
    const Vec<dim> branch =
        period.shortest(particles.positions[pair.second] - particles.positions[pair.first]);
    const double overlap = 1.0 - branch.norm() / sum;
    contacts += overlap >= -touching ? 1.0 : 0.0;
    if (overlap <= 0.0)
      continue;
    overlapping += 1.0;
    measures.mean_overlap += overlap;
    measures.largest_overlap = std::max(measures.largest_overlap, overlap);
  }
  measures.mean_overlap /= std::max(1.0, overlapping);
  measures.coordination_number = 2.0 * contacts / static_cast<double>(r.size());
  measures.porosity = 1.0 - total_volume<dim>(r) / volume;
  return measures;
}

template <int dim>
ParticleSet<dim> cut(const ParticleSet<dim>& particles, const Region<dim>& region) {
  ParticleSet<dim> inside;
  for (std::size_t i = 0; i < particles.radii.size(); ++i)
    if (region.contains(particles.positions[i])) {
      inside.positions.push_back(particles.positions[i]);
      inside.radii.push_back(particles.radii[i]);
    }
  return inside;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template double particle_volume<dim>(double);                                                    \
  template ParticleSet<dim> pack<dim>(const Region<dim>&, const PackingSettings&);                 \
  template PackingMeasures measure<dim>(const ParticleSet<dim>&, double, const Period<dim>&);      \
  template ParticleSet<dim> cut<dim>(const ParticleSet<dim>&, const Region<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
