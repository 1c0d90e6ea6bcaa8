// Layers of quadrilaterals around a closed loop of nodes.
#pragma once

#include "fem_core/mesh.hpp"

#include <functional>

namespace kerf::fem {

/// The nodes of a closed loop, counter-clockwise.
using Loop = std::vector<std::uint32_t>;

/// Adds layers of nodes and quads around a loop, each numbered as the loop is; the first corner of
/// a quad is on the inner side, its second beyond it.
///
/// @param position  of node k of a layer, 1 to num_layers, m
/// @return the outermost loop
Loop add_rings(Mesh<2>& mesh, Loop inner, std::size_t num_layers,
               const std::function<Vec<2>(std::size_t layer, std::size_t k)>& position);

/// Adds the nodes of a circle: the first one at -45 degrees, all at equal angles.
Loop add_circle(Mesh<2>& mesh, const Vec<2>& center, double radius, std::uint32_t count);

/// Direction of node k out of count on such a circle.
Vec<2> circle_direction(std::size_t k, std::size_t count);

/// Adds the quads that fill a circle: a rounded square of count / 4 by count / 4 in the middle, and
/// layers around it; its nodes and those of the layers are numbered from the inside.
///
/// @param layers  between the square and the circle
/// @return the loop on the circle, as of add_circle()
/// @pre count is a multiple of 4; the mesh has a block of quads
Loop add_disc(Mesh<2>& mesh, const Vec<2>& center, double radius, std::uint32_t layers,
              std::uint32_t count);

} // namespace kerf::fem
