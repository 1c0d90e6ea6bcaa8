#include "fem_core/mesh/tunnel.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/mesh/extrusion.hpp"
#include "fem_core/mesh/quality.hpp"
#include "fem_core/mesh/rings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace kerf::fem {
namespace {

void check(const TunnelMesh& tunnel, const Vec<2>& center) {
  for (int a = 0; a < 2; ++a)
    if (!(tunnel.size[a] > 0.0 && std::isfinite(tunnel.size[a]) && std::isfinite(tunnel.origin[a])))
      throw InputError("mesh.size", fmt::format("the size along {} is {} m; it must be positive",
                                                "xy"[a], tunnel.size[a]));
  if (!(tunnel.radius > 0.0))
    throw InputError("mesh.radius",
                     fmt::format("the radius is {} m; it must be positive", tunnel.radius));
  const double room = std::min((center - tunnel.origin).minCoeff(),
                               (tunnel.origin + tunnel.size - center).minCoeff());
  if (!(room > tunnel.radius))
    throw InputError(tunnel.center ? "mesh.center" : "mesh.radius",
                     fmt::format("the middle of the opening is {} m from the nearest side; that "
                                 "must be more than its radius, {} m",
                                 room, tunnel.radius));
  if (tunnel.radial == 0)
    throw InputError("mesh.count", "there must be at least one element outwards from the wall");
  if (tunnel.around == 0 || tunnel.around % 4 != 0)
    throw InputError("mesh.count", fmt::format("there are {} elements around; they must be a "
                                               "multiple of 4",
                                               tunnel.around));
  check_numbering(4.0 * tunnel.around * (tunnel.radial + 1.0 + 0.15 * tunnel.around));
}

/// Where the ray of node k ends: on the right, upper, left and lower side, one quarter of the rays
/// each, at equal angles as seen from the middle of the opening.
Vec<2> end_of_ray(const TunnelMesh& tunnel, const Vec<2>& center, std::size_t k) {
  const Vec<2> lower = tunnel.origin, upper = tunnel.origin + tunnel.size;
  const std::array<Vec<2>, 4> corners = {
      {{upper[0], lower[1]}, upper, {lower[0], upper[1]}, lower}};
  const std::size_t quarter = tunnel.around / 4, side = k / quarter;
  if (k % quarter == 0)
    return corners[side];
  const Vec<2> first = corners[side] - center, last = corners[(side + 1) % 4] - center;
  const double share = static_cast<double>(k % quarter) / static_cast<double>(quarter);
  const double whole = std::atan2(moment<2>(first, last)[0], first.dot(last));
  const Vec<2> direction = Eigen::Rotation2Dd(share * whole) * first;
  Vec<2> end = center + direction * (moment<2>(first, last - first)[0] /
                                     moment<2>(direction, last - first)[0]);
  const int normal = side % 2 == 0 ? 0 : 1; // round-off must not take it off its side
  end[normal] = corners[side][normal];
  return end;
}

/// Layers of the core that make its elements about as long as they are wide: what is left of the
/// radius beside the square, over the length of a side on the circle.
std::uint32_t core_layers(std::uint32_t around) {
  return std::max(
      1u, static_cast<std::uint32_t>(std::lround(0.45 * around / (2.0 * std::numbers::pi))));
}

} // namespace

Mesh<2> make_tunnel(const TunnelMesh& tunnel) {
  const Vec<2> center = tunnel.center.value_or(tunnel.origin + 0.5 * tunnel.size);
  check(tunnel, center);
  Mesh<2> mesh;
  mesh.blocks.push_back({.shape = Shape::quad4, .nodes = {}});
  const Loop wall = tunnel.excavation ? add_disc(mesh, center, tunnel.radius,
                                                 core_layers(tunnel.around), tunnel.around)
                                      : add_circle(mesh, center, tunnel.radius, tunnel.around);
  const auto core = static_cast<std::uint32_t>(mesh.num_elements());

  const double outer = 0.25 * tunnel.size.sum(); // mean half size
  const double natural =
      tunnel.radial == 1 ? 1.0 : std::pow(outer / tunnel.radius, 1.0 - 1.0 / tunnel.radial);
  const std::vector<double> share = positions_along(
      {.length = 1.0, .count = tunnel.radial, .grading = tunnel.grading.value_or(natural)},
      "the radius", {.grading = "mesh.radial_grading"});
  add_rings(mesh, wall, tunnel.radial, [&](std::size_t layer, std::size_t k) -> Vec<2> {
    return (1.0 - share[layer]) * mesh.position(wall[k]) +
           share[layer] * end_of_ray(tunnel, center, k);
  });

  const auto all = static_cast<std::uint32_t>(mesh.num_elements());
  const char* sides[] = {"right", "top", "left", "bottom"};
  for (std::uint32_t k = 0; k < tunnel.around; ++k) {
    mesh.boundary["wall"].push_back({core + k, 0});
    mesh.boundary[sides[4 * k / tunnel.around]].push_back({all - tunnel.around + k, 1});
  }
  if (tunnel.excavation) {
    mesh.regions["excavation"].resize(core);
    mesh.regions["rock"].resize(all - core);
    std::iota(mesh.regions["excavation"].begin(), mesh.regions["excavation"].end(), 0u);
    std::iota(mesh.regions["rock"].begin(), mesh.regions["rock"].end(), core);
  }
  if (!(quality_of(mesh).jacobian.value > 0.0))
    throw InputError(
        tunnel.center ? "mesh.center" : "mesh.size",
        "elements fold, because the opening is close to one side and far from another; "
        "give it a place nearer to the middle, or a block that is wider there");
  return mesh;
}

Mesh<3> make_tunnel(const TunnelMesh& tunnel, const Axis& along) {
  return extrude(make_tunnel(tunnel), positions_along(along, "z"), "back", "front");
}

} // namespace kerf::fem
