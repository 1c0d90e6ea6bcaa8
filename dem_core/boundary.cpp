#include "dem_core/boundary.hpp"

#include <cmath>
#include <numbers>

namespace kerf::dem {

namespace {

/// Share of the amplitude that a Hann motion has reached at time t.
double hann(double t, double duration) {
  if (t <= 0.0 || t >= duration)
    return 0.0;
  return 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * t / duration));
}

/// Velocity of the step that begins at t_n, m/s.
template <int dim>
Vec<dim> step_velocity(const Prescription<dim>& p, std::uint64_t step, double dt) {
  switch (p.motion) {
  case Motion::fixed:
    return Vec<dim>::Zero();
  case Motion::velocity:
    return p.velocity;
  case Motion::hann: {
    const auto n = static_cast<double>(step);
    return p.amplitude * ((hann((n + 1.0) * dt, p.duration) - hann(n * dt, p.duration)) / dt);
  }
  }
  return Vec<dim>::Zero();
}

} // namespace

template <int dim>
Boundary<dim>::Boundary(std::vector<Prescription<dim>> prescriptions,
                        std::span<const Vec<dim>> reference, std::uint64_t begin)
    : prescriptions_(std::move(prescriptions)), begin_(begin), selected_(prescriptions_.size()) {
  if (prescriptions_.empty())
    return;
  std::vector<std::uint8_t> components(reference.size(), 0);
  for (std::size_t k = 0; k < prescriptions_.size(); ++k)
    for (std::uint32_t i = 0; i < reference.size(); ++i)
      if (prescriptions_[k].box.contains(reference[i])) {
        selected_[k].push_back(i);
        components[i] = static_cast<std::uint8_t>(components[i] | prescriptions_[k].components);
      }
  entry_.assign(reference.size(), 0);
  for (std::uint32_t i = 0; i < components.size(); ++i)
    if (components[i] != 0) {
      particles_.push_back(i);
      motion_.emplace_back().components = components[i];
      entry_[i] = static_cast<std::uint32_t>(motion_.size());
    }
}

template <int dim> void Boundary<dim>::advance(std::uint64_t step, double time_step) {
  for (std::size_t k = 0; k < prescriptions_.size(); ++k) {
    const Vec<dim> v = step_velocity(prescriptions_[k], step - begin_, time_step);
    for (const std::uint32_t i : selected_[k])
      for (int a = 0; a < dim; ++a)
        if ((prescriptions_[k].components >> a & 1u) != 0)
          of(i)->velocity[a] = v[a];
  }
}

template class Boundary<2>;
template class Boundary<3>;

} // namespace kerf::dem
