// One body's rows of the stiffness matrix, from its contacts.
#pragma once

#include "dem_core/clusters.hpp"
#include "dem_core/contact.hpp"
#include "dem_core/particles.hpp"

namespace kerf::dem {

/// Translations u of a body, then rotations L theta scaled by a length.
inline constexpr int dofs(int dim) {
  return dim == 2 ? 3 : 6;
}

template <int dim> struct RowBlock {
  Eigen::Matrix<double, dofs(dim), dofs(dim)> own =
      Eigen::Matrix<double, dofs(dim), dofs(dim)>::Zero(); // summed before absolute values
  Eigen::Matrix<double, dofs(dim), 1> others = Eigen::Matrix<double, dofs(dim), 1>::Zero();

  /// Adds contact k, with its stiffness against small motions from where it is.
  /// @param is_second  the body has the second particle
  void add(const Contacts<dim>& contacts, const Particles<dim>& particles,
           const Clusters<dim>& clusters, std::size_t k, bool is_second);
  /// Sums of absolute values, N/m.
  Eigen::Matrix<double, dofs(dim), 1> sums() const {
    return own.cwiseAbs().rowwise().sum() + others;
  }
};

} // namespace kerf::dem
