#include "dem_core/packing/moduli.hpp"

#include "dem_core/packing/packing.hpp"
#include "dem_core/packing/power_cells.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <fmt/format.h>

#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace kerf::dem {

namespace {

/// The bonds as springs between the unknowns of their particles: displacement, then rotation.
template <int dim> class Network {
public:
  static constexpr int unknowns = dim + rotations<dim>; // of one particle
  using Values = Eigen::VectorXd;
  using Strain = Eigen::Matrix<double, dim, dim>;
  using Rows = Eigen::Matrix<double, dim, 2 * unknowns>;

  Network(std::span<const Vec<dim>> position, std::span<const double> radius,
          std::span<const Pair> bonds, double k_n, double k_t)
      : position_(position), radius_(radius), bonds_(bonds), k_n_(k_n), k_t_(k_t) {
    for (const auto [i, j] : bonds)
      if (!((position[j] - position[i]).norm() > 0.0))
        throw std::invalid_argument(fmt::format("particles {} and {} share a centre", i, j));
  }

  /// From the unknowns of both particles to the relative displacement at the contact, m.
  Rows opening(const Pair& bond) const {
    Rows rows = Rows::Zero();
    rows.template block<dim, dim>(0, 0) = -Strain::Identity();
    rows.template block<dim, dim>(0, unknowns) = Strain::Identity();
    const Vec<dim> branch = position_[bond.second] - position_[bond.first];
    const double share = share_of_first(bond);
    for (int r = 0; r < rotations<dim>; ++r) { // the surfaces move by omega x arm
      const Vec<dim> motion = spin<dim>(Rot<dim>::Unit(r), branch);
      rows.col(dim + r) = -share * motion;
      rows.col(unknowns + dim + r) = -(1.0 - share) * motion;
    }
    return rows;
  }
  /// From the relative displacement to the force on the first particle.
  Strain spring(const Pair& bond) const {
    const Vec<dim> n = (position_[bond.second] - position_[bond.first]).normalized();
    return k_t_ * Strain::Identity() + (k_n_ - k_t_) * (n * n.transpose());
  }
  double share_of_first(const Pair& bond) const {
    return radius_[bond.first] / (radius_[bond.first] + radius_[bond.second]);
  }
  Vec<dim> force_on_first(const Pair& bond, const Values& x) const {
    Eigen::Matrix<double, 2 * unknowns, 1> own;
    own << x.template segment<unknowns>(unknowns * bond.first),
        x.template segment<unknowns>(unknowns * bond.second);
    return spring(bond) * (opening(bond) * own);
  }

  /// Solves for the particles that are not held; x has the displacements of all on entry.
  void equilibrate(std::span<const std::uint8_t> is_held, Values& x) {
    if (matrix_.rows() == 0)
      assemble(is_held);
    // The residual of the homogeneous strain is what the free particles have to balance.
    Values load = Values::Zero(matrix_.rows());
    for (const Pair& bond : bonds_) {
      const Eigen::Matrix<double, 2 * unknowns, 1> forces =
          opening(bond).transpose() * force_on_first(bond, x);
      add_to_free(bond.first, -forces.template head<unknowns>(), load);
      add_to_free(bond.second, -forces.template tail<unknowns>(), load);
    }
    if (matrix_.rows() == 0 || load.squaredNorm() == 0.0)
      return;
    const Values correction = solver_.solve(load);
    if (solver_.info() != Eigen::Success)
      throw std::invalid_argument("the bonds do not hold the particles: there is no equilibrium");
    for (std::size_t i = 0; i < first_row_.size(); ++i)
      if (first_row_[i] >= 0)
        x.template segment<unknowns>(unknowns * static_cast<Eigen::Index>(i)) +=
            correction.template segment<unknowns>(first_row_[i]);
  }

private:
  void assemble(std::span<const std::uint8_t> is_held) {
    first_row_.assign(is_held.size(), -1);
    int rows = 0;
    for (std::size_t i = 0; i < is_held.size(); ++i)
      if (!is_held[i]) {
        first_row_[i] = rows;
        rows += unknowns;
      }
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < rows; ++row)
      entries.emplace_back(row, row, ground_share * k_n_ * ground_arm(row % unknowns));
    for (const Pair& bond : bonds_) {
      const Rows rows_of_bond = opening(bond);
      const Eigen::Matrix<double, 2 * unknowns, 2 * unknowns> block =
          rows_of_bond.transpose() * spring(bond) * rows_of_bond;
      const int first[2] = {first_row_[bond.first], first_row_[bond.second]};
      for (int p = 0; p < 2; ++p)
        for (int q = 0; q < 2; ++q)
          for (int a = 0; a < unknowns && first[p] >= 0 && first[q] >= 0; ++a)
            for (int b = 0; b < unknowns; ++b)
              entries.emplace_back(first[p] + a, first[q] + b,
                                   block(p * unknowns + a, q * unknowns + b));
    }
    matrix_.resize(rows, rows);
    matrix_.setFromTriplets(entries.begin(), entries.end());
    if constexpr (dim == 3)
      solver_.setTolerance(1e-10);
    solver_.compute(matrix_);
  }

  /// A spring to the ground holds what no bond holds: particles without bonds, and rotations that
  /// k_t = 0 leaves free. It is too weak to be felt.
  static constexpr double ground_share = 1e-12;
  double ground_arm(int unknown) const {
    return unknown < dim ? 1.0 : radius_[0] * radius_[0]; // m² for a rotation
  }

  void add_to_free(std::uint32_t i, const Eigen::Matrix<double, unknowns, 1>& forces,
                   Values& load) const {
    if (first_row_[i] >= 0)
      load.template segment<unknowns>(first_row_[i]) += forces;
  }

  std::span<const Vec<dim>> position_;
  std::span<const double> radius_;
  std::span<const Pair> bonds_;
  double k_n_, k_t_; // N/m
  // Factorisation is fastest in 2D, in 3D it would fill the memory.
  using Matrix = Eigen::SparseMatrix<double, dim == 2 ? Eigen::ColMajor : Eigen::RowMajor>;
  using Solver = std::conditional_t<dim == 2, Eigen::SimplicialLDLT<Matrix>,
                                    Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper>>;
  std::vector<int> first_row_; // of each particle in the matrix; -1 when it is held
  Matrix matrix_;
  Solver solver_;
};

/// Rows and columns of the stress and strain components in their usual order.
template <int dim> std::pair<int, int> component(int k) {
  constexpr std::pair<int, int> shear[] = {{1, 2}, {0, 2}, {0, 1}};
  return k < dim ? std::pair(k, k) : shear[dim == 2 ? 2 : k - dim];
}

} // namespace

template <int dim>
Moduli<dim> moduli(std::span<const Vec<dim>> position, std::span<const double> radius,
                   std::span<const Pair> bonds, double normal_stiffness,
                   double tangential_stiffness) {
  using Tensor = Eigen::Matrix<double, dim, dim>;
  const std::size_t count = radius.size();
  const PowerCells cells = power_cells<dim>(position, radius);
  Moduli<dim> result;
  double volume = 0.0, solid = 0.0;
  std::vector<std::uint8_t> is_held(count);
  for (std::size_t i = 0; i < count; ++i) {
    is_held[i] = !cells.is_closed[i];
    if (is_held[i])
      continue;
    ++result.measured_particles;
    volume += cells.volume[i];
    solid += particle_volume<dim>(radius[i]);
  }
  if (result.measured_particles == 0)
    throw std::invalid_argument("no particle has neighbours on all sides");

  Network<dim> network(position, radius, bonds, normal_stiffness, tangential_stiffness);
  constexpr int unknowns = Network<dim>::unknowns;
  for (int load = 0; load < strains(dim); ++load) {
    const auto [a, b] = component<dim>(load);
    Tensor strain = Tensor::Zero();
    strain(a, b) += 0.5; // twice for a normal strain
    strain(b, a) += 0.5;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(unknowns * static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i)
      x.template segment<dim>(unknowns * static_cast<Eigen::Index>(i)) = strain * position[i];
    network.equilibrate(is_held, x);

    Tensor stress = Tensor::Zero();
    for (const Pair& bond : bonds) {
      const double share = network.share_of_first(bond);
      const double measured =
          (is_held[bond.first] ? 0.0 : share) + (is_held[bond.second] ? 0.0 : 1.0 - share);
      stress += measured * (position[bond.second] - position[bond.first]) *
                network.force_on_first(bond, x).transpose();
    }
    for (int k = 0; k < strains(dim); ++k) {
      const auto [c, d] = component<dim>(k);
      result.stiffness(k, load) = 0.5 * (stress(c, d) + stress(d, c)) / volume;
    }
  }

  const auto& C = result.stiffness;
  result.C11 = C.diagonal().template head<dim>().mean();
  result.C66 = C.diagonal().template tail<strains(dim) - dim>().mean();
  result.C12 = (C.template topLeftCorner<dim, dim>().sum() - dim * result.C11) / (dim * (dim - 1));
  result.isotropy = 2.0 * result.C66 / (result.C11 - result.C12);
  result.coordination_number = 2.0 * static_cast<double>(bonds.size()) / static_cast<double>(count);
  result.bulk_density_factor = solid / volume;
  return result;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template Moduli<dim> moduli<dim>(std::span<const Vec<dim>>, std::span<const double>,             \
                                   std::span<const Pair>, double, double);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
