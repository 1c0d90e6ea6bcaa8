// One element on its own: where it is integrated, its mass and its stiffness.
#pragma once

#include "common/vec.hpp"
#include "fem_core/kernels/patch_view.hpp"
#include "fem_core/laws/moduli.hpp"

#include <vector>

namespace kerf::fem {

template <int dim> using Corners = Eigen::Matrix<double, dim, Eigen::Dynamic, 0, dim, 8>;
using CornerValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1>;
template <int dim> inline constexpr int max_dofs = dim == 2 ? 8 : 24;
/// Rows and columns as [corner][component].
template <int dim>
using ElementMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_dofs<dim>, max_dofs<dim>>;
/// Strain of the displacements of the corners; rows as in Symmetric.
template <int dim>
using StrainMatrix =
    Eigen::Matrix<double, dim == 2 ? 4 : 6, Eigen::Dynamic, 0, dim == 2 ? 4 : 6, max_dofs<dim>>;

/// A point at which an element is integrated.
template <int dim> struct ElementPoint {
  CornerValues N;        // shape functions N_a
  Corners<dim> gradient; // dN_a/dX, as columns, 1/m
  /// The share alpha of the elements in the blended virtual work is part of the volume, Rojek
  /// (2008) eqs 44 and 46; and so is the whole ring of axisymmetry, m³ (m² in 2D).
  double volume = 0.0;
  double radius = 0.0; // of axisymmetry, m; 0: none

  /// Displacement gradient at the point; zz of 2D comes with strain_matrix() only.
  Eigen::Matrix<double, dim, dim> gradient_of(const Corners<dim>& u) const {
    return u * gradient.transpose();
  }
};

/// One element in some configuration.
template <int dim> struct Element {
  Shape shape = Shape::quad4;
  Space space = Space::plane;
  Corners<dim> corners; // m
  CornerValues alpha;   // of the corners; empty: one
};

/// Shape functions and their derivatives over the reference element: [-1, 1]^dim of quad4 and hex8,
/// the corner of the unit cube of tri3 and tet4.
template <int dim> CornerValues shape_functions(Shape shape, const Vec<dim>& xi);
template <int dim> Corners<dim> shape_derivatives(Shape shape, const Vec<dim>& xi);

/// The points of full integration: 2 x 2 (x 2) of quad4 and hex8, the centre of tri3 and tet4.
/// @throws std::invalid_argument when the Jacobian is not positive at one of them
template <int dim> std::vector<ElementPoint<dim>> points_of(const Element<dim>& element);

/// Row sums of the mass matrix, m_a = sum_q rho N_a alpha detJ, kg (per metre in 2D); the shape
/// functions add up to one, so these are the row sums of Rojek (2008) eq. 46.
template <int dim> CornerValues lumped_mass(const Element<dim>& element, double density);

/// Strains at the points as a formulation takes them; one_point has one only.
template <int dim>
std::vector<StrainMatrix<dim>> strain_matrices(const std::vector<ElementPoint<dim>>& points,
                                               Formulation formulation);

/// Stiffness of an element of an isotropic material, N/m (per metre in 2D).
/// @param hourglass  stiffness of the control of one_point, as in ElementConstants
template <int dim>
ElementMatrix<dim> stiffness_of(const Element<dim>& element, Formulation formulation,
                                const Moduli& moduli, double hourglass = 0.0);

/// n b.b / (3 dim) with the mean gradient b of an element with n nodes, 1/m²: a hourglass mode of a
/// parallelepiped that is controlled with the stiffness of the P wave has the frequency of this
/// wave number.
template <int dim> double hourglass_wave_number2(const Element<dim>& element);

} // namespace kerf::fem
