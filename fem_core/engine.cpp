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
  scale_mass();
  set_weights({});
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
                          .hourglass_viscosity =
                              material.hourglass_viscosity *
                              std::sqrt(material.density() * material.bound().uniaxial()),
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
    model.density *= density_factor_[active_[k]];
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
    ElementModel<dim> model = model_of(e);
    model.density *= density_factor_[e];
    const double bound = omega2_of(model);
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
  step_ = moved_since_ = loaded_since_ = 0;
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
  unbalanced_force_ = 0.0;
  peak_ = {};
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
      velocity[k * dim + i] =
          moved ? boundary_.velocity(nodes[k], i, step_ - moved_since_, time_step_)
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

template <int dim> Vec<dim> Engine<dim>::load(std::size_t setting) const {
  std::vector<double> u;
  for (const std::uint32_t node : loads_.nodes()) {
    const std::uint32_t row = patches_.row_of_node[node];
    const Vec<dim> before = displacement_[row] - time_step_ * velocity_[row];
    u.insert(u.end(), before.begin(), before.end());
  }
  return loads_.resultant(setting, static_cast<double>(step_ - 1 - loaded_since_) * time_step_, u);
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
