#include "fem_core/program/probe.hpp"

#include <Eigen/LU>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace kerf::fem {
namespace {

/// Where a point is in the reference element, by Newton's method; far outside when it is not near.
template <int dim>
Vec<dim> place_in(Shape shape, const Corners<dim>& corners, const Vec<dim>& point) {
  const bool is_simplex = nodes_of(shape) == dim + 1;
  Vec<dim> xi = Vec<dim>::Constant(is_simplex ? 0.25 : 0.0);
  for (int k = 0; k < 20 && xi.norm() < 10.0; ++k) {
    const Vec<dim> missed = point - corners * shape_functions<dim>(shape, xi);
    const Eigen::Matrix<double, dim, dim> J =
        corners * shape_derivatives<dim>(shape, xi).transpose();
    const Vec<dim> change = J.inverse() * missed;
    xi += change;
    if (change.norm() < 1e-14)
      break;
  }
  return xi;
}

/// How far a place is outside of the reference element; negative inside.
template <int dim> double outside(Shape shape, const Vec<dim>& xi) {
  if (nodes_of(shape) == dim + 1)
    return std::max(-xi.minCoeff(), xi.sum() - 1.0);
  return xi.cwiseAbs().maxCoeff() - 1.0;
}

template <int dim> Probe<dim> find_point(const Table& table, const Mesh<dim>& mesh) {
  constexpr double rounding = 1e-9;
  const Vec<dim> point = table.vector<dim>("point");
  for (std::uint32_t e = 0; e < mesh.num_elements(); ++e) {
    const Corners<dim> corners = mesh.corners(e);
    const Vec<dim> lower = corners.rowwise().minCoeff(), upper = corners.rowwise().maxCoeff();
    if (!(Box<dim>{lower, upper}.contains(point)))
      continue;
    const Shape shape = mesh.shape_of(e);
    const Vec<dim> xi = place_in<dim>(shape, corners, point);
    if (outside<dim>(shape, xi) <= rounding)
      return {table.text("name"), e, shape_functions<dim>(shape, xi)};
  }
  throw coupler::SettingsError(table.path("point"),
                               fmt::format("({:.6g}) m is in no element of the mesh",
                                           fmt::join(point.begin(), point.end(), ", ")));
}

} // namespace

template <int dim>
std::vector<Probe<dim>> read_probes(const std::vector<Table>& list, const Mesh<dim>& mesh) {
  std::vector<Probe<dim>> probes;
  for (const Table& table : list)
    probes.push_back(find_point(table, mesh));
  return probes;
}

template <int dim>
Vec<dim> at_probe(const Probe<dim>& probe, const Mesh<dim>& mesh, std::span<const double> values) {
  Vec<dim> sum = Vec<dim>::Zero();
  const auto nodes = mesh.nodes_of_element(probe.element);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    sum += probe.N[static_cast<Eigen::Index>(a)] *
           Eigen::Map<const Vec<dim>>(&values[std::size_t{nodes[a]} * dim]);
  return sum;
}

template <int dim>
std::vector<double> displacement_of_step(const Engine<dim>& engine, double time_step) {
  std::vector<double> u = engine.displacement_since_reset();
  const std::vector<double> v = engine.velocity();
  for (std::size_t dof = 0; dof < u.size(); ++dof)
    u[dof] -= time_step * v[dof];
  return u;
}

template <int dim>
Symmetric<double, dim> stress_at(const Probe<dim>& probe, const Engine<dim>& engine) {
  if (std::ranges::binary_search(engine.active_elements(), probe.element))
    return engine.element_state(probe.element).stress;
  Symmetric<double, dim> none;
  std::ranges::fill(none.c, std::numeric_limits<double>::quiet_NaN());
  return none;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template std::vector<Probe<dim>> read_probes(const std::vector<Table>&, const Mesh<dim>&);       \
  template Vec<dim> at_probe(const Probe<dim>&, const Mesh<dim>&, std::span<const double>);        \
  template std::vector<double> displacement_of_step(const Engine<dim>&, double);                   \
  template Symmetric<double, dim> stress_at(const Probe<dim>&, const Engine<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::fem
