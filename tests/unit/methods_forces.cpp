// Penalty and multipliers: what they conserve, what they enforce, and how stiff they are.
#include "coupler/methods/books.hpp"
#include "coupler/methods/lagrange.hpp"
#include "coupler/methods/penalty.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <random>

namespace kerf::coupler {
namespace {

/// Points in a row of quadrilaterals, with random places and values.
struct Scene {
  Interpolation<2> N;
  std::vector<double> nodes, points, offset, stiffness, inverse_D, inverse_F;

  explicit Scene(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    constexpr int elements = 4;
    for (int i = 0; i <= elements; ++i)
      nodes.insert(nodes.end(), {1.0 * i, 0.0, 1.0 * i, 1.0});
    for (std::uint32_t e = 0; e < elements; ++e)
      for (int p = 0; p < 2; ++p) {
        const double s = unit(random), t = unit(random);
        N.node.push_back({2 * e, 2 * e + 2, 2 * e + 3, 2 * e + 1});
        N.shape.push_back({(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t});
        stiffness.push_back(1.0 + unit(random));
        const Vec<2> x = N.at(N.size() - 1, nodes);
        points.insert(points.end(), {x[0], x[1]});
      }
    offset.assign(points.size(), 0.0);
    for (std::size_t k = 0; k < points.size(); ++k)
      inverse_D.push_back(0.5 + unit(random));
    for (std::size_t k = 0; k < nodes.size(); ++k)
      inverse_F.push_back(0.5 + unit(random));
  }

  std::vector<double> moved(const std::vector<double>& x, unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-1e-3, 1e-3);
    std::vector<double> result = x;
    for (double& value : result)
      value += shift(random);
    return result;
  }
};

struct Forces {
  std::vector<double> chi, on_points, on_nodes;
  double momentum, angular_momentum; // relative residuals

  Forces(const Scene& s, const std::vector<double>& points, const std::vector<double>& nodes)
      : chi(points.size()), on_points(points.size()), on_nodes(nodes.size()) {
    constraint<2>(s.N, points, nodes, s.offset, chi);
    penalty_forces<2>(s.N, chi, s.stiffness, on_points, on_nodes);
    const auto a = resultant<2>(points, on_points), b = resultant<2>(nodes, on_nodes);
    momentum = (a.force + b.force).norm() / (a.force_size + b.force_size);
    angular_momentum = (a.moment + b.moment).norm() / (a.moment_size + b.moment_size);
  }
};

// Shape functions that sum to one and reproduce linear fields give no resultant and no moment:
// the spring of a point pulls along chi at both of its ends.
TEST(Penalty, linear_and_angular_momentum_are_conserved) {
  const Scene s(1);
  const Forces f(s, s.moved(s.points, 2), s.moved(s.nodes, 3));
  EXPECT_LT(f.momentum, 1e-15);
  EXPECT_LT(f.angular_momentum, 1e-15);
}

TEST(Penalty, the_books_see_a_wrong_interpolation) {
  Scene s(1);
  s.N.shape[3][0] += 1e-6; // no longer sums to one
  EXPECT_GT(Forces(s, s.moved(s.points, 2), s.moved(s.nodes, 3)).momentum, 1e-9);
  Scene t(1);
  std::swap(t.N.shape[3][0], t.N.shape[3][2]); // sums to one, but is that of another point
  const std::vector<double> none = t.offset;
  constraint<2>(t.N, t.points, t.nodes, none, t.offset); // as a coupling does at its start
  EXPECT_GT(Forces(t, t.moved(t.points, 2), t.moved(t.nodes, 3)).angular_momentum, 1e-6);
}

TEST(Penalty, rigid_motions_give_no_force) {
  const Scene s(4);
  const double angle = 0.7; // rad: chi is frame-indifferent, the rotation need not be small
  const Eigen::Rotation2Dd turn(angle);
  const auto carried = [&](std::vector<double> x) {
    for (std::size_t k = 0; k < x.size(); k += 2) {
      Eigen::Map<Vec<2>> point(x.data() + k);
      point = (turn * Vec<2>(point) + Vec<2>(0.3, -0.2)).eval();
    }
    return x;
  };
  const Forces f(s, carried(s.points), carried(s.nodes));
  for (const double force : f.on_points)
    EXPECT_NEAR(force, 0.0, 1e-14); // stiffness about 1 N/m, positions about 4 m: round-off
}

TEST(Penalty, forces_are_the_gradient_of_the_stored_energy) {
  const Scene s(5);
  const std::vector<double> points = s.moved(s.points, 6), nodes = s.moved(s.nodes, 7);
  const Forces f(s, points, nodes);
  const auto energy = [&](const std::vector<double>& p, const std::vector<double>& n) {
    std::vector<double> chi(p.size());
    constraint<2>(s.N, p, n, s.offset, chi);
    return penalty_energy<2>(chi, s.stiffness);
  };
  const double h = 1e-5; // the energy is quadratic: central differences are exact to round-off
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    std::vector<double> up = nodes, down = nodes;
    up[k] += h;
    down[k] -= h;
    EXPECT_NEAR(f.on_nodes[k], -(energy(points, up) - energy(points, down)) / (2 * h), 1e-12);
  }
}

TEST(Penalty, stiffness_profiles_are_those_of_the_theory) {
  const std::vector<double> alpha = {0.0, 0.25, 0.5, 1.0}, k_n = {2.0, 2.0, 2.0, 2.0};
  EXPECT_EQ(penalty_stiffness(alpha, k_n, 3.0, StiffnessProfile::uniform),
            (std::vector<double>{6.0, 6.0, 6.0, 6.0}));
  EXPECT_EQ(penalty_stiffness(alpha, k_n, 3.0, StiffnessProfile::blended),
            (std::vector<double>{0.0, 4.5, 6.0, 0.0}));
}

// Reference: dense eigenvalues of M^-1 K for K = G^T k G, G = [I, -N], the springs alone.
TEST(Penalty, the_frequency_bound_is_never_below_the_largest_eigenvalue) {
  double tightest = 0.0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Scene s(seed);
    const auto n = static_cast<Eigen::Index>(s.N.size());
    const auto m = static_cast<Eigen::Index>(s.nodes.size() / 2);
    std::vector<double> bound_D(static_cast<std::size_t>(n)), bound_F(static_cast<std::size_t>(m));
    penalty_omega2<2>(s.N, s.stiffness, s.inverse_D, s.inverse_F, bound_D, bound_F);
    double bound = 0.0, largest = 0.0;
    for (const double value : bound_D)
      bound = std::max(bound, value);
    for (const double value : bound_F)
      bound = std::max(bound, value);
    for (int c = 0; c < 2; ++c) {
      Eigen::MatrixXd G = Eigen::MatrixXd::Zero(n, n + m);
      Eigen::VectorXd root_inverse_mass(n + m);
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto row = static_cast<std::size_t>(i);
        G(i, i) = 1.0;
        for (int a = 0; a < 4; ++a)
          G(i, n + s.N.node[row][a]) -= s.N.shape[row][a];
        G.row(i) *= std::sqrt(s.stiffness[row]);
        root_inverse_mass[i] = std::sqrt(s.inverse_D[2 * row + c]);
      }
      for (Eigen::Index k = 0; k < m; ++k)
        root_inverse_mass[n + k] = std::sqrt(s.inverse_F[2 * static_cast<std::size_t>(k) + c]);
      const Eigen::MatrixXd scaled = G * root_inverse_mass.asDiagonal();
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled.transpose() * scaled);
      largest = std::max(largest, solver.eigenvalues().maxCoeff());
    }
    EXPECT_GE(bound, largest * (1.0 - 1e-12));
    tightest = std::max(tightest, largest / bound);
  }
  EXPECT_GT(tightest, 0.5); // it is a bound that a user can live with, not just a large number
}

// Reference: Rojek (2008) eq. 52: after the solve the constrained accelerations agree exactly.
TEST(Lagrange, the_multipliers_take_the_relative_acceleration_away) {
  const Scene s(8);
  LagrangeSystem<2> system(s.N, s.inverse_D, s.inverse_F);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<double> gap(s.points.size()), lambda(gap.size());
  for (double& value : gap)
    value = any(random);
  system.solve(gap, lambda);
  std::vector<double> on_points(gap.size()), on_nodes(s.nodes.size());
  multiplier_forces<2>(s.N, lambda, on_points, on_nodes);
  std::vector<double> node_acceleration(on_nodes.size());
  for (std::size_t k = 0; k < on_nodes.size(); ++k)
    node_acceleration[k] = on_nodes[k] * s.inverse_F[k];
  for (std::size_t i = 0; i < s.N.size(); ++i) {
    const Vec<2> a = s.N.at(i, node_acceleration);
    for (std::size_t c = 0; c < 2; ++c)
      EXPECT_NEAR(on_points[2 * i + c] * s.inverse_D[2 * i + c] - a[static_cast<int>(c)],
                  -gap[2 * i + c], 1e-13); // condition number of S times round-off
  }
  const auto a = resultant<2>(s.points, on_points), b = resultant<2>(s.nodes, on_nodes);
  EXPECT_LT((a.force + b.force).norm() / (a.force_size + b.force_size), 1e-15);
  EXPECT_LT((a.moment + b.moment).norm() / (a.moment_size + b.moment_size), 1e-15);
}

TEST(Lagrange, a_component_that_is_prescribed_on_both_sides_gets_no_force) {
  Scene s(10);
  for (std::size_t k = 1; k < s.inverse_D.size(); k += 2)
    s.inverse_D[k] = 0.0;
  for (std::size_t k = 1; k < s.inverse_F.size(); k += 2)
    s.inverse_F[k] = 0.0;
  LagrangeSystem<2> system(s.N, s.inverse_D, s.inverse_F);
  std::vector<double> gap(s.points.size(), 1.0), lambda(gap.size());
  system.solve(gap, lambda);
  for (std::size_t k = 0; k < lambda.size(); ++k)
    EXPECT_EQ(lambda[k] == 0.0, k % 2 == 1);
}

} // namespace
} // namespace kerf::coupler
