// What the engine begins with besides motion, and what changes between two steps.
#include "fem_core/engine.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace kerf::fem {
namespace {

/// Where a number of a point is in an array of a group; place is that of the element.
std::size_t at_point(std::size_t place, std::size_t points, std::size_t q, std::size_t size,
                     std::size_t k) {
  return ((place / batch_size * points + q) * size + k) * batch_size + place % batch_size;
}

/// What is stored of one element.
struct Stored {
  std::vector<double> stress, history, hourglass;
};

/// All numbers of one element in an array of a group.
template <class Array, class Visit>
void visit_element(Array& array, std::size_t num_elements, std::size_t place, Visit visit) {
  const std::size_t size = num_elements == 0 ? 0 : array.size() / num_elements;
  for (std::size_t k = 0; k < size; ++k)
    visit(array[at_point(place, 1, 0, size, k)]);
}

} // namespace

template <int dim> void Engine<dim>::set_in_situ_stress() {
  const InSituStress<dim>& wanted = *settings_.in_situ_stress;
  Eigen::Index vertical = 0;
  const double g = settings_.gravity.norm();
  if (wanted.K0 && !(settings_.gravity.cwiseAbs().maxCoeff(&vertical) == g && g > 0.0))
    throw InputError("in_situ_stress.K0", "it needs gravity along an axis");
  const double up = settings_.gravity[vertical] < 0.0 ? 1.0 : -1.0;
  for (std::size_t g_ = 0; g_ < groups_.size(); ++g_) {
    GroupKernel& group = groups_[g_];
    if (!group.increments)
      throw InputError("in_situ_stress", "a neo_hookean material stores no stress to begin with");
    const auto points = static_cast<std::size_t>(group.points);
    for (std::size_t place = 0; place < patches_.element_of[g_].size(); ++place) {
      const std::uint32_t e = patches_.element_of[g_][place];
      const ElementModel<dim> model = model_of(e);
      const auto of_element = points_of(model.element);
      for (std::size_t q = 0; q < points; ++q) {
        Symmetric<double, dim> stress = wanted.stress;
        if (wanted.K0) {
          const Vec<dim> x = points == of_element.size()
                                 ? Vec<dim>(model.element.corners * of_element[q].N)
                                 : Vec<dim>(model.element.corners.rowwise().mean());
          const double depth = wanted.surface - up * x[vertical];
          const double pressure = wanted.overburden + model.density * g * depth;
          stress = {};
          for (int k = 0; k < 3; ++k)
            stress[k] = -(k == vertical ? 1.0 : *wanted.K0) * pressure;
        }
        for (int k = 0; k < stress.size; ++k)
          group.stress[at_point(place, points, q, static_cast<std::size_t>(stress.size),
                                static_cast<std::size_t>(k))] = stress[k];
      }
    }
  }
}

/// Dashpots hold nothing: a body that begins under stress or weight is supported there by what
/// keeps it in equilibrium.
template <int dim> void Engine<dim>::support_absorbing() {
  support_.assign(absorbing_.nodes().size(), Vec<dim>::Zero());
  if (!settings_.in_situ_stress || support_.empty())
    return;
  compute_forces(false);
  for (std::size_t k = 0; k < support_.size(); ++k) {
    const std::uint32_t node = absorbing_.nodes()[k].node, row = patches_.row_of_node[node];
    const Vec<dim> held = -force_[row] - weight(row);
    for (int i = 0; i < dim; ++i)
      if (!boundary_.is_prescribed(node, i))
        support_[k][i] = held[i];
  }
}

template <int dim> void Engine<dim>::change(const Change<dim>& change) {
  // All that can be refused comes first.
  std::vector<bool> removed = removed_;
  for (std::size_t k = 0; k < change.remove.size(); ++k) {
    const auto region = mesh_.regions.find(change.remove[k]);
    if (region == mesh_.regions.end())
      throw InputError(
          fmt::format("remove[{}]", k),
          fmt::format("the mesh has no elements with the tag \"{}\"", change.remove[k]));
    for (const std::uint32_t e : region->second)
      removed[e] = true;
  }
  Boundary<dim> boundary = change.boundary ? Boundary<dim>(mesh_, *change.boundary) : boundary_;
  Loads<dim> loads = change.loads ? Loads<dim>(mesh_, *change.loads, space()) : loads_;

  settings_.gravity = change.gravity.value_or(settings_.gravity);
  settings_.mass_damping = change.mass_damping.value_or(settings_.mass_damping);
  settings_.local_damping = change.local_damping.value_or(settings_.local_damping);
  settings_.kinetic_damping = change.kinetic_damping.value_or(settings_.kinetic_damping);
  peak_ = {}; // of what moves from here on
  if (change.boundary || change.loads || removed != removed_) {
    settings_.boundary = change.boundary.value_or(settings_.boundary);
    settings_.loads = change.loads.value_or(settings_.loads);
    boundary_ = std::move(boundary);
    loads_ = std::move(loads);

    // Rows and places are new; what is in them goes on.
    const std::vector<double> u = displacement(), v = velocity(), origin = by_node(origin_);
    std::map<std::uint32_t, Stored> stored;
    for (const std::uint32_t e : active_) {
      const GroupKernel& group = groups_[group_of_[e]];
      const std::size_t size = patches_.element_of[group_of_[e]].size();
      Stored& of_element = stored[e];
      visit_element(group.stress, size, place_[e],
                    [&](double x) { of_element.stress.push_back(x); });
      visit_element(group.history, size, place_[e],
                    [&](double x) { of_element.history.push_back(x); });
      visit_element(group.hourglass, size, place_[e],
                    [&](double x) { of_element.hourglass.push_back(x); });
    }
    removed_ = std::move(removed);
    find_active();
    make_groups();
    make_masses();
    const std::size_t rows = patches_.num_rows();
    displacement_ = velocity_ = force_ = origin_ = Rows<dim>(rows);
    parts_ = Rows<dim>(patches_.shared.size());
    interface_force_ = {};
    set_motion(u, v);
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t a = patches_.node_of_row[row];
      displacement_[row] = Eigen::Map<const Vec<dim>>(&u[a * dim]); // who lost its mass stays
      origin_[row] = Eigen::Map<const Vec<dim>>(&origin[a * dim]);
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      GroupKernel& group = groups_[g];
      group.start();
      const auto& elements = patches_.element_of[g];
      for (std::size_t place = 0; place < elements.size(); ++place) {
        const Stored& of_element = stored.at(elements[place]);
        const auto put = [&](std::vector<double>& array, const std::vector<double>& values) {
          std::size_t k = 0;
          visit_element(array, elements.size(), place, [&](double& x) { x = values[k++]; });
        };
        put(group.stress, of_element.stress);
        put(group.history, of_element.history);
        put(group.hourglass, of_element.hourglass);
      }
    }
    if (change.boundary)
      moved_since_ = step_;
    if (change.loads)
      loaded_since_ = step_;
    initial_displacement_.clear();
    for (const auto& [row, component, node] : moved_)
      initial_displacement_.push_back(
          displacement_[row][component] -
          boundary_.displacement(node, component, step_ - moved_since_, time_step_));
    load_force_.assign(loads_.nodes().size() * dim, 0.0);
    reactions_.assign(settings_.boundary.size(), Vec<dim>::Zero());
  }
  if (change.reset_displacement)
    origin_ = displacement_;
}

template void Engine<2>::set_in_situ_stress();
template void Engine<3>::set_in_situ_stress();
template void Engine<2>::support_absorbing();
template void Engine<3>::support_absorbing();
template void Engine<2>::change(const Change<2>&);
template void Engine<3>::change(const Change<3>&);

} // namespace kerf::fem
