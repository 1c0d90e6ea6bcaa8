// Surfaces in files: STL, Gmsh meshes, polylines.
#pragma once

#include "common/surface.hpp"
#include "common/text_file.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace kerf {

/// Reads a surface in metres from .stl (3D), .msh (Gmsh) or, in 2D, .txt (polyline), see below.
/// Equal vertices are made one; the surface has no fault.
/// @param physical_name  group of a Gmsh mesh to take; empty: all facets
/// @throws FileError when the ending is another, a name is given for another format, and see below
template <int dim>
Surface<dim> read_surface(const std::filesystem::path& path, std::string_view physical_name = {});

/// Reads ASCII or binary STL. Outside is where the corners go counter-clockwise; the normals of the
/// file are not used.
/// @throws FileError when the file is broken or find_fault() finds a fault in it
Surface<3> read_stl(const std::filesystem::path& path);

/// Reads the segments (2D: 2-node lines, z = 0) or triangles (3D: 3-node triangles; 4-node
/// quadrangles are cut in two) of a Gmsh mesh in the ASCII formats 2.2 and 4.1.
/// @param physical_name  of the physical curve or surface to take; empty: all
/// @throws FileError when the file is broken, the format is another, the facets are curved, there
///         is no group with the name, or find_fault() finds a fault
template <int dim>
Surface<dim> read_gmsh_surface(const std::filesystem::path& path,
                               std::string_view physical_name = {});

/// Reads lines of `x y`, the corners of one polyline with the body on its left; it is closed when
/// the last is the first again. `#` starts a comment.
/// @throws FileError when a line has other values, or find_fault() finds a fault
Surface<2> read_polyline(const std::filesystem::path& path);

/// Writes binary STL, whose numbers have seven digits.
/// @throws std::runtime_error when the file cannot be written
void write_stl(const std::filesystem::path& path, const Surface<3>& surface);

/// Merges the vertices of a surface that was read.
/// @param line  [facets] where they stand in the file, from 1; empty: not text
/// @throws FileError when find_fault() finds a fault
template <int dim>
Surface<dim> finish_surface(const std::filesystem::path& path, const Surface<dim>& surface,
                            std::span<const std::size_t> line);

} // namespace kerf
