#include "tests/benchmarks/fem_limit.hpp"

#include "tests/benchmarks/machine.hpp"

#include <algorithm>
#include <stdexcept>

namespace kerf::benchmarks {
namespace {

constexpr double division = 5, root = 5, logarithm = 25;

/// Of one point, by dimension.
struct ByDimension {
  double in_2d, in_3d;
  double of(int dim) const { return dim == 2 ? in_2d : in_3d; }
};
constexpr ByDimension jacobian = {3, 32};       // cofactors and determinant
constexpr ByDimension gradient = {17, 55};      // derivatives . cofactors / det, symmetric part
constexpr ByDimension force = {19, 60};         // weight * stress . cofactors, added up
constexpr ByDimension elastic = {7, 12};        // 2 mu eps + lambda tr(eps) 1
constexpr ByDimension anisotropic = {49, 67};   // TransverselyIsotropic::stress()
constexpr ByDimension neo_hookean = {28, 72};   // mu (b - 1) + lambda ln J 1, without the logarithm
constexpr ByDimension radial_return = {44, 58}; // trial stress, yield function, flow
constexpr ByDimension stress_power = {20, 28};  // mean stress : strain increment, dissipation
constexpr ByDimension rotation = {31, 130};     // the turn of a stress, Hughes and Winget
constexpr ByDimension middle = {8, 18};         // the configuration in the middle of a step

double response(const std::string& law, int dim) {
  if (law == "linear")
    return elastic.of(dim);
  if (law == "total_strain")
    return anisotropic.of(dim);
  if (law == "neo_hookean")
    return neo_hookean.of(dim) + logarithm;
  const double flow = radial_return.of(dim) + division + root + stress_power.of(dim);
  if (law == "j2")
    return flow;
  if (law == "j2_finite")
    return flow + rotation.of(dim) + division;
  throw std::invalid_argument("there is no law " + law);
}

/// From the corner values of a vector field to its derivatives at the points; the transpose takes
/// about as much.
double derivatives(fem::Shape shape) {
  switch (shape) {
  case fem::Shape::tri3:
    return 2 * 2;
  case fem::Shape::quad4:
    return 2 * (7 + 1 + 4); // modes, their factors, values at the points
  case fem::Shape::tet4:
    return 3 * 3;
  case fem::Shape::hex8:
    break;
  }
  return 3 * (23 + 4 + 24);
}

/// Full integration.
double operations(const FemWorkload& workload, const std::string& law, int points) {
  const int dim = fem::dimension_of(workload.shape);
  double at_point =
      jacobian.of(dim) + division + gradient.of(dim) + response(law, dim) + force.of(dim);
  if (law == "neo_hookean")
    at_point += jacobian.of(dim) + division;
  if (law == "j2_finite")
    at_point += jacobian.of(dim) + middle.of(dim);
  return 3 * derivatives(workload.shape) + points * at_point; // of X, u and the forces
}

/// One-point hexahedra: the mean gradient and the stiffness against four hourglass modes.
double operations_one_point(const std::string& law) {
  constexpr double modes = 3 * 23, mean_gradient = 12 * 15 + 36, of_field = 9 * 11, strain = 10;
  constexpr double hourglass = 12 * 6 + 36 + 6 + 12 * 2 + 12 * 7, forces = 18 * 5 + 12 + 6;
  double result = 3 * modes + mean_gradient + of_field + strain + division + response(law, 3) +
                  hourglass + forces;
  if (law == "neo_hookean") // tau . F^-T
    result += 12 + jacobian.of(3) + division + 54;
  if (law == "j2_finite")
    result += 2 * 21 + mean_gradient + 12 * 5;
  return result;
}

} // namespace

ElementWork work_of(const FemWorkload& workload, const std::string& law, double nodes_per_element) {
  const int dim = fem::dimension_of(workload.shape), nodes = fem::nodes_of(workload.shape);
  const bool one_point = workload.formulation == fem::Formulation::one_point;
  const bool stored = law == "j2" || law == "j2_finite";
  const bool simplex = nodes == dim + 1;
  const int points = one_point || simplex ? 1 : nodes;

  ElementWork result;
  result.operations = one_point ? operations_one_point(law) : operations(workload, law, points);
  result.operations += nodes * dim;                  // sums at the nodes
  result.operations += nodes_per_element * dim * 13; // a, v, u and the energy books

  constexpr double number = sizeof(double), index = sizeof(std::uint16_t);
  const double row = dim == 2 ? 2 * number : 4 * number; // as aligned vectors
  result.bytes = nodes * index + nodes_per_element * (row /*X*/ + 4 * row /*u, v*/ + number /*m*/);
  if (stored) // stress and plastic strain are read and written
    result.bytes += 2.0 * points * ((dim == 2 ? 4 : 6) + 1) * number;
  if (stored && one_point)
    result.bytes += 2.0 * 12 * number;
  return result;
}

double limit_of(const ElementWork& work, std::size_t elements) {
  const double of_memory = bandwidth(work.bytes * static_cast<double>(elements)) / work.bytes;
  return 1e3 * std::min(multiply_adds() / work.operations, of_memory);
}

} // namespace kerf::benchmarks
