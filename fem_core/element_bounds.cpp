#include "fem_core/element_bounds.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kerf::fem {
namespace {

/// Whether two elements are the same but for where they are, up to the rounding of their corners.
template <int dim> bool alike(const ElementModel<dim>& a, const ElementModel<dim>& b) {
  constexpr double rounding = 1e-12;
  const Element<dim>&x = a.element, &y = b.element;
  if (x.shape != y.shape || x.space == Space::axisymmetric || a.formulation != b.formulation ||
      a.moduli.lambda != b.moduli.lambda || a.moduli.mu != b.moduli.mu ||
      a.hourglass != b.hourglass || a.hourglass_viscosity != b.hourglass_viscosity ||
      a.density != b.density)
    return false;
  const Corners<dim> of_x = x.corners.colwise() - x.corners.col(0);
  const Corners<dim> of_y = y.corners.colwise() - y.corners.col(0);
  if (!((of_x - of_y).cwiseAbs().maxCoeff() <= rounding * of_x.cwiseAbs().maxCoeff()))
    return false;
  return x.alpha.size() == y.alpha.size() &&
         (x.alpha.size() == 0 || (x.alpha - y.alpha).cwiseAbs().maxCoeff() <= rounding);
}

/// Largest eigenvalue with some stiffness of the hourglass control.
template <int dim> double largest_eigenvalue(const ElementModel<dim>& model, double hourglass) {
  ElementMatrix<dim> A = stiffness_of(model.element, model.formulation, model.moduli, hourglass);
  const CornerValues mass = lumped_mass(model.element, model.density);
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < A.cols(); ++j)
      A(i, j) /= std::sqrt(mass[i / dim] * mass[j / dim]);
  return Eigen::SelfAdjointEigenSolver<ElementMatrix<dim>>(A, Eigen::EigenvaluesOnly)
      .eigenvalues()[A.rows() - 1];
}

/// Viscosity zeta rho c_P acts on hourglass modes as stiffness would of this modulus times
/// omega = 2 / dt, Pa s.
template <int dim> double viscous_modulus(const ElementModel<dim>& model) {
  return model.hourglass_viscosity / std::sqrt(hourglass_wave_number2(model.element));
}

} // namespace

// With velocities of half a step ago central differences need 4 M >= dt² K + 2 dt C. C is the
// stiffness of the control with another modulus, so omega² = eig(k + c omega), which grows with
// omega: from a number above it the iteration never falls below it.
template <int dim> double omega2_of(const ElementModel<dim>& model) {
  const double stiff = largest_eigenvalue(model, model.hourglass);
  if (model.hourglass_viscosity == 0.0 || model.formulation != Formulation::one_point)
    return stiff;
  const double c = viscous_modulus(model);
  ElementModel<dim> control = model;
  control.moduli = {};
  const double p = 0.5 * largest_eigenvalue(control, c); // omega² <= stiff + 2 p omega
  double omega = p + std::sqrt(p * p + stiff);
  for (int i = 0; i < 3; ++i)
    omega = std::sqrt(largest_eigenvalue(model, model.hourglass + c * omega));
  return omega * omega;
}

template <int dim> double cheap_omega2_of(const ElementModel<dim>& model) {
  const auto [lambda, mu] = model.moduli;
  CornerValues mass = CornerValues::Zero(model.element.corners.cols());
  double stiffness = 0.0, volume = 0.0, square = 0.0;
  for (const ElementPoint<dim>& point : points_of(model.element)) {
    mass += model.density * point.volume * point.N;
    Corners<dim> trace = point.gradient; // tr H = sum_a trace_a . u_a
    double hoop = 0.0;
    if (point.radius > 0.0) {
      trace.row(0) += point.N.transpose() / point.radius;
      hoop = point.N.squaredNorm() / (point.radius * point.radius);
    }
    const Eigen::Matrix<double, dim, dim> G = point.gradient * point.gradient.transpose();
    const double norm =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, dim, dim>>(G, Eigen::EigenvaluesOnly)
            .eigenvalues()[dim - 1];
    stiffness +=
        point.volume * (std::max(lambda, 0.0) * trace.squaredNorm() + 2.0 * mu * (norm + hoop));
    volume += point.volume;
    square += point.volume * point.gradient.squaredNorm();
  }
  if (model.formulation == Formulation::one_point) {
    // |gamma|² <= (|h| + |b| |X h|)², with the mean gradient no larger than the mean of its size.
    const double nodes = static_cast<double>(mass.size());
    const auto centred =
        (model.element.corners.colwise() - model.element.corners.rowwise().mean()).eval();
    const double gamma = std::sqrt(nodes) * (1.0 + std::sqrt(square / volume) * centred.norm());
    const double control =
        square / (3.0 * dim * nodes) * gamma * gamma * (dim == 2 ? 1.0 : 4.0) / mass.minCoeff();
    const double stiff = stiffness / mass.minCoeff() + model.hourglass * control;
    if (model.hourglass_viscosity == 0.0)
      return stiff;
    const double p = 0.5 * control * viscous_modulus(model), omega = p + std::sqrt(p * p + stiff);
    return omega * omega;
  }
  return stiffness / mass.minCoeff();
}

template <int dim>
LargestOmega2 largest_omega2(std::size_t num_elements,
                             const std::function<ElementModel<dim>(std::size_t)>& model) {
  std::vector<double> bound(num_elements);
  const auto size = static_cast<std::int64_t>(num_elements);
#pragma omp parallel for schedule(static) if (size > 1000)
  for (std::int64_t e = 0; e < size; ++e)
    bound[static_cast<std::size_t>(e)] = cheap_omega2_of<dim>(model(static_cast<std::size_t>(e)));
  std::vector<std::uint32_t> order(num_elements);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return bound[a] != bound[b] ? bound[a] > bound[b] : a < b;
  });

  // In rounds of a fixed size, so that what is solved does not depend on the number of threads. In
  // a structured mesh most elements are like the one before.
  LargestOmega2 largest;
  constexpr std::size_t round = 256, run = 32;
  for (std::size_t first = 0; first < num_elements && bound[order[first]] > largest.value;
       first += round) {
    std::vector<double> solved(std::min(round, num_elements - first));
    const auto runs = static_cast<std::int64_t>((solved.size() + run - 1) / run);
#pragma omp parallel for schedule(static) if (runs > 1)
    for (std::int64_t r = 0; r < runs; ++r) {
      const std::size_t begin = static_cast<std::size_t>(r) * run;
      ElementModel<dim> last;
      for (std::size_t k = begin; k < std::min(begin + run, solved.size()); ++k) {
        const ElementModel<dim> next = model(order[first + k]);
        const bool known = k > begin && alike(last, next);
        solved[k] = known ? solved[k - 1] : omega2_of(next);
        last = next;
      }
    }
    for (std::size_t k = 0; k < solved.size(); ++k)
      if (solved[k] > largest.value)
        largest = {solved[k], order[first + k]};
  }
  return largest;
}

template double omega2_of(const ElementModel<2>&);
template double omega2_of(const ElementModel<3>&);
template double cheap_omega2_of(const ElementModel<2>&);
template double cheap_omega2_of(const ElementModel<3>&);
template LargestOmega2 largest_omega2<2>(std::size_t,
                                         const std::function<ElementModel<2>(std::size_t)>&);
template LargestOmega2 largest_omega2<3>(std::size_t,
                                         const std::function<ElementModel<3>(std::size_t)>&);

} // namespace kerf::fem
