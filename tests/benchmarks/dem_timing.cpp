#include "tests/benchmarks/dem_timing.hpp"

#include "tests/benchmarks/statistics.hpp"

#include <omp.h>

#include <cmath>
#include <stdexcept>

namespace kerf::benchmarks {
namespace {

template <int dim> double seconds_of_step(dem::Engine<dim>& engine) {
  const double start = omp_get_wtime();
  engine.integrate();
  return omp_get_wtime() - start;
}

} // namespace

template <int dim> double time_step_of(const dem::Engine<dim>& engine) {
  return 0.2 * 2.0 / std::sqrt(engine.step_limit().omega2);
}

template <int dim> double seconds_per_step(dem::Engine<dim> engine, int steps) {
  for (int n = 0; n < 5 + steps / 10; ++n)
    seconds_of_step(engine);
  double seconds = 0.0;
  for (int n = 0; n < steps; ++n)
    seconds += seconds_of_step(engine);
  if (engine.renewals() > 0)
    throw std::runtime_error("the list of contacts was renewed in a timed block");
  return seconds / steps;
}

template <int dim> double renewal_in_steps(dem::Settings<dim> settings, double time_step) {
  constexpr int renewals = 5, steps_between = 25;
  const double way = 0.1 * settings.radii.front(); // about what wears the skin, m
  settings.initial.resize(1);
  settings.initial[0] = {};
  settings.initial[0].velocity[0] = way / (steps_between * time_step);
  dem::Engine<dim> engine(settings);
  engine.start(time_step);
  std::vector<double> plain, with_renewal; // s
  while (with_renewal.size() < renewals) {
    const std::size_t before = engine.renewals();
    const double seconds = seconds_of_step(engine);
    (engine.renewals() > before ? with_renewal : plain).push_back(seconds);
  }
  return (median(with_renewal) - median(plain)) / median(plain);
}

template double time_step_of<2>(const dem::Engine<2>&);
template double time_step_of<3>(const dem::Engine<3>&);
template double seconds_per_step<2>(dem::Engine<2>, int);
template double seconds_per_step<3>(dem::Engine<3>, int);
template double renewal_in_steps<2>(dem::Settings<2>, double);
template double renewal_in_steps<3>(dem::Settings<3>, double);

} // namespace kerf::benchmarks
