#include "fem_core/integrate.hpp"

#include "fem_core/parallel.hpp"

#include <cstdint>

namespace kerf::fem {

void step_back_half(const Loads& loads, double time_step, std::span<double> velocity) {
  const auto size = static_cast<std::int64_t>(velocity.size());
#pragma omp parallel for schedule(static) if (size >= least_parallel_size)
  for (std::int64_t k = 0; k < size; ++k) {
    const double a = (loads.own[k] + loads.interface[k]) * loads.inverse_mass[k]; // m/s²
    velocity[k] -= 0.5 * a * time_step;
  }
}

void advance(const Loads& loads, double time_step, std::span<const double> velocity,
             std::span<const double> displacement, std::span<double> next_velocity,
             std::span<double> next_displacement) {
  const auto size = static_cast<std::int64_t>(velocity.size());
#pragma omp parallel for schedule(static) if (size >= least_parallel_size)
  for (std::int64_t k = 0; k < size; ++k) {
    const double a = (loads.own[k] + loads.interface[k]) * loads.inverse_mass[k]; // m/s²
    next_velocity[k] = velocity[k] + a * time_step;
    next_displacement[k] = displacement[k] + next_velocity[k] * time_step;
  }
}

} // namespace kerf::fem
