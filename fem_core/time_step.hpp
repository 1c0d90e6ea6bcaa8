// Bound of the highest frequency, which limits the time step.
#pragma once

#include "fem_core/elements.hpp"
#include "fem_core/materials.hpp"

#include <string>
#include <vector>

namespace kerf::fem {

/// Central differences are stable for dt < 2 / sqrt(omega2).
struct StepLimit {
  double omega2 = 0.0;    // bound of the largest eigenvalue of M^-1 K, rad²/s²
  std::string limited_by; // what has it: "element 3"
};

/// Stiffness of an element, N/m (per metre in 2D), rows and columns as [node][component].
template <int dim>
Eigen::Matrix<double, element_nodes<dim> * dim, element_nodes<dim> * dim>
element_stiffness(const Elements<dim>& elements, std::size_t element,
                  const LinearElastic& material);

/// Largest eigenvalue of every element's own (K_e, M_e), both blended, rad²/s². The largest of them
/// bounds that of the assembled (K, M): x.Kx = sum_e x.K_e x <= max_e omega2_e sum_e x.M_e x, for
/// every x and so also for those that prescribed nodes leave.
/// @return [elements.size()]
template <int dim>
std::vector<double> element_omega2(const Elements<dim>& elements, const LinearElastic& material);

} // namespace kerf::fem
