// Turns the settings that a participant is given into those of the engine.
#pragma once

#include "fem_core/mesh.hpp"
#include "fem_core/program/table.hpp"
#include "fem_core/program/watch.hpp"
#include "fem_core/settings.hpp"

#include <optional>
#include <tuple>

namespace kerf::fem {

/// Everything besides the mesh, which must have the tags of boundaries and materials.
/// @throws coupler::SettingsError
template <int dim> Settings<dim> read_settings(const Table& participant, const Mesh<dim>& mesh);

/// Damping by mass, 1/s, the local share, and whether there is kinetic damping.
std::tuple<double, double, bool> read_damping(const Table& damping);

/// Probes and names of walls.
/// @throws coupler::SettingsError
template <int dim> Watch<dim> read_watch(const Table& participant, const Mesh<dim>& mesh);

/// Threads that the engine may use; nothing for "auto".
/// @throws coupler::SettingsError
std::optional<int> read_threads(const Table& participant);

} // namespace kerf::fem
