// Turns the settings of a mesh into the mesh.
#pragma once

#include "fem_core/mesh.hpp"
#include "fem_core/program/table.hpp"

namespace kerf::fem {

/// The period of the case, from its table [case].
template <int dim> Period<dim> read_period(const Table& case_settings);

/// The mesh of a participant, fit to be computed with.
///
/// @param participant  its table; the table mesh is read
/// @throws coupler::SettingsError for keys that are missing or of another type, InputError for what
///         generators, file or check_mesh() refuse
template <int dim> Mesh<dim> read_mesh(const Table& participant, const Period<dim>& period);

} // namespace kerf::fem
