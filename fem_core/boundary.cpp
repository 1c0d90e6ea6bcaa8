#include "fem_core/boundary.hpp"

#include "fem_core/face.hpp"
#include "fem_core/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf::fem {
namespace {

/// Displacement at a time, m.
template <int dim>
double displacement_at(const BoundarySetting<dim>& setting, int component, double time) {
  switch (setting.motion) {
  case Motion::velocity:
    return setting.velocity[component] * time;
  case Motion::hann: {
    if (!(time > 0.0 && time < setting.duration))
      return 0.0;
    const double s = std::sin(std::numbers::pi * time / setting.duration);
    return setting.amplitude[component] * s * s; // (1 - cos 2x) / 2 without its cancellation
  }
  case Motion::displacement_table:
    return setting.table[static_cast<std::size_t>(component)].value(time);
  case Motion::velocity_table:
    return setting.table[static_cast<std::size_t>(component)].integral(time);
  case Motion::fixed:
  case Motion::symmetry:
    break;
  }
  return 0.0;
}

/// The nodes that a setting means.
template <int dim>
std::vector<std::uint32_t> select(const Mesh<dim>& mesh, const BoundarySetting<dim>& setting,
                                  const std::string& key) {
  if (setting.tag.empty() == !setting.box)
    throw InputError(key + ".tag", "a boundary needs either a tag or a box to know its nodes");
  std::vector<std::uint32_t> nodes =
      nodes_with_tag(mesh, setting.tag.empty() ? "all" : setting.tag, key + ".tag");
  if (!setting.box)
    return nodes;
  std::erase_if(nodes, [&](std::uint32_t a) { return !setting.box->contains(mesh.position(a)); });
  if (nodes.empty())
    throw InputError(key + ".box", "no node of the mesh lies in the box");
  return nodes;
}

template <int dim> void check(const BoundarySetting<dim>& setting, const std::string& key) {
  if (std::none_of(setting.components.begin(), setting.components.end(), [](bool c) { return c; }))
    throw InputError(key + ".components", "at least one component must be listed");
  if (setting.motion == Motion::hann && !(setting.duration > 0.0))
    throw InputError(key + ".duration", fmt::format("{} s must be positive", setting.duration));
}

/// The components that a plane of symmetry holds.
template <int dim>
std::array<bool, dim> normal_of(const Mesh<dim>& mesh, const std::string& tag,
                                const std::string& key) {
  const auto faces = mesh.boundary.find(tag);
  if (faces == mesh.boundary.end())
    throw InputError(key + ".tag",
                     fmt::format("symmetry needs a tag of faces; \"{}\" has none", tag));
  std::array<bool, dim> components{};
  for (const Face& face : faces->second) {
    const Vec<dim> normal = area_vector<dim>(face_corners(mesh, face, mesh.positions)).normalized();
    Eigen::Index axis = 0;
    if (!(normal.cwiseAbs().maxCoeff(&axis) > 1.0 - 1e-9))
      throw InputError(key + ".tag",
                       fmt::format("the normal of a face of \"{}\" is not along an axis; symmetry "
                                   "holds planes across an axis",
                                   tag));
    components[static_cast<std::size_t>(axis)] = true;
  }
  return components;
}

} // namespace

template <int dim>
Boundary<dim>::Boundary(const Mesh<dim>& mesh, std::vector<BoundarySetting<dim>> settings)
    : settings_(std::move(settings)), setting_of_(mesh.num_nodes() * dim, none) {
  for (std::uint32_t k = 0; k < settings_.size(); ++k) {
    const std::string key = fmt::format("boundary[{}]", k);
    if (settings_[k].motion == Motion::symmetry)
      settings_[k].components = normal_of(mesh, settings_[k].tag, key);
    check(settings_[k], key);
    for (const std::uint32_t node : select(mesh, settings_[k], key))
      for (int i = 0; i < dim; ++i)
        if (settings_[k].components[i])
          setting_of_[std::size_t{node} * dim + i] = k;
  }
  for (std::size_t dof = 0; dof < setting_of_.size(); ++dof)
    if (setting_of_[dof] != none)
      entries_.push_back({.node = static_cast<std::uint32_t>(dof / dim),
                          .component = static_cast<int>(dof % dim)});
}

template <int dim>
double Boundary<dim>::displacement(std::uint32_t node, int component, std::int64_t n,
                                   double time_step) const {
  const auto& setting = settings_[setting_of_[std::size_t{node} * dim + component]];
  return displacement_at(setting, component, static_cast<double>(n) * time_step);
}

template <int dim>
double Boundary<dim>::velocity(std::uint32_t node, int component, std::int64_t n,
                               double time_step) const {
  const auto& setting = settings_[setting_of_[std::size_t{node} * dim + component]];
  if (setting.motion == Motion::velocity)
    return setting.velocity[component];
  return (displacement(node, component, n + 1, time_step) -
          displacement(node, component, n, time_step)) /
         time_step;
}

template class Boundary<2>;
template class Boundary<3>;

} // namespace kerf::fem
