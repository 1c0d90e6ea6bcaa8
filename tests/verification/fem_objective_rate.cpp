// The rate of Kirchhoff's stress: what retraces its way comes back, and what is bent far rests.
#include "fem_core/relax.hpp"

#include "tests/cases/fem_loads.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

namespace kerf::fem {
namespace {

using cases::rock;

// The increment counts between two halves of the turn, and the stress belongs to the mass: each
// step can be taken back. So an element that is stretched, sheared and turned by half its length
// and returns on the same way has no stress in the end. With the whole turn before the increment,
// or an increment of Cauchy's stress scaled by the volume of one end of the step, it would keep a
// share of the size of a step. Rounding of 2000 steps.
TEST(FemObjectiveRate, leaves_no_stress_in_an_element_that_returns_on_its_way) {
  for (const Plane plane : {Plane::strain, Plane::stress})
    for (const Formulation formulation :
         {Formulation::full, Formulation::mean_dilatation, Formulation::one_point}) {
      try {
        check(Material{.law = rock, .formulation = formulation}, Shape::quad4, plane);
      } catch (const std::exception&) {
        continue;
      }
      const double dt = 1e-8;
      const int steps = 2000;
      Settings<2> settings{.materials = cases::of<2>(rock, formulation, true), .plane = plane};
      BoundarySetting<2> side = cases::held<2>("right", {true, true});
      side.motion = Motion::hann;
      side.amplitude = {0.3e-3, 0.5e-3};
      side.duration = steps * dt;
      settings.boundary = {cases::held<2>("left", {true, true}), side};
      Engine<2> engine(make_box(BoxMesh<2>{.size = {1e-3, 1e-3}, .count = {1, 1}}), settings);
      engine.start(dt);
      double most = 0.0, left = 0.0;
      for (int n = 0; n <= steps; ++n) {
        engine.integrate();
        const auto stress = engine.element_state(0).stress;
        left = 0.0;
        for (int k = 0; k < stress.size; ++k)
          left = std::max(left, std::abs(stress[k]));
        most = std::max(most, left);
      }
      EXPECT_GT(most, 1e9);
      verify({"stress that a closed way leaves in a quad4 with an objective rate, over the largest",
              "an elastic body that retraces its way", 1e-11, "rounding of 2000 steps"},
             left / most);
    }
}

/// Largest error of the energy balance of a vibration of 5 % strain, over the energy.
double imbalance(Formulation formulation, double share_of_step) {
  Settings<2> settings{.materials = cases::of<2>(rock, formulation, true)};
  settings.boundary = {cases::held<2>("left", {true, true})};
  settings.initial = {{.box = {}, .velocity = InitialVelocity<2>{{40.0, 120.0}}, .pulse = {}}};
  Engine<2> engine(cases::distorted_box<2>(), settings);
  const double dt = share_of_step * cases::critical_step(engine);
  engine.start(dt);
  engine.integrate();
  const double start = engine.energies().balance();
  double error = 0.0;
  while (static_cast<double>(engine.step()) * dt < 4e-5) {
    engine.integrate();
    error = std::max(error, std::abs(engine.energies().balance() - start));
  }
  return error / start;
}

// The trapezoidal rule of the work: a quarter of the step, a sixteenth of the error.
TEST(FemObjectiveRate, balances_the_energy_to_second_order_in_the_step) {
  for (const Formulation formulation : {Formulation::full, Formulation::one_point}) {
    const double coarse = imbalance(formulation, 0.2), fine = imbalance(formulation, 0.05);
    const double order = 0.5 * std::log2(coarse / fine);
    std::printf("  imbalance %.2e, %.2e of a quarter of the step: order %.2f\n", coarse, fine,
                order);
    verify({"order of the energy balance with an objective rate", "2: trapezoidal rule", 0.2,
            "two steps of a motion with many frequencies"},
           order - 2.0);
  }
}

// Bent by P L² / EI = 10 to more than 80 degrees and brought to rest, a cantilever stays so without
// any damping: its stiffness is symmetric and positive. That of the Jaumann rate of Cauchy's stress
// is not symmetric, and a body can draw energy from it. What moves afterwards is what
// relaxing to 1e-8 has left, and it does not grow.
TEST(FemObjectiveRate, lets_a_cantilever_rest_that_is_bent_far) {
  const double E = 1000.0, L = 16.0, EI = E / 12.0;
  Settings<2> settings{
      .materials = cases::of<2>(IsotropicElastic::from_young(1.0, E, 0.3), Formulation::full, true),
      .plane = Plane::stress};
  settings.boundary = {cases::held<2>("left", {true, true})};
  settings.loads = {{.tag = "right",
                     .kind = LoadKind::force,
                     .value = {TimeTable(), TimeTable(10.0 * EI / (L * L))}}};
  Engine<2> engine(make_box(BoxMesh<2>{.origin = {0.0, -0.5}, .size = {L, 1.0}, .count = {64, 4}}),
                   settings);
  engine.start(0.5 * cases::critical_step(engine));
  const Relaxation result = relax(engine, 1e-8);
  const Vec<2> tip(&engine.displacement()[2 * (2 * 65 + 64)]);
  const Vec<2> exact = L * Vec<2>(-0.55500, 0.81061);
  const double elastic = engine.energies().elastic;
  double kinetic[2] = {};
  for (int n = 0; n < 20'000; ++n) {
    engine.integrate();
    double& most = kinetic[n / 10'000];
    if (n % 100 == 0)
      most = std::max(most, engine.energies().kinetic);
  }
  std::printf("  %d steps; then kinetic energy up to %.1e of the elastic; tip %.2e off\n",
              static_cast<int>(result.steps), kinetic[1] / elastic,
              (tip - exact).norm() / exact.norm());
  verify({"end of a cantilever that is bent far, nu = 0.3, relaxed",
          "elastica; K. Mattiasson, doi:10.1002/nme.1620170113", 0.02,
          "elements of a quarter of the height are stiff in bending by 0.016"},
         (tip - exact).norm() / exact.norm());
  verify({"kinetic energy of a body bent far, at rest, without damping, over the elastic",
          "stable equilibrium", 1e-10, "a hundredth of the share of 1e-8 that relaxing may leave"},
         kinetic[1] / elastic);
  EXPECT_LE(kinetic[1], 4.0 * kinetic[0]);
}

} // namespace
} // namespace kerf::fem
