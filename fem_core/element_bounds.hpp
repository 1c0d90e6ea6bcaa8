// Bounds of the highest frequency, which limit the time step.
#pragma once

#include "fem_core/element.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace kerf::fem {

/// Central differences are stable for dt < 2 / sqrt(omega2).
struct StepLimit {
  double omega2 = 0.0;    // bound of the largest eigenvalue of M^-1 K, rad²/s²
  std::string limited_by; // what has it: "element 3"
};

/// An element with what it is made of.
template <int dim> struct ElementModel {
  Element<dim> element;
  Formulation formulation = Formulation::full;
  Moduli moduli; // of a solid that is at least as stiff, Pa
  double hourglass = 0.0;
  double hourglass_viscosity = 0.0; // zeta rho c_P, Pa s/m
  double density = 0.0;             // kg/m³
};

/// Largest eigenvalue of an element's own (K_e, M_e), both blended, rad²/s². Hourglass viscosity C
/// counts as the stiffness 2 C / dt at the critical step dt, which is what it takes from the step.
template <int dim> double omega2_of(const ElementModel<dim>& model);

/// A number that is never smaller, and cheap: with H the displacement gradient at a point,
/// lambda (tr H)² + 2 mu |sym H|² <= (lambda sum_a |g_a|² + 2 mu |sum_a g_a g_a^T|) |u|².
template <int dim> double cheap_omega2_of(const ElementModel<dim>& model);

/// The element with the largest eigenvalue, which bounds that of the assembled (K, M):
/// x.Kx = sum_e x.K_e x <= max_e omega2_e sum_e x.M_e x, for every x and so also for those that
/// prescribed nodes leave. Only elements whose cheap bound is above the largest eigenvalue so far
/// are solved.
struct LargestOmega2 {
  double value = 0.0;        // rad²/s²
  std::uint32_t element = 0; // of those given
};
template <int dim>
LargestOmega2 largest_omega2(std::size_t num_elements,
                             const std::function<ElementModel<dim>(std::size_t)>& model);

} // namespace kerf::fem
