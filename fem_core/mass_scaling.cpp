// What the engine adds to masses for a larger step.
#include "fem_core/engine.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kerf::fem {

/// Makes elements heavier whose own critical step is smaller than wished, in proportion to their
/// eigenvalue: the others keep their mass. As they are at the start, without weights.
template <int dim> void Engine<dim>::scale_mass() {
  density_factor_.assign(mesh_.num_elements(), 1.0);
  if (!settings_.mass_scaling)
    return;
  const auto [critical_step, factor] = *settings_.mass_scaling;
  if (!(factor >= 1.0 && std::isfinite(factor)))
    throw InputError("mass_scaling.factor", fmt::format("{} must be from 1", factor));
  if (!(critical_step >= 0.0 && std::isfinite(critical_step)))
    throw InputError("mass_scaling.critical_step",
                     fmt::format("{} s must be positive", critical_step));
  if ((critical_step > 0.0) == (factor > 1.0))
    throw InputError("mass_scaling", "give either a critical step or a factor above 1");
  density_factor_.assign(mesh_.num_elements(), factor);
  if (critical_step == 0.0)
    return;
  const auto size = static_cast<std::int64_t>(mesh_.num_elements());
#pragma omp parallel for schedule(static) if (size > 1000)
  for (std::int64_t k = 0; k < size; ++k) {
    const auto e = static_cast<std::uint32_t>(k);
    const double step_factor = settings_.materials[material_of_[e]].material.step_factor();
    const double wished = 4.0 * step_factor * step_factor / (critical_step * critical_step);
    try {
      const ElementModel<dim> model = model_of(e);
      if (cheap_omega2_of(model) > wished)
        density_factor_[e] = std::max(1.0, omega2_of(model) / wished);
    } catch (const std::invalid_argument&) { // inside out: the masses will name it
    }
  }
}

template <int dim> AddedMass Engine<dim>::added_mass() const {
  AddedMass result;
  for (const std::uint32_t e : active_) {
    const ElementModel<dim> model = model_of(e);
    const double before = lumped_mass(model.element, model.density).sum();
    result.before += before;
    result.added += (density_factor_[e] - 1.0) * before;
    result.elements += density_factor_[e] > 1.0 ? 1 : 0;
    if (density_factor_[e] > result.largest_factor) {
      result.largest_factor = density_factor_[e];
      result.largest_element = e;
    }
  }
  return result;
}

template void Engine<2>::scale_mass();
template void Engine<3>::scale_mass();
template AddedMass Engine<2>::added_mass() const;
template AddedMass Engine<3>::added_mass() const;

} // namespace kerf::fem
