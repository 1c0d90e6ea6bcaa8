// A finite element body as one participant of a run.
#pragma once

#include "coupler/participant/participant.hpp"

namespace kerf::fem {

/// Reads the settings that the participant is given, builds the mesh and the engine, and runs them
/// until the broker ends the run. Results go to the run folder; a planned run writes nothing.
///
/// @return 0
/// @throws coupler::SettingsError when the settings cannot be used
/// @throws coupler::RunStopped when the run is ended from outside
/// @throws std::runtime_error when the motion is no longer finite or results cannot be written
int run_fem(coupler::Participant& participant);

} // namespace kerf::fem
