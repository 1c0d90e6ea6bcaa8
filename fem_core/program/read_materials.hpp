// Turns the tables [material] and [[materials]] of a participant into materials of the engine.
#pragma once

#include "fem_core/mesh.hpp"
#include "fem_core/program/table.hpp"
#include "fem_core/settings.hpp"

namespace kerf::fem {

/// What 2D means; plane strain when it is not given.
/// @throws coupler::SettingsError
Plane read_plane(const Table& participant);

/// That of the table material, if there is one, and then those of the list materials.
/// @param mesh  its regions must have the tags that materials name
/// @throws coupler::SettingsError
template <int dim>
std::vector<MaterialSetting<dim>> read_materials(const Table& participant, const Mesh<dim>& mesh);

/// The key in the case of a key of Settings: where there is a table material, "materials[0].box" is
/// "material.box" and "materials[1].box" is "materials[0].box".
std::string case_key(const Table& participant, const std::string& key);

} // namespace kerf::fem
