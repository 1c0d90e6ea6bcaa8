#include "fem_core/relax.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace kerf::fem {

template <int dim>
Relaxation relax(Engine<dim>& engine, double tolerance, std::uint64_t most_steps) {
  if (!(tolerance > 0.0))
    throw std::invalid_argument(fmt::format("the tolerance {} must be positive", tolerance));
  constexpr std::uint64_t every = 10; // the energy costs as much as a step
  const bool damped = engine.settings().kinetic_damping;
  engine.change({.kinetic_damping = true});
  Relaxation result;
  Energies energies;
  do {
    if (result.steps >= most_steps)
      throw std::runtime_error(
          fmt::format("the body is not at rest after {} steps: the unbalanced force is {:.3g} and "
                      "the kinetic energy {:.3g} of the elastic; {} were wanted",
                      result.steps, result.unbalanced_force, result.kinetic_ratio, tolerance));
    for (std::uint64_t k = 0; k < every; ++k)
      engine.integrate();
    energies = engine.energies();
    result = {.steps = result.steps + every,
              .unbalanced_force = engine.unbalanced_force(),
              .kinetic_ratio = kinetic_ratio(energies)};
  } while (!(result.unbalanced_force <= tolerance &&
             energies.kinetic <= tolerance * std::abs(energies.elastic)));
  engine.change({.kinetic_damping = damped});
  return result;
}

template Relaxation relax(Engine<2>&, double, std::uint64_t);
template Relaxation relax(Engine<3>&, double, std::uint64_t);

} // namespace kerf::fem
