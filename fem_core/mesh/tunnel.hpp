// A rectangle with a circular opening; a block with a tunnel is this, extruded.
#pragma once

#include "fem_core/mesh.hpp"
#include "fem_core/mesh/axis.hpp"

#include <optional>

namespace kerf::fem {

struct TunnelMesh {
  Vec<2> origin = Vec<2>::Zero();              // m, lower corner of the rectangle
  Vec<2> size = Vec<2>::Zero();                // m, > 0
  std::optional<Vec<2>> center = std::nullopt; // m, of the opening; none: the middle
  double radius = 0.0;                         // m, of the opening
  std::uint32_t radial = 0, around = 0;        // elements from the wall outwards, and around it
  /// Radial size of the outermost element over that at the wall; none: sizes grow like the distance
  /// from the middle of the opening.
  std::optional<double> grading = std::nullopt;
  bool excavation = false; // elements in the opening, too, for a stage that removes them
};

/// A rectangle of quads with the tags left, right, bottom, top and wall.
///
/// Elements lie on rays from the wall, at equal angles, to the sides, of which each has a quarter
/// of them, at equal angles as seen from the middle of the opening. With an excavation the elements
/// are in the regions rock and excavation; the faces of the wall are sides of the rock either way.
/// @throws InputError with the key mesh.size, mesh.center, mesh.radius, mesh.count or
///         mesh.radial_grading; a side less than 1.15 radii from the middle of the opening may be
///         too close to mesh
Mesh<2> make_tunnel(const TunnelMesh& tunnel);

/// A block of hexes with a tunnel along z; the ends have the tags back and front.
///
/// @param along  the axis z
/// @throws InputError as above, or with the key mesh.size, mesh.count or mesh.grading
Mesh<3> make_tunnel(const TunnelMesh& tunnel, const Axis& along);

} // namespace kerf::fem
