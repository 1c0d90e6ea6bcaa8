#include "fem_core/engine.hpp"

#include "fem_core/initial.hpp"
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

template <int dim>
Engine<dim>::Engine(Mesh<dim> mesh, Settings<dim> settings)
    : mesh_(std::move(mesh)), settings_(std::move(settings)), boundary_(mesh_, settings_.boundary),
      loads_(mesh_, settings_.loads, space()), walls_(mesh_, settings_.walls) {
  std::vector<double> u(mesh_.num_nodes() * dim), v(u.size());
  add_initial<dim>(mesh_, settings_.initial, u, v); // throws now, not when the run starts
  assign_materials();
  removed_.assign(mesh_.num_elements(), false);
  absorbing_ = Absorbing<dim>(mesh_, settings_.absorbing, space(), [this](std::uint32_t e) {
    const Material& material = settings_.materials[material_of_[e]].material;
    return Medium{.moduli = material.bound(), .density = material.density()};
  });
  set_weights({});
}

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
  for (const std::uint32_t e : active_) {
    const ElementModel<dim> model = model_of(e);
    CornerValues of_element;
    try {
      of_element = lumped_mass(model.element, model.density);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", name_of(e), error.what()));
    }
    const auto nodes = mesh_.nodes_of_element(e);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      mass_[patches_.row_of_node[nodes[a]]] += of_element[static_cast<Eigen::Index>(a)];
  }
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
    if (alpha_.empty())
      continue;
    GroupKernel& group = groups_.back();
    const auto points = static_cast<std::size_t>(group.points);
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

template <int dim> ElementModel<dim> Engine<dim>::model_of(std::uint32_t element) const {
  const Material& material = settings_.materials[material_of_[element]].material;
  ElementModel<dim> model{.element = {.shape = mesh_.shape_of(element),
                                      .space = space(),
                                      .corners = mesh_.corners(element),
                                      .alpha = {}},
                          .formulation = material.formulation,
                          .moduli = material.bound(),
                          .hourglass = material.hourglass_stiffness * material.bound().uniaxial(),
                          .density = material.density()};
  if (!alpha_.empty()) {
    const auto nodes = mesh_.nodes_of_element(element);
    model.element.alpha.resize(static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t a = 0; a < nodes.size(); ++a)
      model.element.alpha[static_cast<Eigen::Index>(a)] = alpha_[nodes[a]];
  }
  return model;
}

/// At u^n, if the element feels how it has deformed. Its mass stays.
template <int dim> ElementModel<dim> Engine<dim>::deformed_model_of(std::uint32_t element) const {
  ElementModel<dim> model = model_of(element);
  const Material& material = settings_.materials[material_of_[element]].material;
  const auto* const rubber = std::get_if<NeoHookean>(&material.law);
  if ((!material.finite_strain && rubber == nullptr) || displacement_.size() == 0)
    return model;
  const auto volume = [](const Element<dim>& of) {
    double sum = 0.0;
    for (const auto& point : points_of(of))
      sum += point.volume;
    return sum;
  };
  const double before = volume(model.element);
  const auto nodes = mesh_.nodes_of_element(element);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    model.element.corners.col(static_cast<Eigen::Index>(a)) +=
        displacement_[patches_.row_of_node[nodes[a]]];
  const double J = volume(model.element) / before;
  model.density /= J;
  if (rubber != nullptr) {
    model.moduli = rubber->bound(std::min(1.0, J));
    model.moduli.lambda /= J;
    model.moduli.mu /= J;
  }
  return model;
}

template <int dim> StepLimit Engine<dim>::step_limit() const {
  if (active_.empty())
    return {.omega2 = 0.0, .limited_by = "no element"};
  if (const auto inverted = first_inverted())
    throw std::runtime_error(fmt::format("{} has turned inside out", name_of(*inverted)));
  const LargestOmega2 largest = largest_omega2<dim>(active_.size(), [this](std::size_t k) {
    ElementModel<dim> model = deformed_model_of(active_[k]);
    const Material& material = settings_.materials[material_of_[active_[k]]].material;
    const double factor = material.step_factor();
    model.moduli.lambda /= factor * factor; // which scales the frequencies
    model.moduli.mu /= factor * factor;
    model.hourglass /= factor * factor;
    return model;
  });
  return {.omega2 = largest.value, .limited_by = name_of(active_[largest.element])};
}

template <int dim> std::optional<std::uint32_t> Engine<dim>::first_inverted() const {
  std::vector<std::uint8_t> inverted(active_.size());
  const auto size = static_cast<std::int64_t>(active_.size());
#pragma omp parallel for schedule(static) if (size > 1000)
  for (std::int64_t k = 0; k < size; ++k) {
    const auto at = static_cast<std::size_t>(k);
    try {
      deformed_model_of(active_[at]);
    } catch (const std::invalid_argument&) {
      inverted[at] = 1;
    }
  }
  const auto first = std::find(inverted.begin(), inverted.end(), 1);
  if (first == inverted.end())
    return std::nullopt;
  return active_[static_cast<std::size_t>(first - inverted.begin())];
}

template <int dim> std::string Engine<dim>::name_of(std::uint32_t element) const {
  for (const auto& [tag, elements] : mesh_.regions)
    if (std::binary_search(elements.begin(), elements.end(), element))
      return fmt::format("element {} (tag {})", element, tag);
  return fmt::format("element {}", element);
}

template <int dim>
void Engine<dim>::inverse_mass(std::span<const std::uint32_t> nodes, std::span<double> out) const {
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (int i = 0; i < dim; ++i) {
      const double mass = mass_[patches_.row_of_node[nodes[k]]];
      out[k * dim + i] = mass > 0.0 && !boundary_.is_prescribed(nodes[k], i) ? 1.0 / mass : 0.0;
    }
}

template <int dim>
void Engine<dim>::omega2(std::span<const std::uint32_t> nodes, std::span<double> out) const {
  std::vector<double> of_node(mesh_.num_nodes(), -1.0); // of those that are asked for
  for (const std::uint32_t a : nodes)
    of_node[a] = 0.0;
  for (const std::uint32_t e : active_) {
    const auto corners = mesh_.nodes_of_element(e);
    if (std::none_of(corners.begin(), corners.end(),
                     [&](std::uint32_t a) { return of_node[a] >= 0.0; }))
      continue;
    const double bound = omega2_of(model_of(e));
    for (const std::uint32_t a : corners)
      if (of_node[a] >= 0.0)
        of_node[a] = std::max(of_node[a], bound);
  }
  for (std::size_t k = 0; k < nodes.size(); ++k)
    out[k] = of_node[nodes[k]];
}

template <int dim> void Engine<dim>::start(double time_step) {
  if (!(time_step > 0.0))
    throw std::invalid_argument(fmt::format("the time step {} s must be positive", time_step));
  time_step_ = time_step;
  step_ = changed_at_ = 0;
  std::vector<double> u(mesh_.num_nodes() * dim), v(u.size());
  add_initial<dim>(mesh_, settings_.initial, u, v);
  const std::size_t rows = patches_.num_rows();
  displacement_ = velocity_ = force_ = Rows<dim>(rows);
  parts_ = Rows<dim>(patches_.shared.size());
  set_motion(u, v);
  initial_displacement_.clear();
  for (const auto& [row, component, node] : moved_) {
    initial_displacement_.push_back(displacement_[row][component]);
    velocity_[row][component] = boundary_.velocity(node, component, -1, time_step);
  }
  for (GroupKernel& group : groups_)
    group.start();
  interface_rows_.clear();
  interface_force_ = {};
  element_work_ = {};
  sums_ = {};
  load_force_.assign(loads_.nodes().size() * dim, 0.0);
  reactions_.assign(settings_.boundary.size(), Vec<dim>::Zero());
  wall_forces_.assign(walls_.size(), Vec<dim>::Zero());
  damped_work_ = external_work_ = interface_work_ = {};
  origin_ = Rows<dim>(rows);
  if (settings_.in_situ_stress)
    set_in_situ_stress();
  support_absorbing();
}

template <int dim>
void Engine<dim>::set_motion(std::span<const double> displacement,
                             std::span<const double> velocity) {
  for (std::size_t row = 0; row < mass_.size(); ++row)
    if (mass_[row] > 0.0) {
      const std::size_t a = patches_.node_of_row[row];
      displacement_[row] = Eigen::Map<const Vec<dim>>(&displacement[a * dim]);
      velocity_[row] = Eigen::Map<const Vec<dim>>(&velocity[a * dim]);
    }
  forces_are_current_ = false;
}

template <int dim>
void Engine<dim>::motion(std::span<const std::uint32_t> nodes, std::span<double> position,
                         std::span<double> velocity) const {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::uint32_t row = patches_.row_of_node[nodes[k]];
    for (int i = 0; i < dim; ++i) {
      position[k * dim + i] =
          mesh_.positions[std::size_t{nodes[k]} * dim + i] + displacement_[row][i];
      const bool moved = boundary_.is_prescribed(nodes[k], i) && mass_[row] > 0.0;
      velocity[k * dim + i] = moved
                                  ? boundary_.velocity(nodes[k], i, step_ - changed_at_, time_step_)
                                  : velocity_[row][i];
    }
  }
}

template <int dim> std::vector<double> Engine<dim>::by_node(const Rows<dim>& rows) const {
  std::vector<double> values(mesh_.num_nodes() * dim);
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (int i = 0; i < dim; ++i)
      values[std::size_t{patches_.node_of_row[row]} * dim + static_cast<std::size_t>(i)] =
          rows[row][i];
  return values;
}

template <int dim> std::vector<double> Engine<dim>::displacement() const {
  return by_node(displacement_);
}

template <int dim> std::vector<double> Engine<dim>::displacement_since_reset() const {
  Rows<dim> since = displacement_;
  for (std::size_t row = 0; row < since.size(); ++row)
    since[row] -= origin_[row];
  return by_node(since);
}

template <int dim> std::vector<double> Engine<dim>::velocity() const {
  return by_node(velocity_);
}

template <int dim> std::vector<double> Engine<dim>::mass() const {
  std::vector<double> values(mesh_.num_nodes());
  for (std::size_t row = 0; row < mass_.size(); ++row)
    values[patches_.node_of_row[row]] = mass_[row];
  return values;
}

template <int dim> std::optional<std::uint32_t> Engine<dim>::first_non_finite() const {
  std::optional<std::uint32_t> first;
  for (std::size_t row = 0; row < displacement_.size(); ++row)
    if (!displacement_[row].allFinite() || !velocity_[row].allFinite())
      first = std::min(first.value_or(patches_.node_of_row[row]), patches_.node_of_row[row]);
  return first;
}

template class Engine<2>;
template class Engine<3>;

} // namespace kerf::fem
