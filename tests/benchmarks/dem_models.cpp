#include "tests/benchmarks/dem_models.hpp"

#include "dem_core/bonding.hpp"
#include "dem_core/lattice.hpp"
#include "dem_core/packing/packing.hpp"
#include "dem_core/packing/random.hpp"
#include "dem_core/program/packing_cache.hpp"
#include "common/spatial_order.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

namespace kerf::benchmarks {
namespace {

constexpr double mean_radius = 0.5e-3; // m
constexpr double strain = 2e-4;        // of the waves

const std::array<Workload, 6> workloads = {{{"bonded_3d_50k", 3, true, 50'000},
                                            {"bonded_3d_500k", 3, true, 500'000},
                                            {"bonded_2d_30k", 2, true, 30'000},
                                            {"friction_3d_50k", 3, false, 50'000},
                                            {"friction_3d_500k", 3, false, 500'000},
                                            {"friction_2d_30k", 2, false, 30'000}}};

/// Bonds looser than jammed, so that fewer particles touch than are bonded; friction denser.
double porosity_of(const Workload& workload) {
  if (workload.dim == 2)
    return workload.bonded ? 0.18 : 0.15;
  return workload.bonded ? 0.40 : 0.35;
}

/// Bonds a particle, times two.
template <int dim> constexpr double coordination_number = dim == 2 ? 2 * 2.07 : 2 * 3.1;

dem::Radii radii() {
  dem::Radii radii;
  radii.least = 0.8 * mean_radius;
  radii.most = 1.2 * mean_radius;
  return radii;
}

/// A periodic packing; a large one is made of copies, 2 along each axis, because packing takes
/// long.
template <int dim> dem::ParticleSet<dim> make_packing(const Workload& workload) {
  const int copies = workload.particles > 100'000 ? 2 : 1; // along each axis
  const double edge = edge_of<dim>(workload) / copies;     // m
  std::size_t images = 1;
  std::array<bool, dim> periodic;
  periodic.fill(true);
  for (int a = 0; a < dim; ++a)
    images *= copies;
  const dem::ParticleSet<dim> one = dem::pack<dim>(
      dem::BoxRegion<dim>({Vec<dim>::Zero(), Vec<dim>::Constant(edge)}, periodic),
      {.radii = radii(), .porosity = porosity_of(workload), .count = workload.particles / images});
  dem::ParticleSet<dim> all;
  for (std::size_t image = 0; image < images; ++image) {
    Vec<dim> shift; // m
    for (int a = 0; a < dim; ++a)
      shift[a] = edge * static_cast<double>(image >> a & 1u);
    for (std::size_t i = 0; i < one.radii.size(); ++i) {
      all.positions.push_back(one.positions[i] + shift);
      all.radii.push_back(one.radii[i]);
    }
  }
  return all;
}

template <int dim> dem::ParticleSet<dim> in_spatial_order(const dem::ParticleSet<dim>& particles) {
  dem::ParticleSet<dim> ordered;
  for (const std::uint32_t i : kerf::spatial_order<dim>(particles.positions)) {
    ordered.positions.push_back(particles.positions[i]);
    ordered.radii.push_back(particles.radii[i]);
  }
  return ordered;
}

template <int dim> dem::ParticleSet<dim> packing_of(const Workload& workload) {
  const std::string description =
      fmt::format("kerf bench dem {} porosity {} (version {})", workload.name,
                  porosity_of(workload), dem::packing_version);
  const auto kept = dem::find_packing(dem::packing_cache(), description);
  dem::ParticleSet<dim> particles;
  if (kept) {
    particles.radii = kept->radii;
    for (std::size_t i = 0; i < kept->radii.size(); ++i)
      particles.positions.emplace_back(Eigen::Map<const Vec<dim>>(&kept->positions[i * dim]));
    return particles;
  }
  fmt::print(stderr, "making the packing of {} (once)…\n", workload.name);
  particles = in_spatial_order(make_packing<dim>(workload));
  Packing to_keep{.dim = dim, .positions = {}, .radii = particles.radii};
  for (const Vec<dim>& x : particles.positions)
    to_keep.positions.insert(to_keep.positions.end(), x.begin(), x.end());
  dem::keep_packing(dem::packing_cache(), description, to_keep);
  return particles;
}

/// Rock in 2D, per metre of thickness; in 3D the same stiffness per millimetre.
template <int dim> dem::Material rock() {
  dem::Material material;
  material.density = 2600.0;
  material.normal_stiffness = dim == 2 ? 1e10 : 1e7;
  material.tangential_stiffness = 0.4 * material.normal_stiffness;
  material.friction = 0.5;
  material.tensile_strength = 3 * strain * 2 * mean_radius * material.normal_stiffness;
  material.shear_strength = material.tensile_strength;
  return material;
}

/// A compression and a shear wave, one wave length in the model.
template <int dim> std::vector<dem::InitialCondition<dim>> waves(double edge) {
  std::vector<dem::InitialCondition<dim>> initial;
  for (const int component : {0, 1}) {
    dem::Pulse pulse;
    pulse.amplitude = strain * edge / std::numbers::pi;
    pulse.center = 0.5 * edge;
    pulse.length = edge;
    pulse.wave_speed = 2500.0;
    pulse.component = component;
    initial.emplace_back().pulse = pulse;
  }
  return initial;
}

template <int dim> void bond(dem::Settings<dim>& settings) {
  settings.gap_tolerance = dem::gap_tolerance_for<dim>(coordination_number<dim>, settings.positions,
                                                       settings.radii, settings.period);
}

} // namespace

std::span<const Workload> dem_workloads() {
  return workloads;
}

template <int dim> double edge_of(const Workload& workload) {
  const double particle = dem::particle_volume<dim>(1.0) * dem::mean_of_power(radii(), dim);
  return std::pow(static_cast<double>(workload.particles) * particle /
                      (1.0 - porosity_of(workload)),
                  1.0 / dim);
}

template <int dim> dem::Settings<dim> settings_of(const Workload& workload) {
  dem::ParticleSet<dim> particles = packing_of<dim>(workload);
  const double edge = edge_of<dim>(workload);
  dem::Settings<dim> settings;
  settings.positions = std::move(particles.positions);
  settings.radii = std::move(particles.radii);
  settings.material = rock<dim>();
  settings.initial = waves<dim>(edge);
  if (workload.bonded) {
    bond(settings);
  } else {
    settings.period.length.setConstant(edge);
    settings.gap_tolerance = -1.0; // no pair is bonded, however large its overlap
  }
  return settings;
}

dem::Settings<3> shaken_lattice(std::size_t particles) {
  const int cubes = static_cast<int>(std::lround(std::cbrt(static_cast<double>(particles) / 4)));
  dem::ParticleSet<3> lattice;
  lattice.positions = dem::lattice_points<3>(
      {dem::LatticeType::fcc, 2 * mean_radius, Vec<3>::Zero(), {cubes, cubes, cubes}});
  lattice.radii.assign(lattice.positions.size(), mean_radius);
  dem::Random random(1);
  for (Vec<3>& x : lattice.positions)
    for (double& component : x)
      component += 0.1 * mean_radius * (2.0 * random.uniform() - 1.0);
  lattice = in_spatial_order(lattice);

  dem::Settings<3> settings;
  settings.positions = std::move(lattice.positions);
  settings.radii = std::move(lattice.radii);
  settings.material = rock<3>();
  settings.initial = waves<3>(cubes * 2 * mean_radius * std::numbers::sqrt2);
  bond(settings);
  return settings;
}

template double edge_of<2>(const Workload&);
template double edge_of<3>(const Workload&);
template dem::Settings<2> settings_of<2>(const Workload&);
template dem::Settings<3> settings_of<3>(const Workload&);

} // namespace kerf::benchmarks
