#include "dem_core/boundary.hpp"

#include <cassert>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

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
  case Motion::table: {
    const double now = static_cast<double>(step) * dt, then = static_cast<double>(step + 1) * dt;
    Vec<dim> v;
    for (int a = 0; a < dim; ++a)
      v[a] = p.velocities[a].mean(now, then);
    return v;
  }
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
    : prescriptions_(std::move(prescriptions)), begin_(begin), sets_(prescriptions_.size()) {
  if (prescriptions_.empty())
    return;
  std::vector<std::uint8_t> components(reference.size(), 0);
  for (std::size_t k = prescriptions_.size(); k-- > 0;) { // the later one counts
    Prescription<dim>& p = prescriptions_[k];
    if (!(p.axis.norm() > 0.0) || !p.axis.allFinite())
      throw std::invalid_argument("the axis of a prescribed rotation must have a length");
    p.axis.normalize();
    for (std::uint32_t i = 0; i < reference.size(); ++i)
      if (p.box.contains(reference[i])) {
        sets_[k].particles.push_back(i);
        sets_[k].components.push_back(static_cast<std::uint8_t>(p.components & ~components[i]));
        components[i] = static_cast<std::uint8_t>(components[i] | p.components);
      }
  }
  entry_.assign(reference.size(), 0);
  for (std::uint32_t i = 0; i < components.size(); ++i)
    if (components[i] != 0) {
      motion_.emplace_back().components = components[i];
      entry_[i] = static_cast<std::uint32_t>(motion_.size());
    }
}

template <int dim>
void Boundary<dim>::carry(std::span<const std::uint32_t> carried, std::size_t particles) {
  entry_.resize(particles, 0);
  for (const std::uint32_t i : carried) {
    assert(entry_[i] == 0);
    motion_.emplace_back().components = (1u << (dim + 1)) - 1u;
    entry_[i] = static_cast<std::uint32_t>(motion_.size());
  }
}

template <int dim> void Boundary<dim>::advance(std::uint64_t step, double time_step) {
  const double now = static_cast<double>(step - begin_) * time_step;
  const double then = static_cast<double>(step - begin_ + 1) * time_step;
  for (std::size_t k = 0; k < prescriptions_.size(); ++k) {
    const Vec<dim> v = step_velocity(prescriptions_[k], step - begin_, time_step);
    const Rot<dim> omega = prescriptions_[k].rotation_rate.mean(now, then) * prescriptions_[k].axis;
    for (std::size_t entry = 0; entry < sets_[k].particles.size(); ++entry) {
      const unsigned components = sets_[k].components[entry];
      if (components == 0)
        continue;
      PrescribedMotion<dim>& motion = *of(sets_[k].particles[entry]);
      for (int a = 0; a < dim; ++a)
        if ((components >> a & 1u) != 0)
          motion.velocity[a] = v[a];
      if ((components >> dim & 1u) != 0)
        motion.angular_velocity = omega;
    }
  }
}

template class Boundary<2>;
template class Boundary<3>;

} // namespace kerf::dem
