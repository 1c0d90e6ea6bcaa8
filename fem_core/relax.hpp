// The way of a body to a static state.
#pragma once

#include "fem_core/engine.hpp"

#include <cstdint>

namespace kerf::fem {

struct Relaxation {
  std::uint64_t steps = 0;
  double unbalanced_force = 0.0, kinetic_ratio = 0.0; // of the last of them
};

/// Steps under kinetic damping until the body rests: Engine::unbalanced_force() and
/// kinetic_ratio() are at most `tolerance`. Loads and boundaries go on in time meanwhile. Nothing
/// has to be chosen: between two peaks of the kinetic energy the motion is undamped, and each takes
/// about a quarter of the period of what still moves.
///
/// @pre the engine has been started
/// @throws std::invalid_argument for a tolerance that is not positive
/// @throws std::runtime_error when the body still moves after `most_steps`, with both ratios
/// @see P. A. Cundall, Explicit finite-difference methods in geomechanics, 2nd Int. Conf. Numer.
///      Meth. Geomech. (1976) 132-150; M. R. Barnes, doi:10.1260/0266351991494722
template <int dim>
Relaxation relax(Engine<dim>& engine, double tolerance, std::uint64_t most_steps = 1'000'000);

} // namespace kerf::fem
