#include "fem_core/integrate.hpp"

#include "common/instruction_set.hpp"
#include "fem_core/kernels/advance.hpp"

namespace kerf {

namespace baseline {
template <int dim> void advance(fem::RowsView& view);
}
namespace avx2 {
template <int dim> void advance(fem::RowsView& view);
}
namespace avx512 {
template <int dim> void advance(fem::RowsView& view);
}

namespace fem {

template <int dim>
void advance(const StepSettings<dim>& step, std::size_t count, const double* mass,
             const double* force, const double* prescribed, double* velocity, double* displacement,
             RowSums<dim>& sums) {
  RowsView view{.count = count,
                .mass = mass,
                .force = force,
                .prescribed = prescribed,
                .velocity = velocity,
                .displacement = displacement,
                .time_step = step.time_step,
                .first = step.first,
                .mass_damping = step.mass_damping,
                .local_damping = step.local_damping,
                .gravity = {},
                .kinetic = {},
                .momentum = {},
                .change = {},
                .lost = {}};
  for (int i = 0; i < dim; ++i)
    view.gravity[i] = step.gravity[i];
  dispatch(baseline::advance<dim>, avx2::advance<dim>, avx512::advance<dim>)(view);
  const double half = 0.5 * step.time_step; // of the work, which each of the velocities does
  for (int i = 0; i < dim; ++i) {
    sums.kinetic += 0.5 * view.kinetic[i];
    sums.momentum[i] += 0.5 * view.momentum[i];
    sums.damped += {.before = half * view.lost[0][i], .after = half * view.lost[1][i]};
    sums.gravity += {.before = 0.5 * half * view.gravity[i] * (view.momentum[i] - view.change[i]),
                     .after = 0.5 * half * view.gravity[i] * (view.momentum[i] + view.change[i])};
  }
}

template void advance(const StepSettings<2>&, std::size_t, const double*, const double*,
                      const double*, double*, double*, RowSums<2>&);
template void advance(const StepSettings<3>&, std::size_t, const double*, const double*,
                      const double*, double*, double*, RowSums<3>&);

} // namespace fem
} // namespace kerf
