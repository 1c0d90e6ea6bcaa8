#include "fem_core/integrate.hpp"

#include <cmath>

namespace kerf::fem {
namespace {

template <int dim, bool special>
void advance_rows(const StepSettings<dim>& step, std::size_t count, const double* mass,
                  [[maybe_unused]] const double* weighed, const double* force,
                  [[maybe_unused]] const double* prescribed, double* velocity, double* displacement,
                  RowSums<dim>& sums) {
  constexpr int size = row_size<dim>;
  const double dt = step.time_step, half = 0.5 * step.mass_damping * dt;
  double gravity[size] = {};
  for (int i = 0; i < dim; ++i)
    gravity[i] = step.gravity[i];
  double kinetic[size] = {}, momentum[size] = {}, change[size] = {};
  double lost_before[size] = {}, lost_after[size] = {}, squares[size] = {};
  [[maybe_unused]] double fallen_before[size] = {}, fallen_after[size] = {};
  for (std::size_t k = 0; k < count; ++k) {
    const double m = mass[k], of_step = dt / m;
    for (int i = 0; i < size; ++i) {
      const std::size_t at = k * size + static_cast<std::size_t>(i);
      double before = velocity[at], after = 0.0;
      if constexpr (special) {
        const double w = weighed == nullptr ? m : weighed[k], f = force[at] + w * gravity[i];
        const bool is_free = prescribed == nullptr || std::isnan(prescribed[at]);
        const double sign = before > 0.0 ? 1.0 : before < 0.0 ? -1.0 : 0.0;
        const double net = f - step.local_damping * sign * std::abs(f);
        if (is_free && step.first)
          before -= 0.5 * of_step * net;
        after = !is_free    ? prescribed[at]
                : step.stop ? 0.5 * of_step * f
                            : ((1.0 - half) * before + of_step * net) / (1.0 + half);
        double resisted = 0.0; // N
        if (is_free)
          resisted = step.stop ? f - (after - before) / of_step
                               : f - net + step.mass_damping * m * 0.5 * (before + after);
        lost_before[i] += resisted * before;
        lost_after[i] += resisted * after;
        fallen_before[i] += w * before;
        fallen_after[i] += w * after;
        squares[i] += is_free ? f * f : 0.0;
      } else {
        const double f = force[at] + m * gravity[i];
        squares[i] += f * f;
        if (step.first)
          before -= 0.5 * of_step * f;
        after = before + of_step * f;
      }
      velocity[at] = after;
      displacement[at] += dt * after;
      kinetic[i] += m * before * after;
      momentum[i] += m * (before + after);
      change[i] += m * (after - before);
    }
  }
  for (int i = 0; i < dim; ++i) {
    sums.kinetic += 0.5 * kinetic[i];
    sums.momentum[i] += 0.5 * momentum[i];
    sums.damped += {.before = 0.5 * dt * lost_before[i], .after = 0.5 * dt * lost_after[i]};
    if constexpr (special)
      sums.gravity += {.before = 0.5 * dt * gravity[i] * fallen_before[i],
                       .after = 0.5 * dt * gravity[i] * fallen_after[i]};
    else
      sums.gravity += {.before = 0.25 * dt * gravity[i] * (momentum[i] - change[i]),
                       .after = 0.25 * dt * gravity[i] * (momentum[i] + change[i])};
    sums.unbalanced2 += squares[i];
  }
}

} // namespace

template <int dim>
void advance(const StepSettings<dim>& step, std::size_t count, const double* mass,
             const double* weighed, const double* force, const double* prescribed, double* velocity,
             double* displacement, RowSums<dim>& sums) {
  const bool special = prescribed != nullptr || weighed != nullptr || step.mass_damping > 0.0 ||
                       step.local_damping > 0.0 || step.stop;
  (special ? advance_rows<dim, true> : advance_rows<dim, false>)(step, count, mass, weighed, force,
                                                                 prescribed, velocity, displacement,
                                                                 sums);
}

template void advance(const StepSettings<2>&, std::size_t, const double*, const double*,
                      const double*, const double*, double*, double*, RowSums<2>&);
template void advance(const StepSettings<3>&, std::size_t, const double*, const double*,
                      const double*, const double*, double*, double*, RowSums<3>&);

} // namespace kerf::fem
