// The part of kerf-fem that is linked with Gmsh: loaded when a mesh file is read, because Gmsh and
// the libraries under it take 0.1 s and 50 MB at every start of a program, and because of its
// license.
#pragma once

#include "fem_core/program/mesh_file.hpp"

/// @param file  has been checked
/// @throws kerf::fem::InputError as read_mesh_file() does
extern "C" void kerf_gmsh_read_2(const kerf::fem::MeshFile& file, bool is_geometry,
                                 kerf::fem::Mesh<2>& mesh);
extern "C" void kerf_gmsh_read_3(const kerf::fem::MeshFile& file, bool is_geometry,
                                 kerf::fem::Mesh<3>& mesh);
