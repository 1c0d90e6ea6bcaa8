// Mean stresses of a network of springs, and those that are wanted in situ.
#pragma once

#include "dem_core/settings.hpp"
#include "dem_core/spring_network.hpp"
#include "dem_core/stress.hpp"

#include <span>
#include <vector>

namespace kerf::dem {

inline constexpr int components(int dim) {
  return dim == 2 ? 3 : 6;
}

/// Taken over the cells of particles with neighbours on all sides; where space repeats along all
/// axes, over all of it. With K0 there are also those of the stress times the scaled depth.
template <int dim> class StressMeans {
public:
  static constexpr int most = 2 * components(dim);
  using Values = Eigen::VectorXd; // Pa

  /// @throws ImpossibleStress when no particle has neighbours on all sides
  StressMeans(const InSituStress<dim>& stress, const Vec<dim>& gravity,
              const Particles<dim>& particles, const Period<dim>& period);

  Eigen::Index size() const { return wanted_.size(); }
  const Values& wanted() const { return wanted_; }
  double bulk_density() const { return density_; } // kg/m³

  /// @param force  [springs] on the first of each, N
  Values of(std::span<const Spring<dim>> springs, std::span<const Vec<dim>> force) const;

  /// How a field that makes mean k varies: even, or with the scaled depth.
  double shape(Eigen::Index k, const Spring<dim>& spring) const;

private:
  void measure_cells(const Particles<dim>& particles, const Period<dim>& period);
  void measure_depth(const Particles<dim>& particles);
  void set_wanted(const InSituStress<dim>& stress, double gravity);
  void add(std::uint32_t particle, double share, const Symmetric<dim>& dyad, Values& sum) const;

  double volume_ = 0.0;                   // m³
  std::vector<double> share_;             // [particles] of the volume; 0: not measured
  Vec<dim> up_;                           // against gravity, of length one
  double height_ = 0.0, deviation_ = 0.0; // mean along it, and from the mean, m
  std::vector<double> depth_;             // [particles] below the mean, over the deviation
  double density_ = 0.0;
  Values wanted_;
};

} // namespace kerf::dem
