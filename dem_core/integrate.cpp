#include "dem_core/integrate.hpp"

namespace kerf::dem {

template <int dim>
void integrate(Particles<dim>& p, const Loads<dim>& loads, const Boundary<dim>& boundary,
               double time_step, bool is_first_step) {
  const double back = is_first_step ? 0.5 * time_step : 0.0; // from t_0 to t_(-1/2), s
  const auto count = static_cast<std::int64_t>(p.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < count; ++i) {
    const Vec<dim> a = (loads.force[i] + loads.interface_force[i]) / p.mass[i]; // m/s²; eq. 3
    const Rot<dim> alpha = loads.moment[i] / p.inertia[i];                      // rad/s²; eq. 6
    Vec<dim> v_before = p.velocity[i] - back * a;
    Rot<dim> omega_before = p.angular_velocity[i] - back * alpha;
    Vec<dim> v = v_before + time_step * a;             // eq. 4
    Rot<dim> omega = omega_before + time_step * alpha; // eq. 7

    if (boundary.components(i) != 0) {
      for (int axis = 0; axis < dim; ++axis)
        if (boundary.prescribes(i, axis)) {
          v[axis] = boundary.velocity(i)[axis];
          if (is_first_step)
            v_before[axis] = v[axis];
        }
      if (boundary.holds_rotation(i)) {
        omega.setZero();
        omega_before.setZero();
      }
    }
    p.velocity_before[i] = v_before;
    p.angular_velocity_before[i] = omega_before;
    p.velocity[i] = v;
    p.angular_velocity[i] = omega;
    p.displacement[i] += time_step * v; // eq. 5
  }
}

template void integrate<2>(Particles<2>&, const Loads<2>&, const Boundary<2>&, double, bool);
template void integrate<3>(Particles<3>&, const Loads<3>&, const Boundary<3>&, double, bool);

} // namespace kerf::dem
