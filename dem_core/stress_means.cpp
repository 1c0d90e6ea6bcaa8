#include "dem_core/stress_means.hpp"

#include "dem_core/in_situ_stress.hpp"
#include "dem_core/packing/power_cells.hpp"

#include <cmath>

namespace kerf::dem {

template <int dim>
StressMeans<dim>::StressMeans(const InSituStress<dim>& stress, const Vec<dim>& gravity,
                              const Particles<dim>& p, const Period<dim>& period)
    : share_(p.size(), 0.0), up_(Vec<dim>::Zero()), depth_(p.size(), 0.0) {
  measure_cells(p, period);
  if (stress.K0) {
    up_ = -gravity.normalized();
    measure_depth(p);
  }
  for (std::size_t i = 0; i < p.size(); ++i)
    density_ += share_[i] > 0.0 ? p.weighed_mass(i) / volume_ : 0.0;
  set_wanted(stress, gravity.norm());
}

template <int dim>
void StressMeans<dim>::measure_cells(const Particles<dim>& p, const Period<dim>& period) {
  if ((period.length.array() > 0.0).all()) {
    volume_ = period.length.prod();
    share_.assign(p.size(), 1.0 / static_cast<double>(p.size()));
    return;
  }
  const PowerCells cells = power_cells<dim>(p.reference, p.radius);
  for (std::size_t i = 0; i < p.size(); ++i)
    volume_ += cells.is_closed[i] ? cells.volume[i] : 0.0;
  if (!(volume_ > 0.0))
    throw ImpossibleStress("no particle has neighbours on all sides");
  for (std::size_t i = 0; i < p.size(); ++i)
    share_[i] = cells.is_closed[i] ? cells.volume[i] / volume_ : 0.0;
}

template <int dim> void StressMeans<dim>::measure_depth(const Particles<dim>& p) {
  for (std::size_t i = 0; i < p.size(); ++i)
    height_ += share_[i] * up_.dot(p.reference[i]);
  double square = 0.0; // m²
  for (std::size_t i = 0; i < p.size(); ++i) {
    depth_[i] = height_ - up_.dot(p.reference[i]);
    square += share_[i] * depth_[i] * depth_[i];
  }
  deviation_ = std::sqrt(square);
  for (double& depth : depth_)
    depth /= deviation_ > 0.0 ? deviation_ : 1.0;
}

template <int dim>
void StressMeans<dim>::set_wanted(const InSituStress<dim>& stress, double gravity) {
  wanted_ = Values::Zero(stress.K0 && deviation_ > 0.0 ? most : components(dim));
  wanted_.template head<components(dim)>() = stress.uniform;
  if (!stress.K0)
    return;
  const Matrix<dim> along = up_ * up_.transpose();
  const Symmetric<dim> of_one = // of a vertical pressure
      symmetric_part<dim>(-along - *stress.K0 * (Matrix<dim>::Identity() - along));
  const double weight = density_ * gravity; // N/m³
  wanted_.template head<components(dim)>() +=
      (stress.overburden + weight * (stress.surface - height_)) * of_one;
  if (size() == most)
    wanted_.template tail<components(dim)>() = weight * deviation_ * of_one;
}

template <int dim> double StressMeans<dim>::shape(Eigen::Index k, const Spring<dim>& spring) const {
  if (k < components(dim))
    return 1.0;
  const double first = depth_[spring.first];
  return spring.second == Spring<dim>::ground
             ? first
             : first + spring.share * (depth_[spring.second] - first);
}

template <int dim>
auto StressMeans<dim>::of(std::span<const Spring<dim>> springs,
                          std::span<const Vec<dim>> force) const -> Values {
  Values sum = Values::Zero(size());
  for (std::size_t k = 0; k < springs.size(); ++k) {
    const Spring<dim>& s = springs[k];
    const Symmetric<dim> dyad = symmetric_part<dim>(s.branch * force[k].transpose()); // N m
    add(s.first, s.share, dyad, sum);
    if (s.second != Spring<dim>::ground)
      add(s.second, 1.0 - s.share, dyad, sum);
  }
  return sum;
}

template <int dim>
void StressMeans<dim>::add(std::uint32_t i, double share, const Symmetric<dim>& dyad,
                           Values& sum) const {
  if (!(share_[i] > 0.0))
    return;
  sum.template head<components(dim)>() += share / volume_ * dyad;
  if (size() == most)
    sum.template tail<components(dim)>() += depth_[i] * share / volume_ * dyad;
}

template class StressMeans<2>;
template class StressMeans<3>;

} // namespace kerf::dem
