// Where the engine keeps what: materials, groups of elements, rows, masses.
#include "fem_core/engine.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace kerf::fem {
namespace {

constexpr double is_free = std::numeric_limits<double>::quiet_NaN();

} // namespace

template <int dim> void Engine<dim>::assign_materials() {
  constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  material_of_.assign(mesh_.num_elements(), none);
  for (std::uint32_t k = 0; k < settings_.materials.size(); ++k) {
    const MaterialSetting<dim>& setting = settings_.materials[k];
    std::size_t count = 0;
    const auto give = [&](std::uint32_t e) {
      if (setting.box && !setting.box->contains(mesh_.corners(e).rowwise().mean()))
        return;
      material_of_[e] = k;
      ++count;
      try {
        check(setting.material, mesh_.shape_of(e), settings_.plane);
      } catch (const InputError& error) {
        throw InputError(fmt::format("materials[{}].{}", k, error.key()), error.what());
      }
    };
    if (setting.region.empty()) {
      for (std::uint32_t e = 0; e < mesh_.num_elements(); ++e)
        give(e);
    } else {
      const auto found = mesh_.regions.find(setting.region);
      if (found == mesh_.regions.end())
        throw InputError(
            fmt::format("materials[{}].region", k),
            fmt::format("the mesh has no elements with the tag \"{}\"", setting.region));
      std::for_each(found->second.begin(), found->second.end(), give);
    }
    if (count == 0)
      throw InputError(fmt::format("materials[{}].box", k),
                       "no element of the mesh has its centre in the box");
  }
  const auto without = std::find(material_of_.begin(), material_of_.end(), none);
  if (without != material_of_.end())
    throw InputError("materials",
                     fmt::format("element {} has no material", without - material_of_.begin()));
}

template <int dim> void Engine<dim>::set_weights(std::span<const double> alpha) {
  if (!alpha.empty() && alpha.size() != mesh_.num_nodes())
    throw std::invalid_argument(
        fmt::format("{} weights were given for {} nodes", alpha.size(), mesh_.num_nodes()));
  for (std::size_t a = 0; a < alpha.size(); ++a)
    if (!(alpha[a] >= 0.0 && alpha[a] <= 1.0))
      throw std::invalid_argument(
          fmt::format("the weight of node {} is {}; it must be from 0 to 1", a, alpha[a]));
  if (!alpha.empty() && settings_.mass_scaling)
    throw std::invalid_argument("the mass of a coupled body cannot be scaled");
  alpha_.assign(alpha.begin(), alpha.end());
  find_active();
  make_groups();
  make_masses();
}

template <int dim> void Engine<dim>::find_active() {
  active_.clear();
  for (std::uint32_t e = 0; e < mesh_.num_elements(); ++e) {
    const auto nodes = mesh_.nodes_of_element(e);
    if (!removed_[e] &&
        (alpha_.empty() ||
         std::any_of(nodes.begin(), nodes.end(), [&](std::uint32_t a) { return alpha_[a] > 0.0; })))
      active_.push_back(e);
  }
}

template <int dim> void Engine<dim>::make_masses() {
  mass_.assign(patches_.num_rows(), 0.0);
  true_mass_.assign(settings_.mass_scaling ? mass_.size() : 0, 0.0);
  for (const std::uint32_t e : active_) {
    const ElementModel<dim> model = model_of(e);
    CornerValues of_element;
    try {
      of_element = lumped_mass(model.element, model.density);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", name_of(e), error.what()));
    }
    const auto nodes = mesh_.nodes_of_element(e);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const std::uint32_t row = patches_.row_of_node[nodes[a]];
      const double m = of_element[static_cast<Eigen::Index>(a)];
      mass_[row] += density_factor_[e] * m;
      if (!true_mass_.empty())
        true_mass_[row] += m;
    }
  }
  squared_masses_ = 0.0;
  for (const double m : true_mass_.empty() ? mass_ : true_mass_)
    squared_masses_ += m * m;
  moved_.clear();
  scratch_.clear();
  prescribed_ = Rows<dim>(patches_.num_special);
  std::fill_n(prescribed_.data(), prescribed_.size() * row_size<dim>, is_free);
  for (const Prescribed& entry : boundary_.entries()) {
    const std::uint32_t row = patches_.row_of_node[entry.node];
    if (mass_[row] > 0.0)
      moved_.push_back({.row = row, .component = entry.component, .node = entry.node});
  }
}

/// Groups elements by material and shape, and lays them out in patches.
template <int dim> void Engine<dim>::make_groups() {
  std::vector<ElementGroup> groups;
  std::vector<std::uint32_t> material; // of each group
  for (std::uint32_t k = 0; k < settings_.materials.size(); ++k)
    for (const Block& block : mesh_.blocks) {
      ElementGroup group{.shape = block.shape, .elements = {}};
      for (const std::uint32_t e : active_)
        if (material_of_[e] == k && mesh_.shape_of(e) == block.shape)
          group.elements.push_back(e);
      if (group.elements.empty())
        continue;
      groups.push_back(std::move(group));
      material.push_back(k);
    }
  std::vector<bool> special(mesh_.num_nodes(), false);
  for (const Prescribed& entry : boundary_.entries())
    special[entry.node] = true;
  for (const std::uint32_t a : loads_.nodes())
    special[a] = true;
  for (const auto& absorbing : absorbing_.nodes())
    special[absorbing.node] = true;
  for (std::size_t wall = 0; wall < walls_.size(); ++wall)
    for (const std::uint32_t a : walls_.nodes(wall))
      special[a] = true;
  patches_ = Patches(mesh_, std::move(groups), special);

  groups_.clear();
  place_.assign(mesh_.num_elements(), 0);
  group_of_.assign(mesh_.num_elements(), 0);
  for (std::size_t g = 0; g < patches_.groups.size(); ++g) {
    const auto& elements = patches_.element_of[g];
    std::vector<double> lengths(elements.size());
    for (std::size_t k = elements.size(); k-- > 0;) { // what fills a batch comes after the element
      double volume = 0.0;
      for (const ElementPoint<dim>& point :
           points_of(Element<dim>{.shape = patches_.groups[g].shape,
           .corners = mesh_.corners(elements[k]),
           .alpha = {}}))
        volume += point.volume;
      lengths[k] = std::pow(volume, 1.0 / dim);
      place_[elements[k]] = static_cast<std::uint32_t>(k);
      group_of_[elements[k]] = static_cast<std::uint32_t>(g);
    }
    const Material& of_group = settings_.materials[material[g]].material;
    try {
      groups_.push_back(make_group(of_group, patches_.groups[g].shape, settings_.plane, lengths,
                                   settings_.in_situ_stress.has_value()));
    } catch (const InputError& error) { // of a law, with the key "material.fracture_energy"
      throw InputError(
          fmt::format("materials[{}]{}", material[g], error.key().substr(error.key().find('.'))),
          error.what());
    }
    GroupKernel& group = groups_.back();
    const auto points = static_cast<std::size_t>(group.points);
    if (group.kinematics == Kinematics::rate) {
      group.volume.resize(elements.size() * points);
      for (std::size_t k = 0; k < elements.size(); ++k) {
        const auto of_element = points_of(model_of(elements[k]).element);
        for (std::size_t q = 0; q < of_element.size(); ++q) // that of all in one point
          group.volume[(k / batch_size * points + std::min(q, points - 1)) * batch_size +
                       k % batch_size] += of_element[q].volume;
      }
    }
    if (alpha_.empty())
      continue;
    group.alpha.resize(elements.size() * points);
    for (std::size_t k = 0; k < elements.size(); ++k) {
      const Element<dim> blended = model_of(elements[k]).element;
      Element<dim> whole = blended;
      whole.alpha.resize(0);
      const auto of_blended = points_of(blended), of_whole = points_of(whole);
      double share = 0.0, volume = 0.0;
      for (std::size_t q = 0; q < of_whole.size(); ++q) {
        share += of_blended[q].volume;
        volume += of_whole[q].volume;
        if (points == of_whole.size())
          group.alpha[(k / batch_size * points + q) * batch_size + k % batch_size] =
              of_blended[q].volume / of_whole[q].volume;
      }
      if (points != of_whole.size())
        group.alpha[k] = share / volume;
    }
  }

  reference_ = Rows<dim>(patches_.num_copies());
  for (const Patch& patch : patches_.patches)
    for (std::uint32_t k = 0; k < patch.num_rows(); ++k) {
      const bool own = k < patch.num_own;
      const std::uint32_t shared = patch.first_shared + k - patch.num_own;
      const std::uint32_t row = own ? patch.first_row + k : patches_.shared[shared];
      Vec<dim> X = mesh_.position(patches_.node_of_row[row]);
      for (int a = 0; a < dim && !own; ++a)
        X[a] += periods_of(patches_.image[shared], a) * mesh_.period.length[a];
      reference_[patch.first_copy + k] = X;
    }
}

template void Engine<2>::assign_materials();
template void Engine<3>::assign_materials();
template void Engine<2>::set_weights(std::span<const double>);
template void Engine<3>::set_weights(std::span<const double>);
template void Engine<2>::find_active();
template void Engine<3>::find_active();
template void Engine<2>::make_masses();
template void Engine<3>::make_masses();
template void Engine<2>::make_groups();
template void Engine<3>::make_groups();

} // namespace kerf::fem
