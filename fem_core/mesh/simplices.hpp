// Quadrilaterals are cut into triangles, hexahedra into tetrahedra.
#pragma once

#include "fem_core/mesh.hpp"

namespace kerf::fem {

/// A mesh of quad4 or hex8 in the wanted shape: as it is, or cut.
///
/// A quad becomes two triangles, along its shorter diagonal, or along 0-2 when they are equal. A
/// hex becomes two prisms in the same way, and each of them the three tetrahedra of its staircase
/// (Freudenthal 1942; Kuhn 1960): with lower nodes a < b < c and a', b', c' over them these are
/// a b c c', a b b' c' and a a' b' c'. Neighbours agree because the nodes of layers are ordered in
/// the same way. Of a brick that is numbered x fastest these are six around the diagonal 0-6.
///
/// Children stand where their parent was; tags go over to them.
/// @pre hexes stand in layers along z, as extrude() makes them
/// @throws InputError("mesh.shape") for a shape of another dimension;
///         InputError("mesh.count") when 32 bits cannot number the corners
template <int dim> Mesh<dim> in_shape(Mesh<dim> mesh, Shape shape);

} // namespace kerf::fem
