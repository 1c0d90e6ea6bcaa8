#include "dem_core/integrate.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::dem {

namespace {

/// Puts the given components in place of those that the forces have made.
template <int dim>
void prescribe(PrescribedMotion<dim>& prescribed, const Vec<dim>& velocity_before,
               const Rot<dim>& omega_before, bool is_first_step, Vec<dim>& v, Rot<dim>& omega) {
  for (int axis = 0; axis < dim; ++axis)
    if (prescribed.prescribes(axis)) {
      v[axis] = prescribed.velocity[axis];
      prescribed.velocity_before[axis] = is_first_step ? v[axis] : velocity_before[axis];
    }
  if (prescribed.holds_rotation()) {
    omega = prescribed.angular_velocity;
    prescribed.angular_velocity_before = is_first_step ? omega : omega_before;
  }
}

} // namespace

template <int dim>
double integrate(Particles<dim>& p, const Loads<dim>& loads, Boundary<dim>& boundary,
                 ParticleBlock block, double time_step, bool is_first_step) {
  const double back = is_first_step ? 0.5 * time_step : 0.0; // from t_0 to t_(-1/2), s
  double fastest2 = 0.0;                                     // m²/s²
  for (std::size_t i = block.begin; i < block.end; ++i) {
    const auto a = acceleration(p, loads, i);
    const Vec<dim> v_before = p.velocity[i];
    Vec<dim> v = (v_before - back * a.translation) + time_step * a.translation;            // eq. 4
    Rot<dim> omega = (p.angular_velocity[i] - back * a.rotation) + time_step * a.rotation; // eq. 7
    if (PrescribedMotion<dim>* prescribed = boundary.of(i))
      prescribe(*prescribed, v_before, p.angular_velocity[i], is_first_step, v, omega);
    p.velocity[i] = v;
    p.angular_velocity[i] = omega;
    p.displacement[i] += time_step * v; // eq. 5
    fastest2 = std::max(fastest2, v.squaredNorm());
  }
  return time_step * std::sqrt(fastest2);
}

template double integrate<2>(Particles<2>&, const Loads<2>&, Boundary<2>&, ParticleBlock, double,
                             bool);
template double integrate<3>(Particles<3>&, const Loads<3>&, Boundary<3>&, ParticleBlock, double,
                             bool);

} // namespace kerf::dem
