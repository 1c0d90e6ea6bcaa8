// One frame of kerf-dem: particles and contacts in the order of the user's ids.
#pragma once

#include "common/results.hpp"
#include "dem_core/engine.hpp"
#include "dem_core/fragments.hpp"

#include <cstdint>
#include <span>

namespace kerf::dem {

/// Writes positions, motion and forces as the engine has them, and the surfaces of the tools. Row k
/// of the particles is the one with the k-th id, and contacts ascend by the ids of their first and
/// second particle, so that a file does not depend on the order of the particles in the engine.
template <int dim>
void write_dem_frame(FrameWriter& frames, std::uint64_t step, double time,
                     const Engine<dim>& engine, const Fragments& fragments,
                     std::span<const Grid> tools);

} // namespace kerf::dem
