// The particle engine as one participant of a run.
#pragma once

#include "coupler/participant/participant.hpp"

namespace kerf::dem {

/// Builds the engine from the assignment, declares it, runs its loop and finalizes. Writes nothing
/// when only a plan is wanted.
/// @return exit code 0
/// @throws coupler::SettingsError, coupler::RunStopped, std::runtime_error
int run_dem(coupler::Participant& broker);

} // namespace kerf::dem
