// Timed steps of the particle engine.
#pragma once

#include "dem_core/engine.hpp"

namespace kerf::benchmarks {

/// A fifth of what is stable, s.
template <int dim> double time_step_of(const dem::Engine<dim>& engine);

/// Makes some steps to warm up, then times others.
/// @param engine  started; a copy, so that every measurement times the same steps
/// @throws std::runtime_error when the contact list was renewed meanwhile
template <int dim> double seconds_per_step(dem::Engine<dim> engine, int steps);

/// What a renewal of the contact list takes, in steps: the particles of a model drift all together.
template <int dim> double renewal_in_steps(dem::Settings<dim> settings, double time_step);

} // namespace kerf::benchmarks
