// Puts the particles of a model in an order that makes steps fast.
#pragma once

#include "dem_core/settings.hpp"

namespace kerf::dem {

/// Arranges the particles of a model in the spatial order of common/. Each keeps its id.
template <int dim> void put_in_spatial_order(Settings<dim>& settings);

} // namespace kerf::dem
