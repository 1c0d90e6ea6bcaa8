// Standing waves between smooth walls, an exact solution of elastodynamics: how fast the error
// vanishes with the size of the elements and with the time step.
#include "tests/cases/fem_loads.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kerf::fem {
namespace {

using cases::rock;
constexpr double pi = std::numbers::pi;

template <Shape of> struct Kind { static constexpr Shape shape = of; };
template <class> struct FemStandingWave : testing::Test {};
using Kinds =
    testing::Types<Kind<Shape::tri3>, Kind<Shape::quad4>, Kind<Shape::tet4>, Kind<Shape::hex8>>;
struct KindName {
  template <class K> static std::string GetName(int) { return std::string(name_of(K::shape)); }
};
TYPED_TEST_SUITE(FemStandingWave, Kinds, KindName);

/// A box of 1 m with walls on which it slides; the elements inside are bent smoothly.
template <int dim> Mesh<dim> bent_box(Shape shape, std::uint32_t count) {
  BoxMesh<dim> box{.size = Vec<dim>::Ones(), .shape = shape};
  box.count.fill(count);
  Mesh<dim> mesh = make_box(box);
  for (std::size_t a = 0; a < mesh.num_nodes(); ++a) {
    const double bend = (pi * mesh.position(a)).array().sin().prod();
    for (int i = 0; i < dim; ++i)
      mesh.positions[a * dim + static_cast<std::size_t>(i)] += 0.05 * (i + 1) * bend;
  }
  return mesh;
}

template <int dim> std::vector<BoundarySetting<dim>> sliding_walls() {
  const char* const tags[] = {"left", "right", "bottom", "top", "back", "front"};
  std::vector<BoundarySetting<dim>> walls;
  for (int i = 0; i < 2 * dim; ++i) {
    walls.push_back(cases::held<dim>(tags[i], {}));
    walls.back().components[static_cast<std::size_t>(i / 2)] = true;
  }
  return walls;
}

/// u_i = a_i sin(k_i x_i) prod_(j != i) cos(k_j x_j) cos(w t): with a along k a compression wave,
/// w = c_P |k|, with a across k a shear wave, w = c_S |k|. On the walls x_i = 0, 1 m it has neither
/// motion along the normal nor traction along the wall.
template <int dim> struct StandingWave {
  Vec<dim> k = pi * Vec<dim>::Ones(), a; // rad/m, m
  double speed;                          // m/s

  Vec<dim> at(const Vec<dim>& x, double t) const {
    Vec<dim> u = a * std::cos(speed * k.norm() * t);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        u[i] *= i == j ? std::sin(k[j] * x[j]) : std::cos(k[j] * x[j]);
    return u;
  }
};

/// One of each kind.
template <int dim> std::array<StandingWave<dim>, 2> waves(double amplitude) {
  const Vec<dim> across = Vec<dim>::Unit(0) - Vec<dim>::Unit(1);
  return {{{.a = amplitude * Vec<dim>::Ones(),
            .speed = std::sqrt(rock.moduli.uniaxial() / rock.density)},
           {.a = amplitude * across, .speed = std::sqrt(rock.moduli.mu / rock.density)}}};
}
constexpr double end_time = 4e-4; // s, about 0.6 periods of the slower wave

template <int dim> std::vector<double> exact(const Mesh<dim>& mesh, double amplitude, double t) {
  std::vector<double> u(mesh.positions.size());
  for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
    for (const StandingWave<dim>& wave : waves<dim>(amplitude))
      Eigen::Map<Vec<dim>>(u.data() + a * dim) += wave.at(mesh.position(a), t);
  return u;
}

/// Displacements at the end, from the exact ones at the start.
template <int dim> std::vector<double> run(Engine<dim>& engine, double amplitude, int steps) {
  engine.start(end_time / steps);
  const std::vector<double> u = exact(engine.mesh(), amplitude, 0.0);
  engine.set_motion(u, std::vector<double>(u.size()));
  for (int n = 0; n < steps; ++n)
    engine.integrate();
  return engine.displacement();
}

/// L2 norm of a difference, by the lumped masses.
template <int dim>
double difference(const Engine<dim>& engine, const std::vector<double>& a,
                  const std::vector<double>& b) {
  const std::vector<double> mass = engine.mass();
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += mass[k / dim] / rock.density * (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

template <int dim> int steps_of(const Engine<dim>& engine, double share) {
  return static_cast<int>(std::ceil(end_time / (share * cases::critical_step(engine))));
}

// Elements of first order have displacements of second order in L2 (Hughes 1987, section 4.1),
// lumped masses keep it, and so do central differences when the time step follows the size. 0.1 is
// what terms of higher order leave at these sizes.
TYPED_TEST(FemStandingWave, is_met_with_second_order_in_the_size_of_elements) {
  constexpr int dim = dimension_of(TypeParam::shape);
  const double amplitude = 1e-6;
  std::vector<double> errors;
  for (const std::uint32_t count : {dim == 2 ? 24u : 8u, dim == 2 ? 48u : 16u}) {
    Engine<dim> engine(bent_box<dim>(TypeParam::shape, count),
                       {.materials = cases::of<dim>(rock), .boundary = sliding_walls<dim>()});
    const auto u = run(engine, amplitude, steps_of(engine, 0.4));
    errors.push_back(difference(engine, u, exact(engine.mesh(), amplitude, end_time)) / amplitude);
  }
  const double order = std::log2(errors[0] / errors[1]);
  std::printf("  errors %.2e, %.2e of the amplitude: order %.3f\n", errors[0], errors[1], order);
  verify({"order of the displacement in the size of " + std::string(name_of(TypeParam::shape)),
          "second; standing waves of compression and shear between smooth walls", 0.1,
          "terms of higher order"},
         order - 2.0);
  EXPECT_LE(errors[1], 0.05);
}

// The same elements with steps dt, dt/2, dt/4: (u(dt) - u(dt/2)) / (u(dt/2) - u(dt/4)) is 2^order.
// Also for finite strain: 3 % in the wave of a neo-Hookean solid.
TYPED_TEST(FemStandingWave, is_met_with_second_order_in_the_time_step) {
  constexpr int dim = dimension_of(TypeParam::shape);
  for (const bool hyperelastic : {false, true}) {
    const double amplitude = hyperelastic ? 5e-3 : 1e-6;
    const Law law = hyperelastic ? Law(NeoHookean::from(rock)) : Law(rock);
    Engine<dim> engine(bent_box<dim>(TypeParam::shape, dim == 2 ? 12 : 6),
                       {.materials = cases::of<dim>(law), .boundary = sliding_walls<dim>()});
    const int steps = steps_of(engine, 0.4);
    const auto coarse = run(engine, amplitude, steps), middle = run(engine, amplitude, 2 * steps),
               fine = run(engine, amplitude, 4 * steps);
    const double order =
        std::log2(difference(engine, coarse, middle) / difference(engine, middle, fine));
    std::printf("  order %.3f\n", order);
    verify({"order of the displacement in the time step, " +
                std::string(name_of(TypeParam::shape)) + (hyperelastic ? ", neo-Hookean" : ""),
            "second, central differences", 0.1, "terms of higher order"},
           order - 2.0);
  }
}

} // namespace
} // namespace kerf::fem
