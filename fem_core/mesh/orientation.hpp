// Elements that are numbered the wrong way round.
#pragma once

#include "fem_core/mesh.hpp"

namespace kerf::fem {

/// Renumbers the nodes of elements that go clockwise or are inside out, as the sign of detJ in
/// their middle tells; the shape of an element stays, its sides get other numbers.
/// @pre the mesh has no boundary yet
template <int dim> void orient(Mesh<dim>& mesh);

} // namespace kerf::fem
