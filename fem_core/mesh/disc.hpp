// Discs and rings; cylinders and tubes are these, extruded.
#pragma once

#include "fem_core/mesh.hpp"
#include "fem_core/mesh/axis.hpp"

namespace kerf::fem {

struct DiscMesh {
  Vec<2> center = Vec<2>::Zero(); // m
  double radius = 0.0;            // m, > 0
  double inner_radius = 0.0;      // m; > 0: a ring
  /// Elements along the radius and around it. Those of a disc around it are a multiple of 4: in its
  /// middle is a rounded square of around / 4 by around / 4, and along the radius are the layers
  /// around that.
  std::uint32_t radial = 0, around = 0;
  double grading = 1.0; // of a ring: radial size of the outermost element over the innermost
};

/// A disc or a ring of quads, with the tag side on its circle and inner on the inner one.
///
/// The corners on the circles are exact: area and circumference converge with the square of the
/// element size.
/// @throws InputError with the key mesh.radius, mesh.inner_radius, mesh.count or
/// mesh.radial_grading
Mesh<2> make_disc(const DiscMesh& disc);

/// A cylinder or a tube of hexes along z, with the tags bottom and top on its ends.
///
/// @param along  the axis z
/// @throws InputError as make_disc(), or with the key mesh.length, mesh.count or mesh.grading
Mesh<3> make_cylinder(const DiscMesh& disc, const Axis& along);

} // namespace kerf::fem
