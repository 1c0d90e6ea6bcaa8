// The row sum against the true limit 2 / omega_max, from the eigenvalues of the assembled system.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::LatticeType;

constexpr double ratios[] = {0.0, 0.2, 0.82, 1.0}; // k_t / k_n

/// Time step from the row sum over the true limit, Rojek (2008) eq. 10.
template <int dim> double share_of_limit(const dem::Engine<dim>& engine) {
  return std::sqrt(cases::largest_eigenvalue(engine) / engine.step_limit().omega2);
}

/// Never above the limit. Tolerance: the matrix comes from central differences of forces with
/// moves of 1e-6, whose error of third order is 1e-12 and whose rounding is 1e-10.
template <int dim> void never_above(const dem::Engine<dim>& engine, const std::string& what) {
  const double share = share_of_limit(engine);
  std::printf("%-32s %.3f\n", what.c_str(), share);
  verify({"excess of the automatic step over the critical one", "dense eigenvalues of M^-1 K", 1e-9,
          "rounding of the differences that make K"},
         std::max(0.0, share - 1.0));
  EXPECT_GT(share, 0.6) << what << ": safe, but useless";
}

TEST(CriticalStep, of_a_pair_is_never_overestimated_in_any_direction) {
  for (const double ratio : ratios)
    for (int k = 0; k < 12; ++k) {
      const double angle = k * std::numbers::pi / 12.0;
      never_above(
          dem::Engine<2>(cases::pair_model<2>({std::cos(angle), std::sin(angle)}, rock(2, ratio))),
          "pair 2D, angle " + std::to_string(k) + " pi/12");
      never_above(dem::Engine<3>(cases::pair_model<3>({std::cos(angle), std::sin(angle), 0.3 * k},
                                                      rock(3, ratio))),
                  "pair 3D, direction " + std::to_string(k));
    }
}

// Reference: for k_t / k_n = 0.82 the limit of a pair of discs is 6 k_t / m (sliding), its row sum
// 8 k_t / m: sqrt(6 / 8) = 0.866 of the limit. Spheres: 7 k_t / m and 10 k_t / m, 0.837.
TEST(CriticalStep, of_a_pair_of_discs_along_an_axis_is_at_least_85_percent_of_the_limit) {
  const dem::Engine<2> engine(cases::pair_model<2>({1.0, 0.0}, rock(2, 0.82)));
  verify({"automatic over critical step of a pair of discs", "sqrt(6 / 8)", 1e-6,
          "rounding of the differences that make K"},
         share_of_limit(engine) - std::sqrt(0.75));
}

// The estimate from the normal frequency of pairs, sqrt(2 k_n / m), is the one after eq. 10; in a
// long chain the true limit is sqrt(4 k_n / m): it would be 1.41 times too large.
TEST(CriticalStep, of_a_chain_is_exact_without_shear) {
  const dem::Engine<2> engine(cases::lattice_model<2>(LatticeType::chain, {60, 1}, rock(2, 0.0)));
  // The largest frequency of a free chain of n is sqrt(4 k / m) cos(pi / (2 n)).
  verify({"automatic over critical step of a chain of 60", "cos(pi / 120)", 1e-6,
          "rounding of the differences that make K"},
         share_of_limit(engine) - std::cos(std::numbers::pi / 120.0));
}

/// Ratio of the largest to the first stretch of a pair along its normal.
double growth(dem::DampingKind kind, double alpha, double share_of_limit) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2, 0.0));
  settings.damping = {kind, alpha, alpha};
  dem::InitialCondition<2> condition;
  condition.box = Box<2>{settings.positions[1], settings.positions[1]};
  condition.velocity = {1e-6, 0.0};
  settings.initial = {condition};
  dem::Engine<2> engine(settings);
  engine.start(share_of_limit * 2.0 / std::sqrt(engine.step_limit().omega2));
  const auto stretch = [&] {
    const auto& u = engine.particles().displacement;
    return std::abs(u[1][0] - u[0][0]);
  };
  engine.integrate();
  const double first = stretch();
  double largest = first;
  for (int n = 0; n < 100; ++n) {
    engine.integrate();
    largest = std::max(largest, stretch());
  }
  return largest / first;
}

// Of x'' = -omega² x with the force of eq. 18 the fastest mode, x_(n+1) = -x_n, has the stiffness
// (1 + alpha) omega²: a pair along its normal, whose row sum is exact, is stable just below the
// step and not above it. Above by 1 % it grows by 1.3 in a step.
TEST(CriticalStep, counts_non_viscous_damping) {
  for (const auto kind : {dem::DampingKind::nonviscous, dem::DampingKind::componentwise})
    for (const double alpha : {0.0, 0.2, 0.7}) {
      EXPECT_LT(growth(kind, alpha, 0.99), 10.0) << alpha;
      EXPECT_GT(growth(kind, alpha, 1.01), 1e3) << alpha;
    }
}

TEST(CriticalStep, of_lattices_is_never_overestimated) {
  for (const double ratio : ratios) {
    never_above(
        dem::Engine<2>(cases::lattice_model<2>(LatticeType::chain, {20, 1}, rock(2, ratio))),
        "chain 2D");
    never_above(
        dem::Engine<3>(cases::lattice_model<3>(LatticeType::chain, {12, 1, 1}, rock(3, ratio))),
        "chain 3D");
    never_above(
        dem::Engine<2>(cases::lattice_model<2>(LatticeType::triangular, {9, 9}, rock(2, ratio))),
        "triangular lattice");
    never_above(
        dem::Engine<2>(cases::lattice_model<2>(LatticeType::square, {8, 8}, rock(2, ratio))),
        "square lattice");
    never_above(
        dem::Engine<3>(cases::lattice_model<3>(LatticeType::fcc, {3, 3, 2}, rock(3, ratio))),
        "FCC");
    never_above(
        dem::Engine<3>(cases::lattice_model<3>(LatticeType::cubic, {4, 4, 3}, rock(3, ratio))),
        "cubic lattice");
  }
}

TEST(CriticalStep, of_irregular_packings_is_never_overestimated) {
  for (const double ratio : ratios)
    for (const unsigned seed : {1u, 2u}) {
      never_above(dem::Engine<2>(cases::irregular_model<2>(8, rock(2, ratio), seed)),
                  "irregular 2D, seed " + std::to_string(seed));
      never_above(dem::Engine<3>(cases::irregular_model<3>(4, rock(3, ratio), seed)),
                  "irregular 3D, seed " + std::to_string(seed));
    }
}

// Blended as in an overlap: weights fall from 1 to 0.05, masses at centres, contacts between.
TEST(CriticalStep, of_a_blended_packing_is_never_overestimated) {
  for (const double ratio : ratios) {
    const auto settings = cases::irregular_model<2>(8, rock(2, ratio), 3);
    dem::Engine<2> engine(settings);
    std::vector<double> weight;
    for (const Vec<2>& x : settings.positions)
      weight.push_back(std::clamp(1.0 - x[0] / (6.0 * cases::spacing), 0.05, 1.0));
    engine.set_weights(weight);
    never_above(engine, "blended irregular 2D");
  }
}

TEST(CriticalStep, of_bonds_that_bend_and_twist_is_never_overestimated) {
  for (const double ratio : {0.2, 1.0}) {
    auto disc = rock(2, ratio), sphere = rock(3, ratio);
    disc.bond_radius_ratio = sphere.bond_radius_ratio = 1.0;
    never_above(dem::Engine<2>(cases::pair_model<2>({1.0, 1.0}, disc)), "bending pair 2D");
    never_above(dem::Engine<3>(cases::pair_model<3>({1.0, 0.4, 0.3}, sphere)), "bending pair 3D");
    never_above(dem::Engine<2>(cases::irregular_model<2>(8, disc, 1)), "bending irregular 2D");
    never_above(dem::Engine<3>(cases::irregular_model<3>(4, sphere, 1)), "bending irregular 3D");
  }
}

// Closed form: x'' + 2 xi omega x' + omega² x = 0 with the velocity of half a step before is stable
// up to dt = 2 / omega (sqrt(1 + xi²) - xi). A pair in line has omega² = 2 k_n / m and xi = beta.
TEST(CriticalStep, of_a_pair_with_dashpots_is_that_of_a_velocity_half_a_step_old) {
  auto material = rock(2, 0.0);
  material.restitution = 0.2;
  for (const double factor : {0.99, 1.01}) {
    auto settings = cases::pair_model<2>({1.0, 0.0}, material);
    dem::InitialCondition<2> push;
    push.box = Box<2>{settings.positions[1], settings.positions[1]};
    push.velocity = {1e-6, 0.0};
    settings.initial = {push};
    dem::Engine<2> engine(settings);
    const double m = engine.particles().mass[0];
    const double omega = std::sqrt(2.0 * material.normal_stiffness / m);
    const double log = std::log(material.restitution);
    const double beta = -log / std::sqrt(std::numbers::pi * std::numbers::pi + log * log);
    const double critical = 2.0 / omega * (std::sqrt(1.0 + beta * beta) - beta);
    verify({"critical step of a pair with dashpots", "2 / omega (sqrt(1 + xi²) - xi)", 1e-9,
            "rounding"},
           2.0 / std::sqrt(engine.step_limit().omega2) / critical - 1.0);
    engine.start(factor * critical);
    for (int n = 0; n < 2000; ++n)
      cases::step(engine);
    const auto& v = engine.particles().velocity;
    const double apart = std::abs(v[1][0] - v[0][0]);
    if (factor < 1.0)
      EXPECT_LT(apart, 1e-9);
    else
      EXPECT_FALSE(apart < 1e-3);
  }
}

/// Loose grains of a lattice, as far apart as its spacing is stretched.
template <int dim> dem::Settings<dim> grains(double stretch, double tangential_ratio) {
  std::array<int, dim> count;
  count.fill(dim == 2 ? 6 : 3);
  auto settings = cases::lattice_model<dim>(dim == 2 ? LatticeType::triangular : LatticeType::fcc,
                                            count, rock(dim, tangential_ratio));
  for (Vec<dim>& x : settings.positions)
    x *= stretch;
  settings.bonds = false;
  return settings;
}

// Grains that do not touch have no limit of their own; the one to come is that of the densest
// lattice. Reference: row sums of that lattice pressed together by 1e-9 of the spacing.
template <int dim> void expect_the_limit_of_the_densest_lattice() {
  for (const double ratio : ratios) {
    const dem::Engine<dim> apart(grains<dim>(1.2, ratio)), pressed(grains<dim>(1.0 - 1e-9, ratio));
    EXPECT_EQ(apart.step_limit().omega2, 0.0);
    const dem::StepLimit to_come = apart.step_limit_to_come();
    EXPECT_EQ(to_come.limited_by.substr(0, 28), "contacts to come of particle");
    verify({"limit of grains to come over that of the lattice they can make",
            "row sums of the triangular and the fcc lattice", 1e-6, "the overlap of 1e-9"},
           std::sqrt(pressed.step_limit().omega2 / to_come.omega2) - 1.0);
    EXPECT_LT(cases::largest_eigenvalue(pressed), to_come.omega2);
  }
}
TEST(CriticalStep, of_grains_to_come_is_that_of_the_densest_lattice_2d) {
  expect_the_limit_of_the_densest_lattice<2>();
}
TEST(CriticalStep, of_grains_to_come_is_that_of_the_densest_lattice_3d) {
  expect_the_limit_of_the_densest_lattice<3>();
}

// Grains that fly at one another with the step that was chosen before they touched: energy is
// conserved but for what closing contacts miss, which falls as dt².
template <int dim> void expect_grains_to_collide_stably(dem::NormalLaw law) {
  auto settings = grains<dim>(1.05, 0.2);
  settings.material.law = law;
  settings.material.young_modulus = 1e10;
  settings.material.poisson_ratio = 0.2;
  cases::shake(settings, 5.0, 8);
  settings.period.length = Vec<dim>::Zero();
  Vec<dim> upper = Vec<dim>::Zero();
  for (const Vec<dim>& x : settings.positions)
    upper = upper.cwiseMax(x);
  settings.period.length = upper + Vec<dim>::Constant(1.1 * spacing);
  dem::Engine<dim> engine(settings);
  engine.start(0.8 * 2.0 / std::sqrt(engine.step_limit_to_come().omega2));
  double first = 0.0, worst = 0.0, most_elastic = 0.0;
  for (int n = 0; n < 4000; ++n) {
    cases::step(engine);
    const dem::Energies e = engine.energies();
    first = n == 0 ? e.kinetic : first;
    worst = std::max(worst, (e.kinetic + e.elastic + e.friction_dissipation) / first - 1.0);
    most_elastic = std::max(most_elastic, e.elastic);
  }
  EXPECT_GT(most_elastic, 0.05 * first); // they did collide
  EXPECT_LT(worst, 0.1);                 // an unstable step makes it grow without end
}
TEST(CriticalStep, of_grains_to_come_is_stable_when_they_collide) {
  expect_grains_to_collide_stably<2>(dem::NormalLaw::linear);
  expect_grains_to_collide_stably<3>(dem::NormalLaw::linear);
  expect_grains_to_collide_stably<3>(dem::NormalLaw::hertz_mindlin);
}

// Mass scaling makes heavier what would be too light when it touches; a number of grains that
// cannot have so many neighbours counts fewer, and one alone none.
TEST(CriticalStep, of_grains_to_come_is_what_mass_scaling_raises) {
  auto settings = grains<2>(1.2, 0.5);
  settings.clusters.emplace_back().ids = {0, 1};
  const double before = 2.0 / std::sqrt(dem::Engine<2>(settings).step_limit_to_come().omega2);
  settings.mass_scaling = dem::MassScaling{.critical_step = 3.0 * before};
  const dem::Engine<2> scaled(settings);
  EXPECT_NEAR(2.0 / std::sqrt(scaled.step_limit_to_come().omega2), 3.0 * before, 1e-9 * before);
  EXPECT_NEAR(scaled.added_mass().largest_factor, 9.0, 1e-6);

  dem::Settings<2> few;
  few.positions = {{0.0, 0.0}, {2.0 * spacing, 0.0}};
  few.radii = {0.5 * spacing, 0.5 * spacing};
  few.material = rock(2, 0.5);
  const double two = dem::Engine<2>(few).step_limit_to_come().omega2;
  EXPECT_GT(two, 0.0);
  EXPECT_LT(two, 0.2 * dem::Engine<2>(grains<2>(1.2, 0.5)).step_limit_to_come().omega2);
  few.positions.pop_back();
  few.radii.pop_back();
  EXPECT_EQ(dem::Engine<2>(few).step_limit_to_come().omega2, 0.0);
}

// A prescribed component has no row; what is left is a principal part of the whole matrix, whose
// eigenvalues lie within those of the whole.
TEST(CriticalStep, leaves_out_what_is_prescribed) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2, 0.0));
  settings.positions.push_back({3.0 * cases::spacing, 0.0}); // alone
  settings.radii.push_back(0.5 * cases::spacing);
  settings.boundary = {cases::prescribe_at<2>(settings.positions[0], dem::Motion::fixed),
                       cases::prescribe_at<2>(settings.positions[1], dem::Motion::fixed)};
  const dem::Engine<2> engine(settings);
  EXPECT_EQ(engine.step_limit().omega2, 0.0);
}

// Reference: dense eigenvalues. 0.99 of 2 / omega_max keeps a free lattice bounded, 1.01 does not.
// Tolerance: at 0.99 the highest mode swells by 1 / sqrt(1 - 0.99²) = 7 at most; at 1.01 it grows
// by 1.33 a step from rounding or from its share of the start, 1e3 within 100 steps.
TEST(CriticalStep, from_the_eigenvalues_separates_stable_from_unstable) {
  for (const double factor : {0.99, 1.01}) {
    auto settings = cases::lattice_model<2>(LatticeType::triangular, {6, 6}, rock(2, 0.82));
    cases::shake(settings, 1e-6, 4);
    dem::Engine<2> engine(settings);
    engine.start(factor * 2.0 / std::sqrt(cases::largest_eigenvalue(engine)));
    cases::step(engine);
    const double start = engine.energies().kinetic;
    for (int n = 0; n < (factor < 1.0 ? 5000 : 100); ++n)
      cases::step(engine);
    const double end = engine.energies().elastic / start;
    if (factor < 1.0)
      EXPECT_LT(end, 50.0);
    else
      EXPECT_FALSE(end < 1e6); // it may be lost altogether
  }
}

} // namespace
} // namespace kerf
