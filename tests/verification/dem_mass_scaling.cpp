// Mass scaling: the step that is wished, and what it must not change.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;

template <int dim> double critical_step(const dem::Engine<dim>& engine) {
  return 2.0 / std::sqrt(engine.step_limit().omega2);
}

// Row sums of M^-1 K fall as the mass grows, so the bound meets the wish to round-off; with
// dashpots, too, whose share of critical damping falls with the frequency.
template <int dim> void expect_the_wished_step() {
  for (const double restitution : {1.0, 0.6}) {
    auto settings = cases::irregular_model<dim>(5, rock(dim, 0.6), 11);
    settings.material.restitution = restitution;
    settings.clusters.resize(1);
    settings.clusters[0].ids = {0, 1};
    const dem::Engine<dim> as_it_is(settings);
    const double before = critical_step(as_it_is), wished = 1.6 * before;
    settings.mass_scaling = dem::MassScaling{.critical_step = wished};
    dem::Engine<dim> scaled(settings);
    scaled.set_weights({});
    verify({"critical step of bodies, bonds and dashpots with scaled mass",
            "the step that is wished", 1e-12, "one factor for each particle, to round-off"},
           critical_step(scaled) / wished - 1.0);

    const auto &m = scaled.particles().mass, &true_m = as_it_is.particles().mass;
    std::size_t heavier = 0;
    double added = 0.0;
    for (std::size_t i = 0; i < m.size(); ++i) {
      EXPECT_GE(m[i], true_m[i]);
      EXPECT_EQ(scaled.particles().inertia[i] / as_it_is.particles().inertia[i] > 1.0,
                m[i] > true_m[i]);
      heavier += m[i] > true_m[i] ? 1 : 0;
      added += m[i] - true_m[i];
    }
    const dem::Cluster<dim>&body = scaled.clusters().all()[0], &was = as_it_is.clusters().all()[0];
    heavier += body.mass > was.mass ? 2 : 0;
    added += body.mass - was.mass;
    const dem::AddedMass report = scaled.added_mass();
    EXPECT_EQ(report.particles, heavier);
    EXPECT_NEAR(report.added, added, 1e-12 * report.before);
    EXPECT_NEAR(report.before, std::accumulate(true_m.begin(), true_m.end(), 0.0),
                1e-12 * report.before);
    EXPECT_GT(heavier, 0u);
    EXPECT_LT(heavier, m.size()); // some had room

    settings.mass_scaling->critical_step = 0.5 * before; // all have room
    const dem::Engine<dim> not_scaled(settings);
    EXPECT_EQ(critical_step(not_scaled), before);
    EXPECT_EQ(not_scaled.added_mass().added, 0.0);
  }
}
TEST(MassScaling, gives_the_critical_step_that_is_wished_2d) {
  expect_the_wished_step<2>();
}
TEST(MassScaling, gives_the_critical_step_that_is_wished_3d) {
  expect_the_wished_step<3>();
}

TEST(MassScaling, by_a_factor_lengthens_the_step_by_its_root) {
  auto settings = cases::irregular_model<2>(5, rock(2), 11);
  const double before = critical_step(dem::Engine<2>(settings));
  settings.mass_scaling = dem::MassScaling{.factor = 100.0};
  dem::Engine<2> engine(settings);
  verify({"critical step with 100 times the mass", "10 times that without", 1e-12, "round-off"},
         critical_step(engine) / (10.0 * before) - 1.0);
  EXPECT_NEAR(engine.added_mass().added, 99.0 * engine.added_mass().before,
              1e-12 * engine.added_mass().added);
  EXPECT_THROW(engine.set_weights(std::vector<double>(engine.size(), 0.5)), std::invalid_argument);
}

/// Displacements of a packing that has come to rest on its held lower edge.
template <int dim> std::vector<dem::Aligned<Vec<dim>>> sagged(double factor) {
  auto settings = cases::irregular_model<dim>(4, rock(dim, 0.6), 2);
  settings.gravity[1] = -9.81;
  settings.damping = {.kind = dem::DampingKind::componentwise, .translation = 0.7, .rotation = 0.7};
  settings.boundary.resize(1);
  settings.boundary[0].box = {Vec<dim>::Constant(-1.0), Vec<dim>::Constant(1.0)};
  settings.boundary[0].box.upper[1] = 0.3 * spacing;
  settings.boundary[0].components = (1u << (dim + 1)) - 1u;
  if (factor > 1.0)
    settings.mass_scaling = dem::MassScaling{.factor = factor};
  dem::Engine<dim> engine(settings);
  engine.start(0.8 * critical_step(engine));
  for (int n = 0; n < 4000; ++n)
    cases::step(engine);
  EXPECT_LT(engine.unbalanced_force(), 1e-8);
  const dem::Reaction<dim> floor = engine.reaction(0);
  double weight = 0.0; // of all; what is held carries its own part
  for (std::size_t i = 0; i < engine.size(); ++i)
    weight += engine.particles().mass[i] / factor * 9.81;
  verify({"force of a floor under particles with scaled mass", "their true weight", 1e-7,
          "what is left of the motion after 4000 steps"},
         floor.force[1] / weight - 1.0);
  return engine.particles().displacement;
}

// Weight is that of the true mass: with any factor the floor carries the same and the body sags
// alike.
template <int dim> void expect_the_same_at_rest() {
  const auto plain = sagged<dim>(1.0), scaled = sagged<dim>(400.0);
  double largest = 0.0, difference = 0.0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    largest = std::max(largest, plain[i].norm());
    difference = std::max(difference, (plain[i] - scaled[i]).norm());
  }
  EXPECT_GT(largest, 0.0);
  verify({"sag of a packing with 400 times the mass", "that with the true mass", 1e-6,
          "what is left of both motions after 4000 steps"},
         difference / largest);
}
TEST(MassScaling, changes_nothing_at_rest_2d) {
  expect_the_same_at_rest<2>();
}
TEST(MassScaling, changes_nothing_at_rest_3d) {
  expect_the_same_at_rest<3>();
}

} // namespace
} // namespace kerf
