// What an engine says of one element, from its own formulas rather than those of the kernels.
#include "fem_core/engine.hpp"

#include "fem_core/laws/plane_stress.hpp"

#include <cmath>
#include <type_traits>

namespace kerf::fem {
namespace {

template <int dim> using Matrix = Eigen::Matrix<double, dim, dim>;

Gradient<double, 2> gradient_of(const Matrix<2>& H, double hoop) {
  return {H(0, 0), H(0, 1), H(1, 0), H(1, 1), hoop};
}
Gradient<double, 3> gradient_of(const Matrix<3>& H, double) {
  return {H(0, 0), H(0, 1), H(0, 2), H(1, 0), H(1, 1), H(1, 2), H(2, 0), H(2, 1), H(2, 2)};
}

template <int dim>
void add(Symmetric<double, dim>& sum, double factor, const Symmetric<double, dim>& value) {
  for (int k = 0; k < sum.size; ++k)
    sum[k] += factor * value[k];
}

/// Of a law of total strain, at the points of the formulation.
template <int dim, class Law>
ElementState<dim> evaluate(const Law& law, const ElementModel<dim>& model, const Corners<dim>& u) {
  const auto points = points_of(model.element);
  double volume = 0.0;
  for (const auto& point : points)
    volume += point.volume;
  ElementState<dim> state;
  const Eigen::Map<const Eigen::VectorXd> values(u.data(), u.size());
  const auto strains = strain_matrices<dim>(points, model.formulation);
  for (std::size_t q = 0; q < strains.size(); ++q) {
    const double weight = strains.size() == 1 ? volume : points[q].volume;
    if constexpr (std::is_base_of_v<NeoHookean, Law>) {
      Matrix<dim> H = Matrix<dim>::Zero();
      for (std::size_t p = 0; p < points.size(); ++p)
        if (strains.size() > 1 ? p == q : true)
          H += (strains.size() > 1 ? 1.0 : points[p].volume / volume) * points[p].gradient_of(u);
      const double hoop =
          points[q].radius > 0.0 ? u.row(0).dot(points[q].N) / points[q].radius : 0.0;
      auto gradient = gradient_of(H, hoop);
      if constexpr (dim == 2 && !std::is_same_v<NeoHookean, Law>)
        gradient = law.template with_thickness<ScalarMath, 2>(gradient);
      const double J = 1.0 + volume_change(gradient);
      add(state.stress, 1.0 / (J * static_cast<double>(strains.size())),
          law.template kirchhoff<ScalarMath, dim>(gradient));
      state.energy += weight * law.template energy_density<ScalarMath, dim>(gradient);
    } else {
      const Eigen::Matrix<double, Symmetric<double, dim>::size, 1> eps = strains[q] * values;
      Symmetric<double, dim> strain;
      for (int k = 0; k < strain.size; ++k)
        strain[k] = eps[k];
      const auto stress = law.template stress<ScalarMath, dim>(strain);
      add(state.stress, 1.0 / static_cast<double>(strains.size()), stress);
      state.energy += weight * 0.5 * contract(stress, strain);
    }
  }
  return state;
}

} // namespace

template <int dim> ElementState<dim> Engine<dim>::element_state(std::uint32_t element) const {
  const auto g = static_cast<std::size_t>(group_of_[element]);
  const GroupKernel& group = groups_[g];
  const ElementModel<dim> model = model_of(element);
  if (group.increments) { // stored
    ElementState<dim> state;
    const auto points = static_cast<std::size_t>(group.points);
    const std::size_t place = place_[element];
    const auto mean = [&](const std::vector<double>& array, std::size_t size, std::size_t k) {
      double sum = 0.0;
      for (std::size_t q = 0; q < points; ++q)
        sum +=
            array[((place / batch_size * points + q) * size + k) * batch_size + place % batch_size];
      return sum / static_cast<double>(points);
    };
    for (int k = 0; k < state.stress.size; ++k)
      state.stress[k] = mean(group.stress, static_cast<std::size_t>(state.stress.size),
                             static_cast<std::size_t>(k));
    for (int k = 0; k < group.law.history; ++k)
      state.history.push_back(mean(group.history, static_cast<std::size_t>(group.law.history),
                                   static_cast<std::size_t>(k)));
    const auto volume_of = [](const Element<dim>& of) {
      double sum = 0.0;
      for (const auto& point : points_of(of))
        sum += point.volume;
      return sum;
    };
    const double volume = volume_of(model.element);
    // Elastic energy of the mean stress, of an isotropic solid.
    const double young = model.moduli.young(), nu = young / (2.0 * model.moduli.mu) - 1.0;
    const double pressure = trace(state.stress);
    state.energy = volume *
                   ((1.0 + nu) * contract(state.stress, state.stress) - nu * pressure * pressure) /
                   (2.0 * young);
    if (group.kinematics == Kinematics::rate) { // stored is Kirchhoff's
      Element<dim> deformed = model.element;    // where the last forces were computed
      const auto nodes = mesh_.nodes_of_element(element);
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        const std::uint32_t row = patches_.row_of_node[nodes[a]];
        deformed.corners.col(static_cast<Eigen::Index>(a)) +=
            displacement_[row] - (step_ > 0 ? time_step_ : 0.0) * velocity_[row];
      }
      double J = volume_of(deformed) / volume;
      if (settings_.plane == Plane::stress) // the strain through the thickness comes last
        J *= std::exp(state.history.back());
      for (int k = 0; k < state.stress.size; ++k)
        state.stress[k] /= J;
    }
    return state;
  }
  Corners<dim> u(dim, model.element.corners.cols());
  const auto nodes = mesh_.nodes_of_element(element);
  const Vec<dim> first = displacement_[patches_.row_of_node[nodes[0]]];
  for (std::size_t a = 0; a < nodes.size();
       ++a) // only differences strain; the hoop needs them whole
    u.col(static_cast<Eigen::Index>(a)) =
        displacement_[patches_.row_of_node[nodes[a]]] -
        (settings_.plane == Plane::axisymmetric ? Vec<dim>::Zero().eval() : first);
  return std::visit(
      [&](const auto& law) -> ElementState<dim> {
        using LawType = std::decay_t<decltype(law)>;
        if constexpr (std::is_same_v<LawType, NeoHookean> || LinearLaw<LawType>) {
          if constexpr (dim == 2)
            if (settings_.plane == Plane::stress)
              return evaluate<dim>(PlaneStress<LawType>(law), model, u);
          return evaluate<dim>(law, model, u);
        } else {
          return {}; // these store their stress
        }
      },
      settings_.materials[material_of_[element]].material.law);
}

template ElementState<2> Engine<2>::element_state(std::uint32_t) const;
template ElementState<3> Engine<3>::element_state(std::uint32_t) const;

} // namespace kerf::fem
