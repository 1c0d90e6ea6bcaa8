// What a case prescribes to nodes and faces: motions and loads, of the start or of a stage.
#pragma once

#include "fem_core/mesh.hpp"
#include "fem_core/program/table.hpp"
#include "fem_core/settings.hpp"

#include <optional>
#include <string>
#include <vector>

namespace kerf::fem {

/// The box of a table, if it has one.
template <int dim> std::optional<Box<dim>> read_box(const Table& table);

/// The tag of a table.
/// @throws coupler::SettingsError when the mesh does not have it, with the one that was meant
template <int dim> std::string read_tag(const Table& table, const Mesh<dim>& mesh);

/// @throws coupler::SettingsError likewise
template <int dim>
void check_region(const Mesh<dim>& mesh, const std::string& region, const std::string& key);

/// @throws coupler::SettingsError
template <int dim>
std::vector<BoundarySetting<dim>> read_boundary(const std::vector<Table>& list,
                                                const Mesh<dim>& mesh);

/// @throws coupler::SettingsError
template <int dim>
std::vector<LoadSetting<dim>> read_loads(const std::vector<Table>& list, const Mesh<dim>& mesh);

} // namespace kerf::fem
