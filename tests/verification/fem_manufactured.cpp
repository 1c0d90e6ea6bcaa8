// A manufactured motion of large strain: the body force that it needs is given, and how fast the
// error vanishes with the size of the elements is observed.
#include "tests/cases/fem_loads.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kerf::fem {
namespace {

using cases::rock;
constexpr double pi = std::numbers::pi;
template <int dim> using Tensor = Eigen::Matrix<double, dim, dim>;

/// u_i = a_i cos(w t) prod_j sin(pi x_j) in a box of 1 m that is held all around.
template <int dim> struct HeldMotion {
  Vec<dim> a = Vec<dim>::LinSpaced(dim, 0.08, -0.06);                 // m
  double omega = pi * std::sqrt(dim * rock.moduli.mu / rock.density); // rad/s

  Vec<dim> at(const Vec<dim>& X, double t) const {
    return std::cos(omega * t) * (pi * X).array().sin().prod() * a;
  }
  /// First Piola-Kirchhoff stress P = mu (F - F^-T) + lambda ln J F^-T, Pa.
  Tensor<dim> stress(const Vec<dim>& X, double t) const {
    Tensor<dim> F = Tensor<dim>::Identity();
    for (int j = 0; j < dim; ++j) {
      double slope = pi * std::cos(omega * t);
      for (int k = 0; k < dim; ++k)
        slope *= k == j ? std::cos(pi * X[k]) : std::sin(pi * X[k]);
      F.col(j) += slope * a;
    }
    const Tensor<dim> F_T = F.inverse().transpose();
    return rock.moduli.mu * (F - F_T) + rock.moduli.lambda * std::log(F.determinant()) * F_T;
  }
  /// rho a - Div P, by differences that are exact to 1e-7, N/m³.
  Vec<dim> force(const Vec<dim>& X, double t) const {
    const double h = 1e-4;
    Vec<dim> b = -omega * omega * rock.density * at(X, t);
    for (int j = 0; j < dim; ++j) {
      const Vec<dim> step = h * Vec<dim>::Unit(j);
      b -= (stress(X + step, t) - stress(X - step, t)).col(j) / (2.0 * h);
    }
    return b;
  }
};

/// L2 norm of the error when the motion has turned to the other side, over that of the motion.
template <int dim> double error_of(Shape shape, std::uint32_t count) {
  const HeldMotion<dim> motion;
  BoxMesh<dim> box{.size = Vec<dim>::Ones(), .shape = shape};
  box.count.fill(count);
  Mesh<dim> mesh = make_box(box);
  std::vector<BoundarySetting<dim>> walls;
  for (const auto& [tag, faces] : mesh.boundary) {
    walls.push_back(cases::held<dim>(tag, {}));
    walls.back().components.fill(true);
  }
  Engine<dim> engine(mesh,
                     {.materials = cases::of<dim>(NeoHookean::from(rock)), .boundary = walls});
  const double time = 0.8 * pi / motion.omega;
  const int steps = static_cast<int>(std::ceil(time / (0.3 * cases::critical_step(engine))));
  const auto nodes = cases::all_nodes(engine);
  const std::vector<double> mass = engine.mass();
  std::vector<double> u(mesh.positions.size()), force(u.size());
  for (std::size_t a = 0; a < nodes.size(); ++a)
    Eigen::Map<Vec<dim>>(u.data() + a * dim) = motion.at(mesh.position(a), 0.0);
  engine.start(time / steps);
  engine.set_motion(u, std::vector<double>(u.size()));
  for (int n = 0; n < steps; ++n) {
    for (std::size_t a = 0; a < nodes.size(); ++a)
      Eigen::Map<Vec<dim>>(force.data() + a * dim) =
          mass[a] / rock.density * motion.force(mesh.position(a), n * time / steps);
    engine.compute_own_forces();
    engine.add_interface_forces(nodes, force);
    engine.integrate();
  }
  const std::vector<double> reached = engine.displacement();
  double error = 0.0, norm = 0.0;
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const Vec<dim> exact = motion.at(mesh.position(a), time);
    error += mass[a] * (Vec<dim>(&reached[a * dim]) - exact).squaredNorm();
    norm += mass[a] * exact.squaredNorm();
  }
  return std::sqrt(error / norm);
}

// As in tests/verification/fem_standing_waves.cpp, but with strains of a quarter.
TEST(FemManufacturedMotion, of_large_strain_is_met_with_second_order_in_the_size_of_elements) {
  for (const Shape shape : {Shape::tri3, Shape::quad4, Shape::tet4, Shape::hex8}) {
    const bool plane = dimension_of(shape) == 2;
    const double coarse = plane ? error_of<2>(shape, 16) : error_of<3>(shape, 11);
    const double fine = plane ? error_of<2>(shape, 32) : error_of<3>(shape, 22);
    const double order = std::log2(coarse / fine);
    const std::string name(name_of(shape));
    std::printf("  %s: errors %.2e, %.2e, order %.3f\n", name.c_str(), coarse, fine, order);
    verify({"order of a large motion in the size of neo-Hookean " + name,
            "second; manufactured motion with strains of 0.25", 0.1, "terms of higher order"},
           order - 2.0);
    EXPECT_LE(fine, 0.05);
  }
}

} // namespace
} // namespace kerf::fem
