// What changes between two steps: the state goes on, and the books with it.
#include "dem_core/balance.hpp"
#include "dem_core/change.hpp"
#include "dem_core/engine.hpp"
#include "tests/cases/dem_models.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace kerf {
namespace {

void run(dem::Engine<2>& engine, int steps) {
  for (int n = 0; n < steps; ++n)
    cases::step(engine);
}

/// Two discs with a gap of their own between them, which do not touch.
dem::Settings<2> two_discs(double gap) {
  auto settings = cases::pair_model<2>(Vec<2>::UnitX(), cases::rock(2));
  settings.positions[1][0] += gap;
  settings.bonds = false;
  return settings;
}

/// A body of one disc.
dem::ClusterSettings<2> body_of(std::uint32_t id) {
  dem::ClusterSettings<2> body;
  body.name = "body";
  body.ids = {id};
  return body;
}

// Free fall in a weight that changes: central differences give v and u of every step exactly, and
// the trapezoidal work of the weight must be all of the kinetic energy, to round-off.
void weight_that_changes_keeps_the_energy_book_closed(bool with_cluster) {
  auto settings = two_discs(5e-3);
  if (with_cluster)
    settings.clusters = {body_of(0)};
  settings.gravity = Vec<2>(0.0, -9.81);
  dem::Engine<2> engine(settings);
  engine.start(1e-6);
  double largest = 0.0, error = 0.0;
  std::optional<double> start; // 1/2 v^(-1/2) . M v^(1/2), which is not zero
  const auto look = [&] {
    const dem::Energies e = engine.energies();
    largest = std::max(largest, e.kinetic);
    start = start.value_or(e.kinetic - e.external_work);
    error = std::max(error, std::abs(e.kinetic - e.external_work - *start));
  };
  for (int n = 0; n < 500; ++n) {
    if (n == 200)
      engine.change({.damping = {},
                     .gravity = Vec<2>(3.0, 20.0),
                     .friction = {},
                     .bond_gap = {},
                     .boundary = {},
                     .tools = {}});
    cases::step(engine);
    look();
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_LT(error, 1e-12 * largest);
  // v = g1 t1 + g2 t2
  EXPECT_NEAR(engine.particles().velocity[0][0], 3.0 * 299.5e-6 + 3.0 * 0.5e-6, 1e-15);
}
TEST(DemChange, of_gravity_keeps_the_energy_book_closed) {
  weight_that_changes_keeps_the_energy_book_closed(false);
}
TEST(DemChange, of_gravity_keeps_the_energy_book_of_clusters_closed) {
  weight_that_changes_keeps_the_energy_book_closed(true);
}

TEST(DemChange, bonds_who_touches_without_a_jump_of_force_and_gaps_without_stress) {
  for (const double gap : {-2e-6, 3e-6}) {
    dem::Engine<2> engine(two_discs(gap));
    engine.start(1e-9);
    cases::step(engine);
    const double before = engine.contacts().normal_force[0];
    EXPECT_EQ(engine.bonds(), 0u);
    dem::Change<2> change;
    change.bond_gap = 1e-2;
    engine.change(change);
    EXPECT_EQ(engine.bonds(), 1u);
    EXPECT_EQ(engine.bonds_at_start(), 1u);
    engine.compute_own_forces();
    const double after = engine.contacts().normal_force[0];
    EXPECT_NEAR(after, gap < 0.0 ? before : 0.0, 1e-4 * 1e10 * 2e-6); // one step of motion
    if (gap < 0.0) {
      EXPECT_NEAR(before, -1e10 * 2e-6, 1e-6 * 1e10 * 2e-6);
    }
    // It pulls now, when the discs are drawn apart.
    engine.integrate();
    dem::Change<2> pull;
    dem::Prescription<2> moved = cases::prescribe_at<2>(engine.particles().reference[1],
                                                        dem::Motion::velocity, Vec<2>(1.0, 0.0));
    pull.boundary = std::vector{moved};
    engine.change(pull);
    double largest = 0.0; // N
    for (int n = 0; n < 3000; ++n) {
      cases::step(engine);
      largest = std::max(largest, engine.contacts().normal_force[0]);
    }
    EXPECT_GT(largest, 1e3);
    EXPECT_EQ(engine.bonds(), 1u);
  }
}

TEST(DemChange, of_bonds_is_limited_to_the_gap) {
  dem::Engine<2> engine(two_discs(3e-6));
  engine.start(1e-9);
  dem::Change<2> change;
  change.bond_gap = 2e-3; // of 1 mm: 2 um
  engine.change(change);
  EXPECT_EQ(engine.bonds(), 0u);
}

TEST(DemChange, of_a_boundary_lets_particles_go_and_counts_time_anew) {
  auto settings = two_discs(5e-3);
  settings.boundary = {
      cases::prescribe_at<2>(settings.positions[0], dem::Motion::velocity, Vec<2>(2.0, 0.0))};
  dem::Engine<2> engine(settings);
  engine.start(1e-6);
  run(engine, 100);
  EXPECT_NEAR(engine.particles().displacement[0][0], 2.0 * 100e-6, 1e-15);

  dem::Change<2> pulse; // of 1 um on the other one, whole in 50 steps
  dem::Prescription<2> hann = cases::prescribe_at<2>(settings.positions[1], dem::Motion::hann);
  hann.amplitude = Vec<2>(1e-6, 0.0);
  hann.duration = 100e-6;
  pulse.boundary = std::vector{hann};
  engine.change(pulse);
  run(engine, 50);
  EXPECT_NEAR(engine.particles().displacement[1][0], 1e-6, 1e-15);
  EXPECT_NEAR(engine.particles().displacement[0][0], 2.0 * 150e-6, 1e-12); // flies on freely

  dem::Change<2> release;
  release.boundary.emplace();
  engine.change(release);
  EXPECT_TRUE(engine.boundary().sets().empty());
  EXPECT_EQ(engine.boundary().of(0), nullptr);
}

// What drives a bonded pair, first at one disc and then at the other, is found in its energies;
// both are linear in the displacement but for the turning of the bond, which there is none of.
TEST(DemChange, of_a_boundary_keeps_the_energy_book_closed) {
  auto settings = cases::pair_model<2>(Vec<2>::UnitX(), cases::rock(2));
  dem::Prescription<2> hann =
      cases::prescribe_at<2>(settings.positions[0], dem::Motion::hann, Vec<2>::Zero());
  hann.amplitude = Vec<2>(1e-6, 0.0);
  hann.duration = 400e-9;
  settings.boundary = {hann};
  dem::Engine<2> engine(settings);
  engine.start(1e-9);
  double largest = 0.0, error = 0.0;
  std::optional<double> start; // see above
  for (int n = 0; n < 600; ++n) {
    if (n == 150) {
      dem::Change<2> change;
      hann.box = cases::prescribe_at<2>(settings.positions[1], dem::Motion::hann).box;
      change.boundary = std::vector{hann};
      engine.change(change);
    }
    cases::step(engine);
    const dem::Energies e = engine.energies();
    largest = std::max(largest, e.external_work);
    const double missing = e.kinetic + e.elastic - e.external_work;
    start = start.value_or(missing);
    error = std::max(error, std::abs(missing - *start));
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_LT(error, 1e-12 * largest);
}

TEST(DemChange, of_a_boundary_leaves_clusters_alone) {
  auto settings = two_discs(5e-3);
  settings.gravity = Vec<2>(0.0, -9.81);
  settings.clusters = {body_of(0)};
  dem::Engine<2> plain(settings), changed(settings);
  plain.start(1e-6);
  changed.start(1e-6);
  run(plain, 200);
  run(changed, 100);
  dem::Change<2> change;
  change.boundary = std::vector{cases::prescribe_at<2>(settings.positions[1], dem::Motion::fixed)};
  changed.change(change);
  run(changed, 100);
  EXPECT_EQ(plain.particles().displacement[0], changed.particles().displacement[0]);
  EXPECT_NE(plain.particles().displacement[1], changed.particles().displacement[1]);

  change.boundary = std::vector{cases::prescribe_at<2>(settings.positions[0], dem::Motion::fixed)};
  EXPECT_THROW(changed.change(change), std::invalid_argument);
  run(plain, 10);
  run(changed, 10); // as if nothing had been asked
  EXPECT_EQ(plain.particles().displacement[0], changed.particles().displacement[0]);
}

TEST(DemChange, of_a_tool_goes_on_from_its_pose) {
  auto settings = two_discs(5e-3);
  dem::ToolMotion<2> motion;
  motion.reference = Vec<2>(0.0, -1e-2);
  motion.velocity = {kerf::TimeTable(1.0), kerf::TimeTable(0.0)};
  motion.rotation_rate = kerf::TimeTable(100.0);
  settings.tools.push_back({"floor",
                            dem::ToolShape<2>(dem::Plane<2>{motion.reference, Vec<2>(0.0, 1.0)}),
                            motion,
                            {1e10, 1e9, 0.0}});
  dem::Engine<2> engine(settings);
  engine.start(1e-6);
  run(engine, 200);
  dem::Change<2> change;
  motion.velocity = {kerf::TimeTable({0.0, 100e-6}, {0.0, -4.0}), kerf::TimeTable(3.0)};
  motion.rotation_rate = kerf::TimeTable(-50.0);
  change.tools = {{0, motion}};
  engine.change(change);
  run(engine, 100);
  engine.compute_own_forces(); // pose of t_300
  const dem::Tool<2>& tool = engine.tools()[0];
  EXPECT_NEAR(tool.pose().reference[0], 1.0 * 200e-6 - 0.5 * 4.0 * 100e-6, 1e-14);
  EXPECT_NEAR(tool.pose().reference[1], -1e-2 + 3.0 * 100e-6, 1e-14);
  EXPECT_NEAR(tool.angle(), 100.0 * 200e-6 - 50.0 * 100e-6, 1e-14);
}

TEST(DemChange, of_damping_acts_from_then_on) {
  auto settings = two_discs(5e-3);
  settings.gravity = Vec<2>(0.0, -10.0);
  dem::Engine<2> engine(settings);
  engine.start(1e-6);
  run(engine, 100);
  const double before = engine.particles().velocity[0][1];
  dem::Change<2> change;
  change.damping = dem::Damping{dem::DampingKind::nonviscous, 0.4, 0.0};
  engine.change(change);
  run(engine, 100);
  const double damped = engine.particles().velocity[0][1];
  EXPECT_NEAR(damped - before, -10.0 * 0.6 * 100e-6, 1e-12); // eq. 18
  EXPECT_GT(engine.energies().damping_dissipation, 0.0);
  const double dissipated = engine.energies().damping_dissipation;
  change.damping = dem::Damping{};
  engine.change(change);
  run(engine, 100);
  EXPECT_NEAR(engine.particles().velocity[0][1] - damped, -10.0 * 100e-6, 1e-12);
  // Half a step of the last damping comes with the first step after it.
  EXPECT_NEAR(engine.energies().damping_dissipation, dissipated, 0.02 * dissipated);
}

TEST(DemChange, settings_are_those_of_a_state_that_is_restored) {
  auto settings = two_discs(-2e-6);
  const auto change_both = [](dem::Engine<2>& engine, bool with_bonds) {
    dem::Change<2> change;
    change.gravity = Vec<2>(0.0, -5.0);
    change.damping = dem::Damping{dem::DampingKind::nonviscous, 0.3, 0.1};
    if (with_bonds)
      change.bond_gap = 1e-2;
    change.boundary = std::vector{cases::prescribe_at<2>(engine.particles().reference[0],
                                                         dem::Motion::velocity, Vec<2>(0.1, 0.0))};
    engine.change(change);
  };
  dem::Engine<2> whole(settings), other(settings);
  whole.start(1e-8);
  run(whole, 50);
  change_both(whole, true);
  run(whole, 50);

  other.start(1e-8);
  change_both(other, false);
  other.restore(whole.state());
  run(whole, 200);
  run(other, 200);
  EXPECT_EQ(whole.state(), other.state());
  EXPECT_EQ(whole.energies().external_work, other.energies().external_work);
}

} // namespace
} // namespace kerf
