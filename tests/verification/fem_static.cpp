// Static states: kinetic damping, how far a body is from equilibrium, and mass scaling.
#include "fem_core/relax.hpp"

#include "fem_core/input_error.hpp"
#include "tests/cases/fem_loads.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

namespace kerf::fem {
namespace {

using cases::rock;

/// A bar of nu = 0 along x, held at the left, of 1 mm by 1 mm elements.
Mesh<2> bar(std::uint32_t count) {
  return make_box(BoxMesh<2>{.size = {count * 1e-3, 2e-3}, .count = {count, 2}});
}
const IsotropicElastic straight = IsotropicElastic::from_young(2500.0, 10e9, 0.0);

// sigma L / E and rho g L² / 2E. Resultants of 1e-8 of the loads leave that error at the end; it is
// up to 10 times larger in the middle of the lowest mode. A bar of n elements has the period
// 4 L / c, about 6 n steps: forty of those must do.
TEST(FemRelaxation, brings_a_bar_to_the_displacement_of_its_loads_and_weight) {
  const std::uint32_t count = 40;
  Settings<2> settings{.materials = cases::of<2>(straight)};
  settings.boundary = {cases::held<2>("left", {true, true})};
  settings.loads = {
      {.tag = "right", .kind = LoadKind::traction, .value = {TimeTable(1e6), TimeTable()}}};
  settings.gravity = {3e4, 0.0};
  Engine<2> engine(bar(count), settings);
  engine.start(0.9 * cases::critical_step(engine));
  engine.integrate();
  const double start = engine.energies().balance();
  const Relaxation result = relax(engine, 1e-8);
  const double L = count * 1e-3, exact = 1e6 * L / 10e9 + 2500.0 * 3e4 * L * L / 2.0 / 10e9;
  const double error = engine.displacement()[2 * count] / exact - 1.0;
  std::printf("  %d steps, unbalanced %.1e, error %.1e\n", static_cast<int>(result.steps),
              result.unbalanced_force, error);
  verify({"end of a bar under traction and weight, relaxed", "sigma L / E + rho g L² / 2E", 1e-7,
          "ten times the unbalanced force of 1e-8"},
         error);
  EXPECT_LE(result.unbalanced_force, 1e-8);
  EXPECT_LE(result.steps, 40u * 6u * count);
  const Energies e = engine.energies(); // kinetic damping is booked: the balance of a linear body
  EXPECT_LE(std::abs(e.balance() - start), 1e-12 * e.external_work);
  EXPECT_GT(e.damped, 0.1 * e.external_work);
}

// w = P L³ / 3EI + P L / kGA: S. P. Timoshenko, Phil. Mag. 41 (1921) 744; B-bar is too soft or
// stiff by less than a percent with 8 elements over the height. The same without inertia of its
// own: the state does not depend on the mass.
TEST(FemRelaxation, brings_a_cantilever_to_its_deflection_with_scaled_mass_too) {
  double deflection[2];
  for (const bool scaled : {false, true}) {
    Settings<2> settings{.materials = cases::of<2>(straight), .plane = Plane::stress};
    settings.boundary = {cases::held<2>("left", {true, true})};
    settings.loads = {
        {.tag = "right", .kind = LoadKind::force, .value = {TimeTable(), TimeTable(1.0)}}};
    if (scaled)
      settings.mass_scaling = MassScaling{.factor = 7.0};
    Engine<2> engine(make_box(BoxMesh<2>{.size = {40e-3, 4e-3}, .count = {80, 8}}), settings);
    engine.start(0.9 * cases::critical_step(engine));
    const Relaxation result = relax(engine, 1e-6);
    std::printf("  %d steps, kinetic over elastic energy %.1e\n", static_cast<int>(result.steps),
                result.kinetic_ratio);
    EXPECT_LE(result.steps, 60'000u);
    deflection[scaled] = engine.displacement()[2 * (4 * 81 + 80) + 1];
  }
  const double EI = 10e9 * std::pow(4e-3, 3) / 12.0, kGA = 10.0 / 12.0 * 5e9 * 4e-3, L = 40e-3;
  verify({"deflection of a cantilever, relaxed, 80 x 8 quad4",
          "S.P. Timoshenko, Phil. Mag. 41 (1921) 744, doi:10.1080/14786442108636264", 0.01,
          "full integration is stiff in bending by 0.008"},
         deflection[0] / (L * L * L / (3.0 * EI) + L / kGA) - 1.0);
  verify({"deflection of a relaxed body with seven times its mass", "that of the same body", 1e-4,
          "unbalanced force of 1e-6 in the lowest mode of a slender body"},
         deflection[1] / deflection[0] - 1.0);
}

TEST(FemRelaxation, says_how_far_a_body_is_that_does_not_come_to_rest) {
  Settings<2> settings{.materials = cases::of<2>(rock), .gravity = {1.0, 0.0}}; // it falls for ever
  Engine<2> engine(bar(4), settings);
  engine.start(0.9 * cases::critical_step(engine));
  EXPECT_THROW(relax(engine, 1e-3, 100), std::runtime_error);
  EXPECT_THROW(relax(engine, 0.0), std::invalid_argument);
  Engine<2> at_rest(bar(4), {.materials = cases::of<2>(rock)});
  at_rest.start(1e-8);
  at_rest.integrate();
  EXPECT_EQ(at_rest.unbalanced_force(), 0.0);
}

// A restart in the middle goes on to the same bits: what the peak is compared with is state.
TEST(FemRelaxation, goes_on_to_the_same_bits_after_a_restart) {
  Settings<2> settings{.materials = cases::of<2>(rock), .kinetic_damping = true};
  settings.boundary = {cases::held<2>("left", {true, true})};
  settings.gravity = {0.0, -1e3};
  Engine<2> engine(bar(10), settings), other(bar(10), settings);
  const double dt = 0.9 * cases::critical_step(engine);
  engine.start(dt);
  other.start(dt);
  for (int n = 0; n < 400; ++n) {
    if (n == 137)
      other.restore(engine.state());
    engine.integrate();
    if (n >= 137)
      other.integrate();
  }
  EXPECT_EQ(engine.displacement(), other.displacement());
  EXPECT_EQ(engine.velocity(), other.velocity());
  EXPECT_GT(engine.energies().damped, 0.0);
}

// The stiffest mode of a rectangle h_x by h_y has omega² = 4 / (rho h_x h_y) times the largest
// eigenvalue of [[C11 h_y/h_x, C12], [C12, C11 h_x/h_y]]; with nu = 0 that is 4 c² / min(h_x,
// h_y)². So an element of length h < c dt gets (c dt / h)² - 1 times its mass.
TEST(FemMassScaling, adds_the_mass_that_short_elements_of_a_graded_bar_lack) {
  const BoxMesh<2> box{.size = {20e-3, 3e-3}, .count = {12, 1}, .grading = {8.0, 1.0}};
  Settings<2> settings{.materials = cases::of<2>(straight)};
  settings.gravity = {0.0, -10.0};
  Engine<2> plain(make_box(box), settings);
  const double c = 2000.0, wished = 1.2e-3 / c;
  settings.mass_scaling = MassScaling{.critical_step = wished};
  settings.initial = {{.box = {}, .velocity = InitialVelocity<2>{{0.0, 1.0}}, .pulse = {}}};
  Engine<2> engine(make_box(box), settings);
  double added = 0.0, most = 1.0;
  std::size_t elements = 0;
  std::vector<double> of_nodes = plain.mass();
  for (std::uint32_t e = 0; e < 12; ++e) {
    const auto corners = engine.mesh().corners(e);
    const double h = corners.row(0).maxCoeff() - corners.row(0).minCoeff();
    const double factor = std::max(1.0, std::pow(c * wished / h, 2)), m = 2500.0 * h * 3e-3;
    added += (factor - 1.0) * m;
    elements += factor > 1.0;
    most = std::max(most, factor);
    for (const std::uint32_t a : engine.mesh().nodes_of_element(e))
      of_nodes[a] += 0.25 * (factor - 1.0) * m;
  }
  ASSERT_GT(elements, 2u);
  ASSERT_LT(elements, 10u);
  const AddedMass mass = engine.added_mass();
  const std::string source = "element of length h: (c dt / h)² - 1 times its mass";
  verify({"mass that scaling adds to a graded bar", source, 1e-12, "rounding of eigenvalues"},
         mass.added / added - 1.0);
  EXPECT_EQ(mass.elements, elements);
  EXPECT_NEAR(mass.largest_factor, most, 1e-12 * most);
  EXPECT_NEAR(mass.before, 2500.0 * 20e-3 * 3e-3, 1e-15);
  const std::vector<double> masses = engine.mass();
  for (std::size_t a = 0; a < masses.size(); ++a) // elements that are long enough keep theirs
    EXPECT_NEAR(masses[a], of_nodes[a], 1e-12 * of_nodes[a]);
  EXPECT_NEAR(cases::critical_step(engine), wished, 1e-12 * wished);

  // Stable at the step that was wished; and it falls with its weight as if it had its own mass
  // under a force of m g: momentum in the whole is weight times time.
  const double momentum = std::accumulate(masses.begin(), masses.end(), 0.0) / 1.0;
  engine.start(0.99 * wished);
  engine.integrate();
  const double start = engine.momentum()[1];
  EXPECT_NEAR(start, momentum, 1e-9 * momentum);
  for (int n = 0; n < 2000; ++n)
    engine.integrate();
  const double weight = 10.0 * 2500.0 * 20e-3 * 3e-3, time = 2000 * 0.99 * wished;
  EXPECT_NEAR(engine.momentum()[1], start - weight * time, 1e-9 * momentum);
  EXPECT_LE(engine.energies().elastic, 1e-6 * engine.energies().kinetic);
  EXPECT_NEAR(engine.energies().balance(), 0.5 * momentum, 1e-9 * momentum);
}

TEST(FemMassScaling, refuses_what_cannot_be_meant) {
  const auto key = [](const MassScaling& scaling) -> std::string {
    try {
      Engine<2>(bar(4), {.materials = cases::of<2>(rock), .mass_scaling = scaling});
    } catch (const InputError& error) {
      return error.key();
    }
    return "nothing was thrown";
  };
  EXPECT_EQ(key({.factor = 0.5}), "mass_scaling.factor");
  EXPECT_EQ(key({.critical_step = -1.0}), "mass_scaling.critical_step");
  EXPECT_EQ(key({.critical_step = 1e-6, .factor = 2.0}), "mass_scaling");
  EXPECT_EQ(key({}), "mass_scaling");
  Engine<2> engine(bar(4),
                   {.materials = cases::of<2>(rock), .mass_scaling = MassScaling{.factor = 2.0}});
  EXPECT_THROW(engine.set_weights(std::vector<double>(engine.mesh().num_nodes(), 0.5)),
               std::invalid_argument);
}

} // namespace
} // namespace kerf::fem
