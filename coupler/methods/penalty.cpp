#include "coupler/methods/penalty.hpp"

#include <algorithm>

namespace kerf::coupler {

std::vector<double> penalty_stiffness(std::span<const double> alpha,
                                      std::span<const double> stiffness, double ratio,
                                      StiffnessProfile profile) {
  std::vector<double> k(alpha.size());
  for (std::size_t i = 0; i < k.size(); ++i) {
    const double shape =
        profile == StiffnessProfile::blended ? 4.0 * alpha[i] * (1.0 - alpha[i]) : 1.0;
    k[i] = shape * ratio * stiffness[i];
  }
  return k;
}

template <int dim>
void constraint(const Interpolation<dim>& N, std::span<const double> particles,
                std::span<const double> nodes, std::span<const double> offset,
                std::span<double> chi) {
  using ConstMap = Eigen::Map<const Vec<dim>>;
  for (std::size_t i = 0; i < N.size(); ++i)
    Eigen::Map<Vec<dim>>(chi.data() + dim * i) =
        ConstMap(particles.data() + dim * i) - N.at(i, nodes) - ConstMap(offset.data() + dim * i);
}

template <int dim>
void penalty_forces(const Interpolation<dim>& N, std::span<const double> chi,
                    std::span<const double> stiffness, std::span<double> particle_force,
                    std::span<double> node_force) {
  std::fill(node_force.begin(), node_force.end(), 0.0);
  for (std::size_t i = 0; i < N.size(); ++i) {
    const Vec<dim> f = stiffness[i] * Eigen::Map<const Vec<dim>>(chi.data() + dim * i);
    Eigen::Map<Vec<dim>>(particle_force.data() + dim * i) = -f;
    for (int a = 0; a < corners<dim>; ++a)
      Eigen::Map<Vec<dim>>(node_force.data() + dim * N.node[i][a]) += N.shape[i][a] * f;
  }
}

template <int dim>
void penalty_omega2(const Interpolation<dim>& N, std::span<const double> stiffness,
                    std::span<const double> particle_inverse_mass,
                    std::span<const double> node_inverse_mass, std::span<double> particle_omega2,
                    std::span<double> node_omega2) {
  const std::size_t num_nodes = node_omega2.size();
  std::vector<double> column(num_nodes, 0.0); // sum of a node's shape values over all points
  for (std::size_t i = 0; i < N.size(); ++i)
    for (int a = 0; a < corners<dim>; ++a)
      column[N.node[i][a]] += N.shape[i][a];

  std::fill(particle_omega2.begin(), particle_omega2.end(), 0.0);
  std::fill(node_omega2.begin(), node_omega2.end(), 0.0);
  std::vector<double> per_component(num_nodes);
  for (int c = 0; c < dim; ++c) {
    std::fill(per_component.begin(), per_component.end(), 0.0);
    for (std::size_t i = 0; i < N.size(); ++i) {
      const double inverse_D = particle_inverse_mass[dim * i + c]; // 1/m_D
      double inverse_F = 0.0;                                      // 1/m_F
      for (int a = 0; a < corners<dim>; ++a)
        inverse_F +=
            N.shape[i][a] * column[N.node[i][a]] * node_inverse_mass[dim * N.node[i][a] + c];
      const double both = inverse_D + inverse_F;
      // A side that cannot move is a ground already: the other one alone carries the spring.
      particle_omega2[i] =
          std::max(particle_omega2[i], inverse_D > 0.0 ? stiffness[i] * both : 0.0);
      if (inverse_F > 0.0)
        for (int a = 0; a < corners<dim>; ++a) {
          const std::uint32_t node = N.node[i][a];
          per_component[node] +=
              stiffness[i] * (both / inverse_F) * N.shape[i][a] * node_inverse_mass[dim * node + c];
        }
    }
    for (std::size_t n = 0; n < num_nodes; ++n)
      node_omega2[n] = std::max(node_omega2[n], per_component[n]);
  }
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template void constraint<dim>(const Interpolation<dim>&, std::span<const double>,                \
                                std::span<const double>, std::span<const double>,                  \
                                std::span<double>);                                                \
  template void penalty_forces<dim>(const Interpolation<dim>&, std::span<const double>,            \
                                    std::span<const double>, std::span<double>,                    \
                                    std::span<double>);                                            \
  template void penalty_omega2<dim>(const Interpolation<dim>&, std::span<const double>,            \
                                    std::span<const double>, std::span<const double>,              \
                                    std::span<double>, std::span<double>);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)
#undef KERF_INSTANTIATE

} // namespace kerf::coupler
