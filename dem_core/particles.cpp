#include "dem_core/particles.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

namespace kerf::dem {

template <int dim>
Particles<dim> make_particles(std::span<const Vec<dim>> positions, std::span<const double> radii,
                              double density, std::span<const std::uint32_t> ids) {
  const std::size_t n = positions.size();
  if (n == 0)
    throw std::invalid_argument("there are no particles");
  if (radii.size() != n)
    throw std::invalid_argument(fmt::format("{} positions but {} radii", n, radii.size()));
  if (!ids.empty() && ids.size() != n)
    throw std::invalid_argument(fmt::format("{} positions but {} ids", n, ids.size()));
  Particles<dim> particles;
  particles.ids.assign(ids.begin(), ids.end());
  if (ids.empty()) {
    particles.ids.resize(n);
    std::iota(particles.ids.begin(), particles.ids.end(), 0u);
  }
  if (!(density > 0.0) || !std::isfinite(density))
    throw std::invalid_argument(fmt::format("density {} kg/m³ must be positive", density));
  for (std::size_t i = 0; i < n; ++i) {
    if (!positions[i].allFinite())
      throw std::invalid_argument(
          fmt::format("the position of particle {} is not finite", particles.ids[i]));
    if (!(radii[i] > 0.0) || !std::isfinite(radii[i]))
      throw std::invalid_argument(
          fmt::format("radius {} m of particle {} must be positive", radii[i], particles.ids[i]));
  }

  particles.reference.assign(positions.begin(), positions.end());
  particles.radius.assign(radii.begin(), radii.end());
  particles.density.assign(n, density);
  particles.mass.resize(n);
  particles.inertia.resize(n);
  particles.displacement.assign(n, Vec<dim>::Zero());
  particles.velocity.assign(n, Vec<dim>::Zero());
  particles.angular_velocity.assign(n, Rot<dim>::Zero());
  blend(particles, std::span<const double>());
  return particles;
}

template <int dim> void blend(Particles<dim>& particles, std::span<const double> weight) {
  if (!weight.empty() && weight.size() != particles.size())
    throw std::invalid_argument(
        fmt::format("{} weights for {} particles", weight.size(), particles.size()));
  particles.weight.assign(weight.begin(), weight.end());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const double w = weight.empty() ? 1.0 : weight[i];
    if (!(w >= 0.0) || !std::isfinite(w))
      throw std::invalid_argument(
          fmt::format("weight {} of particle {} must not be negative", w, particles.ids[i]));
    const double r = particles.radius[i];
    particles.mass[i] =
        bounded_share(w) * volume_of_radius<dim>(r) * particles.density[i]; // eqs 48-49
    particles.inertia[i] = (dim == 2 ? 0.5 : 0.4) * particles.mass[i] * r * r;
  }
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template Particles<dim> make_particles<dim>(std::span<const Vec<dim>>, std::span<const double>,  \
                                              double, std::span<const std::uint32_t>);             \
  template void blend<dim>(Particles<dim>&, std::span<const double>);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
