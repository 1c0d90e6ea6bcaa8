// Geometry and weights of the zone where particles and elements describe the same body.
#pragma once

#include "common/vec.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::coupler {

/// Shortest distance from each point to the faces of a boundary, Rojek (2008) eqs 31-32.
///
/// @param faces   [num_faces][2 in 2D, 4 in 3D] node indices; a quadrilateral counts as two
/// triangles
/// @param nodes   [num_nodes][dim] m
/// @param points  [num_points][dim] m
/// @param far     a distance, m, beyond which the exact value does not matter
/// @return [num_points] m; infinity for a point that is certainly further away than `far`
template <int dim>
std::vector<double>
distance_to_boundary(std::span<const std::uint32_t> faces, std::span<const double> nodes,
                     std::span<const double> points, double far, const Period<dim>& period);

/// Share alpha of the finite elements in the virtual work, Rojek (2008) eq. 28.
///
/// alpha = g / L: zero on the boundary towards the pure particle domain, one where particles end
/// and only elements are left, linear in between, one beyond.
///
/// @param distance  [num_points] shortest distance g to the boundary where alpha = 0, m
/// @param width     width L of the zone, m
/// @param alpha     [num_points] receives the share, in [0, 1]
/// @throws std::invalid_argument when the spans differ in size, or the width is not positive
/// @see Rojek (2008) eqs 27-32; compare Xiao & Belytschko, Comput. Methods Appl. Mech. Eng. 193
///      (2004) 1645-1669, doi:10.1016/j.cma.2003.12.053
void overlap_alpha(std::span<const double> distance, double width, std::span<double> alpha);

} // namespace kerf::coupler
