#include "fem_core/element.hpp"

#include <Eigen/LU>
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace kerf::fem {
namespace {

constexpr bool is_simplex(Shape shape) {
  return shape == Shape::tri3 || shape == Shape::tet4;
}

/// Side of a quad4 or hex8 on which its corner lies along an axis, -1 or 1. VTK's order goes round
/// the lower face, then round the upper one.
int sign_of(int corner, int axis) {
  return 2 * (axis == 0 ? (corner ^ (corner >> 1)) & 1 : (corner >> axis) & 1) - 1;
}

template <int dim> std::vector<Vec<dim>> gauss_points(Shape shape) {
  if (is_simplex(shape))
    return {Vec<dim>::Constant(1.0 / (dim + 1))};
  std::vector<Vec<dim>> points(1u << dim);
  for (std::size_t q = 0; q < points.size(); ++q)
    for (int i = 0; i < dim; ++i)
      points[q][i] = (q >> i & 1u ? 1.0 : -1.0) / std::numbers::sqrt3; // x fastest
  return points;
}

/// Volume of the reference element that a point stands for.
double weight_of(Shape shape) {
  return shape == Shape::tri3 ? 0.5 : shape == Shape::tet4 ? 1.0 / 6.0 : 1.0;
}

/// The strain matrix of given gradients; the shape functions over the radius give the hoop.
template <int dim>
StrainMatrix<dim> strain_matrix(const Corners<dim>& gradient, const CornerValues& hoop) {
  const Eigen::Index nodes = gradient.cols();
  StrainMatrix<dim> B = StrainMatrix<dim>::Zero(B.RowsAtCompileTime, nodes * dim);
  for (Eigen::Index a = 0; a < nodes; ++a) {
    const auto g = gradient.col(a);
    const Eigen::Index k = a * dim;
    for (int i = 0; i < dim; ++i)
      B(i, k + i) = g[i];
    if constexpr (dim == 2) {
      B(2, k) = hoop[a];
      B(3, k) = 0.5 * g[1];
      B(3, k + 1) = 0.5 * g[0];
    } else {
      B(3, k + 1) = B(4, k) = 0.5 * g[2];
      B(3, k + 2) = B(5, k) = 0.5 * g[1];
      B(4, k + 2) = B(5, k + 1) = 0.5 * g[0];
    }
  }
  return B;
}

template <int dim> CornerValues hoop_of(const ElementPoint<dim>& point) {
  return point.radius > 0.0 ? CornerValues(point.N / point.radius)
                            : CornerValues(CornerValues::Zero(point.N.size()));
}

/// Adds the stiffness of the hourglass control: k gamma gamma^T of every mode and direction, with
/// k = hourglass V b.b / (3 dim nodes), which for hourglass = lambda + 2 mu is about that of full
/// integration; D. P. Flanagan and T. Belytschko, doi:10.1002/nme.1620170504.
template <int dim>
void add_hourglass(const Element<dim>& element, const Corners<dim>& mean, double volume,
                   double hourglass, ElementMatrix<dim>& K) {
  const Eigen::Index nodes = element.corners.cols();
  const double k =
      hourglass * volume * mean.squaredNorm() / (3.0 * dim * static_cast<double>(nodes));
  const std::vector<std::vector<int>> modes =
      dim == 2 ? std::vector<std::vector<int>>{{0, 1}}
               : std::vector<std::vector<int>>{{0, 1}, {1, 2}, {2, 0}, {0, 1, 2}};
  for (const auto& axes : modes) {
    CornerValues h = CornerValues::Ones(nodes);
    for (Eigen::Index a = 0; a < nodes; ++a)
      for (const int axis : axes)
        h[a] *= sign_of(static_cast<int>(a), axis);
    const CornerValues gamma = h - mean.transpose() * (element.corners * h);
    for (Eigen::Index a = 0; a < nodes; ++a)
      for (Eigen::Index b = 0; b < nodes; ++b)
        for (int i = 0; i < dim; ++i)
          K(a * dim + i, b * dim + i) += k * gamma[a] * gamma[b];
  }
}

} // namespace

template <int dim> CornerValues shape_functions(Shape shape, const Vec<dim>& xi) {
  CornerValues N(nodes_of(shape));
  if (is_simplex(shape)) {
    N[0] = 1.0 - xi.sum();
    for (int i = 0; i < dim; ++i)
      N[i + 1] = xi[i];
    return N;
  }
  for (int a = 0; a < N.size(); ++a) {
    N[a] = 1.0;
    for (int i = 0; i < dim; ++i)
      N[a] *= 0.5 * (1.0 + sign_of(a, i) * xi[i]);
  }
  return N;
}

template <int dim> Corners<dim> shape_derivatives(Shape shape, const Vec<dim>& xi) {
  Corners<dim> dN(dim, nodes_of(shape));
  if (is_simplex(shape)) {
    dN.col(0).setConstant(-1.0);
    dN.rightCols(dim).setIdentity();
    return dN;
  }
  for (int a = 0; a < dN.cols(); ++a)
    for (int j = 0; j < dim; ++j) {
      dN(j, a) = 1.0;
      for (int i = 0; i < dim; ++i)
        dN(j, a) *= i == j ? 0.5 * sign_of(a, i) : 0.5 * (1.0 + sign_of(a, i) * xi[i]);
    }
  return dN;
}

template <int dim> std::vector<ElementPoint<dim>> points_of(const Element<dim>& element) {
  std::vector<ElementPoint<dim>> points;
  for (const Vec<dim>& xi : gauss_points<dim>(element.shape)) {
    const Corners<dim> dN = shape_derivatives<dim>(element.shape, xi);
    const Eigen::Matrix<double, dim, dim> J = element.corners * dN.transpose(); // dX/dxi
    const double det = J.determinant();
    if (!(det > 0.0))
      throw std::invalid_argument(fmt::format("its Jacobian is {} at Gauss point {}; it must be "
                                              "positive",
                                              det, points.size()));
    ElementPoint<dim>& point = points.emplace_back();
    point.N = shape_functions<dim>(element.shape, xi);
    point.gradient = J.transpose().inverse() * dN;
    point.volume = weight_of(element.shape) * det;
    if (element.alpha.size() > 0)
      point.volume *= point.N.dot(element.alpha);
    if (element.space == Space::axisymmetric) {
      point.radius = element.corners.row(0).dot(point.N);
      point.volume *= 2.0 * std::numbers::pi * point.radius;
    }
  }
  return points;
}

template <int dim> CornerValues lumped_mass(const Element<dim>& element, double density) {
  CornerValues mass = CornerValues::Zero(element.corners.cols());
  for (const ElementPoint<dim>& point : points_of(element))
    mass += density * point.volume * point.N;
  return mass;
}

template <int dim>
std::vector<StrainMatrix<dim>> strain_matrices(const std::vector<ElementPoint<dim>>& points,
                                               Formulation formulation) {
  std::vector<StrainMatrix<dim>> strains;
  for (const ElementPoint<dim>& point : points)
    strains.push_back(strain_matrix<dim>(point.gradient, hoop_of(point)));
  if (formulation == Formulation::full || points.size() == 1)
    return strains;
  StrainMatrix<dim> mean = StrainMatrix<dim>::Zero(strains[0].rows(), strains[0].cols());
  double volume = 0.0;
  for (std::size_t q = 0; q < points.size(); ++q) {
    mean += points[q].volume * strains[q];
    volume += points[q].volume;
  }
  mean /= volume;
  if (formulation == Formulation::one_point)
    return {mean};
  const auto mean_dilatation = mean.template topRows<3>().colwise().sum().eval();
  for (StrainMatrix<dim>& B : strains) {
    const auto missing = ((mean_dilatation - B.template topRows<3>().colwise().sum()) / 3.0).eval();
    B.template topRows<3>().rowwise() += missing;
  }
  return strains;
}

template <int dim>
ElementMatrix<dim> stiffness_of(const Element<dim>& element, Formulation formulation,
                                const Moduli& moduli, double hourglass) {
  const auto points = points_of(element);
  const auto strains = strain_matrices<dim>(points, formulation);
  const Eigen::Index size = element.corners.cols() * dim;
  ElementMatrix<dim> K = ElementMatrix<dim>::Zero(size, size);
  double volume = 0.0;
  for (const ElementPoint<dim>& point : points)
    volume += point.volume;
  for (std::size_t q = 0; q < strains.size(); ++q) {
    const double weight = strains.size() == 1 ? volume : points[q].volume;
    StrainMatrix<dim> stress = 2.0 * moduli.mu * strains[q];
    stress.template topRows<3>().rowwise() +=
        (moduli.lambda * strains[q].template topRows<3>().colwise().sum()).eval();
    stress.bottomRows(stress.rows() - 3) *= 2.0; // shear works in both off-diagonal components
    K += weight * strains[q].transpose() * stress;
  }
  if (formulation == Formulation::one_point) {
    Corners<dim> mean = Corners<dim>::Zero(dim, element.corners.cols());
    for (const ElementPoint<dim>& point : points)
      mean += point.volume / volume * point.gradient;
    add_hourglass(element, mean, volume, hourglass, K);
  }
  return K;
}

template <int dim> double hourglass_wave_number2(const Element<dim>& element) {
  Corners<dim> mean = Corners<dim>::Zero(dim, element.corners.cols());
  double volume = 0.0;
  for (const ElementPoint<dim>& point : points_of(element)) {
    mean += point.volume * point.gradient;
    volume += point.volume;
  }
  return static_cast<double>(mean.cols()) * mean.squaredNorm() / (3.0 * dim * volume * volume);
}

template CornerValues shape_functions<2>(Shape, const Vec<2>&);
template CornerValues shape_functions<3>(Shape, const Vec<3>&);
template Corners<2> shape_derivatives<2>(Shape, const Vec<2>&);
template Corners<3> shape_derivatives<3>(Shape, const Vec<3>&);
template std::vector<ElementPoint<2>> points_of(const Element<2>&);
template std::vector<ElementPoint<3>> points_of(const Element<3>&);
template CornerValues lumped_mass(const Element<2>&, double);
template CornerValues lumped_mass(const Element<3>&, double);
template std::vector<StrainMatrix<2>> strain_matrices(const std::vector<ElementPoint<2>>&,
                                                      Formulation);
template std::vector<StrainMatrix<3>> strain_matrices(const std::vector<ElementPoint<3>>&,
                                                      Formulation);
template ElementMatrix<2> stiffness_of(const Element<2>&, Formulation, const Moduli&, double);
template ElementMatrix<3> stiffness_of(const Element<3>&, Formulation, const Moduli&, double);

template double hourglass_wave_number2(const Element<2>&);
template double hourglass_wave_number2(const Element<3>&);

} // namespace kerf::fem
