#include "coupler/methods/lagrange.hpp"

#include <algorithm>
#include <stdexcept>

namespace kerf::coupler {

template <int dim>
LagrangeSystem<dim>::LagrangeSystem(const Interpolation<dim>& N,
                                    std::span<const double> particle_inverse_mass,
                                    std::span<const double> node_inverse_mass) {
  const auto n = static_cast<Eigen::Index>(N.size());
  const std::size_t num_nodes = node_inverse_mass.size() / dim;
  right_.resize(n);
  solution_.resize(n);
  Eigen::SparseMatrix<double> operator_N(n, static_cast<Eigen::Index>(num_nodes));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < N.size(); ++i)
    for (int a = 0; a < corners<dim>; ++a)
      entries.emplace_back(static_cast<int>(i), static_cast<int>(N.node[i][a]), N.shape[i][a]);
  operator_N.setFromTriplets(entries.begin(), entries.end());

  for (int c = 0; c < dim; ++c) {
    const auto component = [&](std::span<const double> values, int which) {
      Eigen::VectorXd v(static_cast<Eigen::Index>(values.size() / dim));
      for (Eigen::Index k = 0; k < v.size(); ++k)
        v[k] = values[static_cast<std::size_t>(dim * k + which)];
      return v;
    };
    const Eigen::VectorXd inverse_D = component(particle_inverse_mass, c);
    const Eigen::VectorXd inverse_F = component(node_inverse_mass, c);
    bool shared = false;
    for (int earlier = 0; earlier < c && !shared; ++earlier)
      if (inverse_D == component(particle_inverse_mass, earlier) &&
          inverse_F == component(node_inverse_mass, earlier)) {
        factor_[c] = factor_[earlier];
        free_[c] = free_[earlier];
        shared = true;
      }
    if (shared)
      continue;

    Eigen::SparseMatrix<double> S = operator_N * inverse_F.asDiagonal() * operator_N.transpose();
    free_[c].resize(N.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      const double diagonal = S.coeff(i, i) + inverse_D[i];
      free_[c][static_cast<std::size_t>(i)] = diagonal > 0.0;
      S.coeffRef(i, i) = diagonal > 0.0 ? diagonal : 1.0;
    }
    S.makeCompressed();
    factor_[c] = std::make_shared<Factor>(S);
    if (factor_[c]->info() != Eigen::Success)
      throw std::runtime_error("the interface system of the Lagrange multipliers is singular");
  }
}

template <int dim>
void LagrangeSystem<dim>::solve(std::span<const double> acceleration, std::span<double> lambda) {
  const std::size_t n = static_cast<std::size_t>(right_.size());
  for (int c = 0; c < dim; ++c) {
    for (std::size_t i = 0; i < n; ++i)
      right_[static_cast<Eigen::Index>(i)] = free_[c][i] ? acceleration[dim * i + c] : 0.0;
    solution_ = factor_[c]->solve(right_);
    for (std::size_t i = 0; i < n; ++i)
      lambda[dim * i + c] = solution_[static_cast<Eigen::Index>(i)];
  }
}

template <int dim>
void multiplier_forces(const Interpolation<dim>& N, std::span<const double> lambda,
                       std::span<double> particle_force, std::span<double> node_force) {
  std::fill(node_force.begin(), node_force.end(), 0.0);
  for (std::size_t i = 0; i < N.size(); ++i) {
    const Eigen::Map<const Vec<dim>> multiplier(lambda.data() + dim * i);
    Eigen::Map<Vec<dim>>(particle_force.data() + dim * i) = -multiplier;
    for (int a = 0; a < corners<dim>; ++a)
      Eigen::Map<Vec<dim>>(node_force.data() + dim * N.node[i][a]) += N.shape[i][a] * multiplier;
  }
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template class LagrangeSystem<dim>;                                                              \
  template void multiplier_forces<dim>(const Interpolation<dim>&, std::span<const double>,         \
                                       std::span<double>, std::span<double>);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)
#undef KERF_INSTANTIATE

} // namespace kerf::coupler
