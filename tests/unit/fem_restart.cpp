// A run that is saved and goes on in another engine has the same bits: every law, formulation and
// kinematics.
#include "tests/cases/fem_bodies.hpp"

#include "fem_core/input_error.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace kerf::fem {
namespace {

using cases::rock;

std::vector<Law> laws(int dim) {
  return {
      rock,
      TransverselyIsotropic::from({.density = 2500.0,
                                   .young_in_plane = 10e9,
                                   .young_normal = 5e9,
                                   .poisson_in_plane = 0.2,
                                   .poisson_normal = 0.2,
                                   .shear_normal = 2e9,
                                   .axis = {1.0, 2.0, 0.0}},
                                  dim),
      NeoHookean::from(rock),
      J2Plastic::from(rock, Hardening::linear(20e6, 1e9)),
      DruckerPrager::from(rock, {.cohesion = 5e6, .friction_angle = 0.5, .tension_cutoff = 2e6}),
      IsotropicDamage::from(rock, {.tensile_strength = 5e6, .fracture_energy = 300.0})};
}

template <int dim> Settings<dim> moving(const Material& material, Plane plane) {
  Settings<dim> settings{.materials = {{.material = material, .region = {}, .box = {}}},
                         .plane = plane};
  settings.boundary = {cases::held<dim>("left", {true, true})};
  settings.boundary[0].motion = Motion::hann;
  settings.boundary[0].amplitude = 2e-5 * Vec<dim>::Unit(1);
  settings.boundary[0].duration = 1e-5;
  settings.initial = {{.box = {},
                       .velocity = InitialVelocity<dim>{Vec<dim>::LinSpaced(dim, 2.0, 30.0)},
                       .pulse = {}}};
  settings.gravity = 1e4 * Vec<dim>::Unit(1);
  settings.local_damping = 0.1;
  settings.walls = {
      {.tag = "right", .point = 3.02e-3 * Vec<dim>::Unit(0), .normal = -Vec<dim>::Unit(0)}};
  settings.absorbing = {{.tag = "top"}};
  return settings;
}

template <class Dim> struct FemRestart : testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
struct DimensionName {
  template <class Dim> static std::string GetName(int) { return Dim::value == 2 ? "2D" : "3D"; }
};
TYPED_TEST_SUITE(FemRestart, Dimensions, DimensionName);

TYPED_TEST(FemRestart, goes_on_to_the_same_bits_with_every_law_and_formulation) {
  constexpr int dim = TypeParam::value;
  int runs = 0;
  for (const Shape shape :
       dim == 2 ? std::vector{Shape::tri3, Shape::quad4} : std::vector{Shape::tet4, Shape::hex8})
    for (const Plane plane : dim == 2
                                 ? std::vector{Plane::strain, Plane::stress, Plane::axisymmetric}
                                 : std::vector{Plane::strain})
      for (const Law& law : laws(dim))
        for (const Formulation formulation : {Formulation::full, Formulation::mean_dilatation,
                                              Formulation::one_point, Formulation::nodal_pressure})
          for (const bool finite : {false, true}) {
            const bool rubber = std::holds_alternative<NeoHookean>(law);
            const bool layered = std::holds_alternative<TransverselyIsotropic>(law);
            if ((layered && plane == Plane::axisymmetric) || (rubber && !finite))
              continue;
            const Material material{.law = law,
                                    .finite_strain = finite,
                                    .formulation = formulation,
                                    .hourglass_viscosity = rubber ? 0.0 : 0.1,
                                    .linear_viscosity = rubber ? 0.0 : 0.06,
                                    .quadratic_viscosity = rubber ? 0.0 : 1.2};
            try {
              check(material, shape, plane);
            } catch (const InputError&) {
              continue;
            }
            SCOPED_TRACE(fmt::format("{}, plane {}, law {}, formulation {}, finite {}",
                                     name_of(shape), static_cast<int>(plane), law.index(),
                                     static_cast<int>(formulation), finite));
            Mesh<dim> mesh = cases::distorted_box<dim>(shape);
            if (plane == Plane::axisymmetric)
              for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
                mesh.positions[a * dim] += 5e-3;
            Settings<dim> settings = moving<dim>(material, plane);
            if (plane == Plane::axisymmetric)
              settings.walls[0].point[0] += 5e-3;
            Engine<dim> engine(mesh, settings), other(mesh, settings);
            const double dt = 0.7 * 2.0 / std::sqrt(engine.step_limit().omega2);
            engine.start(dt);
            for (int n = 0; n < 25; ++n)
              engine.integrate();
            const State saved = engine.state();
            other.start(dt);
            other.restore(saved);
            for (int n = 0; n < 25; ++n) {
              engine.integrate();
              other.integrate();
            }
            ASSERT_FALSE(engine.first_non_finite());
            EXPECT_EQ(engine.displacement(), other.displacement());
            EXPECT_EQ(engine.velocity(), other.velocity());
            const Energies e = engine.energies(), f = other.energies();
            EXPECT_EQ(e.balance(), f.balance());
            EXPECT_EQ(e.dissipated, f.dissipated);
            EXPECT_EQ(e.damped, f.damped);
            EXPECT_EQ(engine.unbalanced_force(), other.unbalanced_force());
            for (const std::uint32_t k : {0u, 3u}) {
              const auto of_one = engine.element_state(k), of_other = other.element_state(k);
              EXPECT_TRUE(std::ranges::equal(of_one.stress.c, of_other.stress.c));
              EXPECT_EQ(of_one.history, of_other.history);
            }
            if (law.index() >= 3) { // or the history has not been looked at
              EXPECT_GT(e.dissipated, 0.0);
            }
            ++runs;
          }
  EXPECT_GT(runs, dim == 2 ? 60 : 20);
}

} // namespace
} // namespace kerf::fem
