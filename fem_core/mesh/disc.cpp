#include "fem_core/mesh/disc.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/mesh/extrusion.hpp"
#include "fem_core/mesh/rings.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kerf::fem {
namespace {

void check(const DiscMesh& disc) {
  if (!(disc.radius > 0.0 && std::isfinite(disc.radius) && disc.center.allFinite()))
    throw InputError("mesh.radius",
                     fmt::format("the radius is {} m; it must be positive", disc.radius));
  if (!(disc.inner_radius >= 0.0 && disc.inner_radius < disc.radius))
    throw InputError("mesh.inner_radius",
                     fmt::format("the inner radius is {} m; it must be less than the radius, {} m",
                                 disc.inner_radius, disc.radius));
  if (disc.radial == 0)
    throw InputError("mesh.count", "there must be at least one element along the radius");
  const bool is_ring = disc.inner_radius > 0.0;
  if (is_ring ? disc.around < 3 : disc.around == 0 || disc.around % 4 != 0)
    throw InputError("mesh.count", fmt::format("there are {} elements around; of a {}", disc.around,
                                               is_ring ? "ring there must be at least three"
                                                       : "disc they must be a multiple of 4"));
  check_numbering(4.0 * disc.around * (disc.radial + 1.0 + disc.around / 16.0));
}

} // namespace

Mesh<2> make_disc(const DiscMesh& disc) {
  check(disc);
  Mesh<2> mesh;
  mesh.blocks.push_back({.shape = Shape::quad4, .nodes = {}});
  if (disc.inner_radius > 0.0) {
    const std::vector<double> radius =
        positions_along({.origin = disc.inner_radius,
                         .length = disc.radius - disc.inner_radius,
                         .count = disc.radial,
                         .grading = disc.grading},
                        "the radius", {.grading = "mesh.radial_grading"});
    add_rings(mesh, add_circle(mesh, disc.center, radius[0], disc.around), disc.radial,
              [&](std::size_t layer, std::size_t k) -> Vec<2> {
                return disc.center + radius[layer] * circle_direction(k, disc.around);
              });
    for (std::uint32_t k = 0; k < disc.around; ++k)
      mesh.boundary["inner"].push_back({k, 0});
  } else {
    add_disc(mesh, disc.center, disc.radius, disc.radial, disc.around);
  }
  const auto last = static_cast<std::uint32_t>(mesh.num_elements()) - disc.around;
  for (std::uint32_t k = 0; k < disc.around; ++k)
    mesh.boundary["side"].push_back({last + k, 1});
  return mesh;
}

Mesh<3> make_cylinder(const DiscMesh& disc, const Axis& along) {
  const std::vector<double> z = positions_along(along, "z", {.length = "mesh.length"});
  return extrude(make_disc(disc), z, "bottom", "top");
}

} // namespace kerf::fem
