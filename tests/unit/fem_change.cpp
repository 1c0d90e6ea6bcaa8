// In-situ stress, excavation and other changes between two steps; bodies that must not lock.
#include "tests/cases/fem_bodies.hpp"

#include "fem_core/input_error.hpp"

#include <gtest/gtest.h>

namespace kerf::fem {
namespace {

using cases::held;
using cases::rock;

double safe_step(const auto& engine) {
  return 0.8 * 2.0 / std::sqrt(engine.step_limit().omega2);
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values)
    most = std::max(most, std::abs(value));
  return most;
}

template <int dim> std::array<bool, dim> only(int axis) {
  std::array<bool, dim> components{};
  components[static_cast<std::size_t>(axis)] = true;
  return components;
}

/// Ground of 3 x 4 (x 5) mm under its weight; the top is free.
template <int dim> Settings<dim> ground(Formulation formulation, bool absorbing) {
  Settings<dim> settings{.materials = cases::of<dim>(rock, formulation)};
  settings.gravity = -1e5 * Vec<dim>::Unit(1);
  settings.local_damping = 0.2; // of what is out of balance, which the supports are part of
  settings.in_situ_stress =
      InSituStress<dim>{.K0 = 0.6, .surface = dim == 2 ? 5e-3 : 4e-3, .overburden = 0.0};
  if (absorbing) {
    settings.absorbing = {{.tag = "left"}, {.tag = "right"}, {.tag = "bottom"}};
  } else {
    settings.boundary = {held<dim>("left", only<dim>(0)), held<dim>("right", only<dim>(0)),
                         held<dim>("bottom", only<dim>(1))};
  }
  if (dim == 3)
    for (const char* tag : {"back", "front"})
      settings.boundary.push_back(held<dim>(tag, only<dim>(dim - 1)));
  return settings;
}

template <class Dim> struct FemInSituStress : testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FemInSituStress, Dimensions);

// div sigma + rho g = 0 with a stress that is linear in depth, which the points integrate exactly
// on elements with straight sides: nothing moves but by rounding, which is compared with what the
// weight would do: g t².
TYPED_TEST(FemInSituStress, that_grows_with_depth_is_in_equilibrium_with_the_weight) {
  constexpr int dim = TypeParam::value;
  for (const Shape shape :
       {dim == 2 ? Shape::tri3 : Shape::tet4, dim == 2 ? Shape::quad4 : Shape::hex8})
    for (const Formulation formulation :
         {Formulation::full, Formulation::mean_dilatation, Formulation::nodal_pressure})
      for (const bool absorbing : {false, true}) {
        try {
          check(Material{.law = rock, .formulation = formulation}, shape, Plane::strain);
        } catch (const InputError&) {
          continue;
        }
        BoxMesh<dim> box{.size = Vec<dim>::LinSpaced(dim, 3.0, 5.0) * 1e-3, .shape = shape};
        box.count.fill(3);
        Engine<dim> engine(make_box(box), ground<dim>(formulation, absorbing));
        const double dt = safe_step(engine);
        engine.start(dt);
        for (int n = 0; n < 100; ++n)
          engine.integrate();
        EXPECT_LE(largest(engine.velocity()), 1e-11 * 1e5 * 100 * dt)
            << name_of(shape) << " " << absorbing;
        const auto stress = engine.element_state(0).stress;
        EXPECT_NEAR(stress[0], 0.6 * stress[1], 1e-9 * std::abs(stress[1]));
        EXPECT_LT(stress[1], 0.0);
      }
}

// Taking the sides away lets the body expand by what the stress was: uniaxial release of sigma_xx
// in plane strain, eps = -sigma_xx (1 - nu²) / E, once damping has brought it to rest. 1e-3: what
// is left of the oscillation.
TEST(FemChange, of_a_boundary_releases_the_stress_that_it_held) {
  Settings<2> settings{.materials = cases::of<2>(rock)};
  settings.in_situ_stress = InSituStress<2>{.stress = {-1e6, 0.0, -0.25e6, 0.0}};
  settings.boundary = {held<2>("left", {true, false}), held<2>("right", {true, false}),
                       held<2>("bottom", {false, true})};
  Engine<2> engine(make_box(BoxMesh<2>{.size = {4e-3, 4e-3}, .count = {4, 4}}), settings);
  engine.start(safe_step(engine));
  for (int n = 0; n < 50; ++n)
    engine.integrate();
  EXPECT_LE(largest(engine.displacement()), 1e-18);
  Change<2> change;
  change.boundary = {held<2>("left", {true, false}), held<2>("bottom", {false, true})};
  change.mass_damping = 6e5;
  engine.change(change);
  for (int n = 0; n < 2000; ++n)
    engine.integrate();
  const double exact = 1e6 * (1.0 - 0.25 * 0.25) / 10e9 * 4e-3;
  EXPECT_NEAR(engine.displacement()[2 * 4], exact, 1e-3 * exact);
}

// What is left of a body behaves as one that never had the rest: the same numbers up to the order
// of sums. The elements that go carry stress of their own by then, in the second half of the run.
TEST(FemChange, that_removes_elements_leaves_the_body_that_is_left) {
  const BoxMesh<2> box{.size = {8e-3, 4e-3}, .count = {8, 4}};
  const auto settings = [](const Law& law, bool finite) {
    Settings<2> s{.materials = cases::of<2>(law, Formulation::full, finite)};
    s.boundary = {held<2>("left", {true, true})};
    s.initial = {{.box = {}, .velocity = InitialVelocity<2>{{0.0, 3.0}}, .pulse = {}}};
    return s;
  };
  const auto metal = J2Plastic::from(rock, Hardening::linear(1e6, 1e9));
  for (const auto& [law, finite] : {std::pair(Law(rock), false), std::pair(Law(metal), true)}) {
    Mesh<2> whole = make_box(box);
    for (std::uint32_t e = 0; e < 32; ++e)
      if (e % 8 >= 4)
        whole.regions["excavation"].push_back(e);
    Mesh<2> half = make_box(BoxMesh<2>{.size = {4e-3, 4e-3}, .count = {4, 4}});
    Engine<2> of_whole(whole, settings(law, finite)), of_half(half, settings(law, finite));
    const double dt = 0.9 * safe_step(of_half);
    of_whole.start(dt);
    of_half.start(dt);
    Change<2> change;
    change.remove = {"excavation"};
    of_whole.change(change);
    for (int n = 0; n < 100; ++n) {
      of_whole.integrate();
      of_half.integrate();
    }
    const auto u = of_whole.displacement(), v = of_half.displacement();
    for (std::size_t j = 0; j <= 4; ++j)
      for (std::size_t i = 0; i <= 4; ++i)
        EXPECT_NEAR(u[2 * (j * 9 + i)], v[2 * (j * 5 + i)], 1e-12 * largest(v));
    EXPECT_EQ(of_whole.active_elements().size(), 16u);
    of_whole.change({.reset_displacement = true});
    EXPECT_EQ(largest(of_whole.displacement_since_reset()), 0.0);
    EXPECT_GT(largest(of_whole.displacement()), 0.0);
  }
}

// A change that changes nothing keeps every bit: stress, history and motion move to their new
// places.
TEST(FemChange, that_lists_the_same_again_changes_no_bit) {
  Settings<2> settings{.materials = cases::of<2>(J2Plastic::from(rock, Hardening::linear(1e6, 1e9)),
                                                 Formulation::one_point, true)};
  settings.boundary = {held<2>("left", {true, true})};
  settings.initial = {{.box = {}, .velocity = InitialVelocity<2>{{0.0, 5.0}}, .pulse = {}}};
  Engine<2> engine(cases::distorted_box<2>(), settings), other(cases::distorted_box<2>(), settings);
  const double dt = safe_step(engine);
  engine.start(dt);
  other.start(dt);
  for (int n = 0; n < 100; ++n) {
    if (n == 50) {
      Change<2> change;
      change.boundary = settings.boundary;
      other.change(change);
    }
    engine.integrate();
    other.integrate();
  }
  EXPECT_EQ(engine.displacement(), other.displacement());
  EXPECT_GT(engine.energies().dissipated, 0.0);
  EXPECT_EQ(engine.energies().dissipated, other.energies().dissipated);
}

TEST(FemChange, refuses_what_is_unknown_and_changes_nothing_then) {
  Settings<2> settings{.materials = cases::of<2>(rock)};
  Engine<2> engine(cases::distorted_box<2>(), settings);
  Change<2> change;
  change.remove = {"hole"};
  EXPECT_THROW(engine.change(change), InputError);
  EXPECT_EQ(engine.active_elements().size(), engine.mesh().num_elements());
}

// A nearly incompressible cantilever (nu = 0.499, plane strain) bends under its weight:
// full integration of simplices locks to a small part of the deflection of the beam, averaged
// pressures and B-bar do not. Deflection of a beam under its weight q: q L^4 / (8 E' I), E' = E /
// (1 - nu²).
TEST(FemIncompressible, beams_bend_with_averaged_pressure_and_lock_without) {
  const auto rubber = IsotropicElastic::from_young(1000.0, 1e6, 0.499);
  const auto deflection = [&](Shape shape, Formulation formulation) {
    Settings<2> settings{.materials = cases::of<2>(rubber, formulation)};
    settings.boundary = {held<2>("left", {true, true})};
    settings.gravity = {0.0, -0.01};
    Engine<2> engine(make_box(BoxMesh<2>{.size = {0.6, 0.1}, .count = {18, 4}, .shape = shape}),
                     settings);
    const double dt = safe_step(engine);
    const double omega = 3.516 * std::sqrt(1e6 / 0.75 * 0.1 * 0.1 / 12.0 / 1000.0) / 0.36;
    Change<2> change;
    change.mass_damping = 2.0 * omega; // critical of the first mode
    engine.start(dt);
    engine.change(change);
    while (static_cast<double>(engine.step()) * dt < 7.0 / omega)
      engine.integrate();
    return -engine.displacement()[2 * (2 * 19 + 18) + 1];
  };
  const double beam = 1000.0 * 0.01 * 0.1 * std::pow(0.6, 4) / (8.0 * 1e6 / 0.75 * 0.001 / 12.0);
  const double bricks = deflection(Shape::quad4, Formulation::mean_dilatation) / beam;
  const double averaged = deflection(Shape::tri3, Formulation::nodal_pressure) / beam;
  const double full = deflection(Shape::quad4, Formulation::full) / beam;
  const double simplices = deflection(Shape::tri3, Formulation::full) / beam;
  std::printf("  deflection over that of the beam: B-bar %.3f, averaged %.3f, full quad4 %.3f, "
              "tri3 %.3f\n",
              bricks, averaged, full, simplices);
  EXPECT_NEAR(bricks, 1.0, 0.06); // shear adds 3 % to a beam of this length
  EXPECT_GT(averaged, 0.7);       // tri3 is stiff in bending, locked or not
  EXPECT_LT(full, 0.4);
  EXPECT_LT(simplices, 0.4);
}

} // namespace
} // namespace kerf::fem
