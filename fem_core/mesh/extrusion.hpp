// A mesh of the plane becomes one of space.
#pragma once

#include "fem_core/mesh.hpp"

#include <string>

namespace kerf::fem {

/// Layers of hexahedra over the quadrilaterals of a plane mesh.
///
/// Nodes and elements are numbered layer by layer, each as the plane is. Tags of lines become those
/// of the surfaces over them; a node set becomes that of the lines over its nodes.
///
/// @param z      [num_layers + 1] heights, ascending, m
/// @param lower  tag of the faces at the first height, @param upper at the last
/// @throws InputError("mesh.count") when 32 bits cannot number the corners
Mesh<3> extrude(const Mesh<2>& plane, std::span<const double> z, const std::string& lower,
                const std::string& upper);

} // namespace kerf::fem
