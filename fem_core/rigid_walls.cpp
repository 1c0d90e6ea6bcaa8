#include "fem_core/rigid_walls.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kerf::fem {

template <int dim>
RigidWalls<dim>::RigidWalls(const Mesh<dim>& mesh, std::vector<WallSetting<dim>> settings)
    : settings_(std::move(settings)) {
  for (std::size_t k = 0; k < settings_.size(); ++k) {
    const std::string key = fmt::format("walls[{}]", k);
    WallSetting<dim>& wall = settings_[k];
    if (!(wall.normal.norm() > 0.0))
      throw InputError(key + ".normal", "it must not be zero");
    if (!(wall.friction >= 0.0))
      throw InputError(key + ".friction", fmt::format("{} must not be negative", wall.friction));
    wall.normal.normalize();
    nodes_.push_back(nodes_with_tag(mesh, wall.tag, key + ".tag"));
  }
}

template <int dim>
Vec<dim> RigidWalls<dim>::impulse(std::size_t k, const Vec<dim>& position, const Vec<dim>& velocity,
                                  double end, double time_step) const {
  const WallSetting<dim>& wall = settings_[k];
  const double gap = wall.normal.dot(position - wall.point) - wall.velocity.integral(end); // m
  if (gap >= 0.0)
    return Vec<dim>::Zero();
  const double pushed = -gap / time_step; // m/s
  const Vec<dim> slip = velocity - wall.normal.dot(velocity) * wall.normal;
  const double sliding = slip.norm();
  const double stopped = sliding > 0.0 ? std::min(1.0, wall.friction * pushed / sliding) : 0.0;
  return pushed * wall.normal - stopped * slip;
}

template class RigidWalls<2>;
template class RigidWalls<3>;

} // namespace kerf::fem
