// Meshes from files of Gmsh, and from geometries that Gmsh meshes.
#pragma once

#include "fem_core/mesh.hpp"

#include <filesystem>
#include <optional>

namespace kerf::fem {

struct MeshFile {
  std::filesystem::path path; // .msh (2.2 or 4.1, text or binary), .geo, .step or .stp
  double scale = 1.0;         // of the coordinates in the file, 1e-3 for millimetres
  std::optional<double> element_size = std::nullopt; // m, the largest; of a geometry
};

/// Reads a mesh, or makes that of a geometry, with the Gmsh library.
///
/// Linear tri3 and quad4 in 2D, tet4 and hex8 in 3D. Physical groups become tags: those of elements
/// of the body regions, those of their sides boundary faces, smaller ones node sets. A group
/// without a name has its number for one. A face between two elements is taken as a side of the one
/// with the lower number. Nodes and elements are in the order of their numbers in the file;
/// elements are grouped by shape. Elements that are numbered clockwise or inside out are
/// renumbered, and nodes that no element of the body has, such as the centres of circles, are left
/// out. STEP files state their unit and are read in metres.
///
/// @throws InputError with the key mesh.file, mesh.scale or mesh.element_size for what cannot be
///         read, other elements than those above, a group of sides that are none, nodes of a plane
///         mesh that are not in a plane z = constant; or when kerf was built without Gmsh
template <int dim> Mesh<dim> read_mesh_file(const MeshFile& file);

} // namespace kerf::fem
