// Particles on walls and tools, against closed forms: sliding, rolling, bouncing, pressing.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::Plane;
using dem::ToolMotion;
using dem::ToolShape;
using dem::WallMaterial;

constexpr double g = 10.0;      // m/s²
constexpr double mu = 0.3;      //
constexpr double radius = 1e-3; // m
constexpr double k_wall = 1e6;  // normal and tangential stiffness, N/m
const std::string spring = "swinging of the tangential spring";

/// What the books leave unexplained.
double balance(const dem::Energies& e) {
  return e.kinetic + e.elastic - e.external_work - e.interface_work + e.damping_dissipation +
         e.friction_dissipation + e.fracture_dissipation;
}

/// A particle that rests on a plane and begins to slide along x. Gravity presses it on the plane,
/// which is inclined by an angle: x points downhill.
template <int dim> dem::Settings<dim> on_plane(double speed, double incline = 0.0) {
  const Vec<dim> up = Vec<dim>::Unit(dim - 1);
  dem::Settings<dim> settings;
  settings.radii = {radius};
  settings.material = rock(dim);
  const double mass =
      dem::make_particles<dim>({&up, 1}, settings.radii, settings.material.density).mass[0];
  settings.positions = {(radius - mass * g * std::cos(incline) / k_wall) * up};
  settings.gravity = g * (std::sin(incline) * Vec<dim>::UnitX() - std::cos(incline) * up);
  settings.tools = {{"floor",
                     ToolShape<dim>(Plane<dim>{Vec<dim>::Zero(), up}),
                     {},
                     WallMaterial{k_wall, k_wall, mu, false}}};
  settings.initial.resize(1);
  settings.initial[0].velocity = speed * Vec<dim>::UnitX();
  return settings;
}

/// Speed at which the spring of a contact swings when friction lets go, mu g sqrt(m / k_t), m/s.
template <int dim> double swing(const dem::Engine<dim>& engine) {
  return mu * g * std::sqrt(engine.particles().mass[0] / k_wall);
}

template <int dim> double step_of(const dem::Engine<dim>& engine) {
  return 0.2 * 2.0 / std::sqrt(engine.step_limit().omega2);
}

// Reference: a body that slides is slowed down by mu g: it stops at v0 / (mu g), after
// v0² / (2 mu g). Tolerance: swinging of the spring of the contact, relative to v0.
TEST(Walls, a_disc_that_cannot_turn_slides_until_friction_has_stopped_it) {
  auto settings = on_plane<2>(1.0);
  auto hold = cases::prescribe_at<2>(settings.positions[0], dem::Motion::fixed);
  hold.components = 1u << 2; // the rotation only
  settings.boundary = {hold};
  dem::Engine<2> engine(settings);
  const double dt = step_of(engine), time = 1.0 / (mu * g);
  engine.start(dt);
  double start = 0.0, worst = 0.0, stopped = 0.0;
  for (int n = 0; n * dt < 1.2 * time; ++n) {
    cases::step(engine);
    start = n == 0 ? balance(engine.energies()) : start;
    worst = std::max(worst, std::abs(balance(engine.energies()) / start - 1.0));
    if (stopped == 0.0 && engine.particles().velocity[0][0] < swing(engine))
      stopped = n * dt;
  }
  const double way = engine.particles().displacement[0][0];
  std::printf("stops at %.6f of the time, %.6f of the way; energy off by %.1e\n", stopped / time,
              way * 2.0 * mu * g, worst);
  const double share = swing(engine); // of the speed of 1 m/s
  verify({"time after which a sliding disc stops", "v0 / (mu g)", 2.0 * share, spring},
         stopped / time - 1.0);
  verify({"way on which a sliding disc stops", "v0² / (2 mu g)", 4.0 * share, spring},
         way * 2.0 * mu * g - 1.0);
  EXPECT_NEAR(engine.energies().friction_dissipation, engine.energies().kinetic + start,
              1e-3 * start);
  verify({"energy that the books of a sliding disc miss", "first law", 1e-11,
          "rounding of 2e4 steps; the contact is linear and stays closed"},
         worst);
}

// Reference: with I = c m r², c = 1/2 for a disc and 2/5 for a sphere, the speed falls by mu g t
// and r omega grows by mu g t / c until they meet, at c v0 / ((1 + c) mu g) and v0 / (1 + c).
template <int dim> void slides_then_rolls() {
  const double c = dim == 2 ? 0.5 : 0.4, v0 = 1.0;
  dem::Engine<dim> engine(on_plane<dim>(v0));
  const double dt = step_of(engine), time = c / (1.0 + c) * v0 / (mu * g);
  engine.start(dt);
  const double weight = engine.particles().mass[0] * g;
  double rolls_from = 0.0, mean = 0.0, start = 0.0, worst = 0.0;
  int rows = 0;
  for (int n = 0; n * dt < 2.0 * time; ++n) {
    cases::step(engine);
    start = n == 0 ? balance(engine.energies()) : start;
    worst = std::max(worst, std::abs(balance(engine.energies()) / start - 1.0));
    const double pull = engine.tools()[0].load().force[0];
    if (rolls_from == 0.0 && n > 100 && pull < 0.9 * mu * weight)
      rolls_from = n * dt;
    if (n * dt > 1.5 * time) {
      mean += engine.particles().velocity[0][0];
      ++rows;
    }
  }
  mean /= rows;
  std::printf("%dD: rolls at %.5f of the time with %.6f of the speed; energy off by %.1e\n", dim,
              rolls_from / time, mean * (1.0 + c) / v0, worst);
  const std::string body = dim == 2 ? "disc" : "sphere";
  const double share = swing(engine) / v0;
  verify({"time after which a sliding " + body + " rolls", "c / (1 + c) v0 / (mu g)",
          2.0 * share * (1.0 + c) / c, spring},
         rolls_from / time - 1.0);
  verify({"speed at which a sliding " + body + " rolls", "v0 / (1 + c)", (1.0 + c) * share, spring},
         mean * (1.0 + c) / v0 - 1.0);
  EXPECT_LT(worst, 1e-9);
}
TEST(Walls, a_disc_slides_until_it_rolls_with_two_thirds_of_its_speed) {
  slides_then_rolls<2>();
}
TEST(Walls, a_sphere_slides_until_it_rolls_with_five_sevenths_of_its_speed) {
  slides_then_rolls<3>();
}

// Reference: a sphere rolls down an incline with 5/7 g sin(theta) as long as friction can turn it,
// tan(theta) < 7/2 mu; on a steeper one it slides with g (sin(theta) - mu cos(theta)).
TEST(Walls, a_sphere_rolls_on_an_incline_up_to_seven_halves_of_the_friction_and_slides_beyond) {
  for (const double share : {0.5, 0.98, 1.02, 2.0}) {
    const double angle = std::atan(share * 3.5 * mu);
    dem::Engine<3> engine(on_plane<3>(0.0, angle));
    const double dt = step_of(engine), time = 0.1;
    engine.start(dt);
    const int steps = static_cast<int>(time / dt);
    for (int n = 0; n < steps; ++n)
      cases::step(engine);
    const double rolling = 5.0 / 7.0 * g * std::sin(angle);
    const double sliding = g * (std::sin(angle) - mu * std::cos(angle));
    const double acceleration = engine.particles().velocity[0][0] / (steps * dt);
    const double slip =
        engine.particles().velocity[0][0] - radius * engine.particles().angular_velocity[0][1];
    std::printf("tan %.2f of the limit: %.5f of the acceleration, slip %.1e m/s\n", share,
                acceleration / (share < 1.0 ? rolling : sliding), slip);
    verify({"acceleration of a sphere on an incline, over g",
            "5/7 g sin, from tan > 7/2 mu on g (sin - mu cos)", 10.0 * swing(engine) / time / g,
            spring},
           (acceleration - (share < 1.0 ? rolling : sliding)) / g);
    if (share < 1.0)
      EXPECT_NEAR(slip, 0.0, 10.0 * swing(engine));
    else
      EXPECT_NEAR(slip, time * (sliding - 2.5 * mu * g * std::cos(angle)), 10.0 * swing(engine));
  }
}

// Reference: the scheme keeps the energy of a linear spring. In the step in which a contact closes
// or opens the force acts on a part of the way only: of v dt = gap + overlap the works miss
// k overlap gap / 2 <= k (v dt)² / 8, or (omega dt)² / 4 of the energy.
TEST(Walls, a_sphere_bounces_off_a_plane_with_all_of_its_energy) {
  for (const double share : {0.4, 0.1, 0.025}) {
    auto settings = on_plane<3>(0.0);
    settings.gravity.setZero();
    settings.positions[0][2] = 1.1 * radius;
    settings.initial[0].velocity = {0.3, 0.0, -1.0};
    settings.tools[0].material.friction = 0.0;
    dem::Engine<3> engine(settings);
    const double dt = share / std::sqrt(k_wall / engine.particles().mass[0]);
    engine.start(dt);
    double start = 0.0, worst = 0.0;
    for (int n = 0; engine.particles().displacement[0][2] < 1e-12; ++n) {
      cases::step(engine);
      start = n == 0 ? balance(engine.energies()) : start;
      worst = std::max(worst, std::abs(balance(engine.energies()) / start - 1.0));
    }
    std::printf("omega dt %.3f: energy off by %.1e, rebound %.6f\n", share, worst,
                engine.particles().velocity[0][2]);
    EXPECT_LT(worst, 0.5 * share * share);
    verify({"velocity after an elastic bounce, omega dt = " + fmt::format("{}", share), "energy",
            0.5 * share * share, "(omega dt)² / 4 in the steps of closing and opening"},
           engine.particles().velocity[0][2] - 1.0);
    EXPECT_NEAR(engine.particles().velocity[0][0], 0.3, 1e-14);
  }
}

// Reference: elastic impact of a plate of mass M on a disc of mass m at rest: the disc leaves with
// 2 M / (m + M) of the velocity. Tolerance as above; momentum to rounding.
TEST(Walls, a_free_plate_shares_its_momentum_with_the_disc_that_it_hits) {
  auto settings = on_plane<2>(0.0);
  settings.gravity.setZero();
  settings.positions[0][1] = 1.1 * radius;
  const double plate = 3e-3, share = 0.05; // kg
  settings.tools[0].motion.velocity[1] = 1.0;
  settings.tools[0].motion.free_translation =
      dem::FreeTranslation<2>{{false, true}, plate, {0.0, 0.0}};
  dem::Engine<2> engine(settings);
  const double mass = engine.particles().mass[0];
  engine.start(share / std::sqrt(k_wall * (1.0 / mass + 1.0 / plate)));
  for (int n = 0; n < 10'000; ++n)
    cases::step(engine);
  const double v = engine.particles().velocity[0][1];
  const double v_plate = engine.tools()[0].velocity().translation[1];
  std::printf("impact: disc %.6f m/s, plate %.6f m/s\n", v, v_plate);
  verify({"velocity of a disc hit by a free plate", "2 M / (m + M)", 0.5 * share * share,
          "(omega dt)² / 4 in the steps of closing and opening"},
         v - 2.0 * plate / (mass + plate));
  EXPECT_NEAR(mass * v + plate * v_plate, plate, 1e-13 * plate);
}

/// A bonded body between a floor and a box that presses, turns and moves on.
template <int dim> double energy_error(double share, bool slides) {
  auto settings = cases::irregular_model<dim>(5, rock(dim, 0.5), 5);
  const double k = settings.material.normal_stiffness, width = 5.0 * spacing;
  const Vec<dim> up = Vec<dim>::Unit(dim - 1);
  WallMaterial material{k, 0.5 * k, slides ? 0.2 : 1e9, true};
  ToolMotion<dim> motion;
  motion.reference = width * (up + 0.5 * Vec<dim>::UnitX());
  const double end = 40.0 / std::sqrt(k / 2e-3); // s
  for (int a = 0; a < dim; ++a)
    motion.velocity[a] = (a == dim - 1 ? -1.0 : 0.4) * 2e-3 * spacing / end;
  if constexpr (dim == 3)
    motion.axis = Vec<3>::UnitZ();
  motion.rotation_rate = 1e-3 / end;
  double top = 0.0, bottom = 0.0;
  for (std::size_t i = 0; i < settings.positions.size(); ++i) {
    top = std::max(top, settings.positions[i][dim - 1] + settings.radii[i]);
    bottom = std::min(bottom, settings.positions[i][dim - 1] - settings.radii[i]);
  }
  const double deep = 0.05 * spacing;
  settings.tools = {
      {"floor", ToolShape<dim>(Plane<dim>{(bottom + deep) * up, up}), {}, material},
      {"press", ToolShape<dim>(Plane<dim>{(top - deep) * up, -up}), motion, material}};
  dem::Engine<dim> engine(settings);
  const double dt = share * 2.0 / std::sqrt(engine.step_limit().omega2);
  engine.start(dt);
  double worst = 0.0;
  for (int n = 0; n * dt < end; ++n) {
    cases::step(engine);
    worst = std::max(worst, std::abs(balance(engine.energies())));
  }
  const auto e = engine.energies();
  std::printf("%dD, step %.3f of the limit: work %.3e J, elastic %.3e, friction %.3e, "
              "off by %.1e of the work\n",
              dim, share, e.external_work, e.elastic, e.friction_dissipation,
              worst / e.external_work);
  EXPECT_EQ(e.friction_dissipation > 1e-2 * e.external_work, slides);
  return worst / e.external_work;
}

// The tools press a body, which stays in contact. Reference: the error of the energy falls as dt²,
// as that of bonds does.
TEST(Walls, what_tools_do_is_found_in_the_energies_with_an_error_that_falls_as_dt_squared) {
  const double coarse = energy_error<2>(0.4, false), fine = energy_error<2>(0.1, false);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, coarse / 8.0);
  const double coarse_3D = energy_error<3>(0.4, false), fine_3D = energy_error<3>(0.1, false);
  EXPECT_LT(coarse_3D, 1e-3);
  EXPECT_LT(fine_3D, coarse_3D / 8.0);
}
TEST(Walls, what_slips_on_tools_is_found_in_the_book_of_friction) {
  EXPECT_LT(energy_error<2>(0.1, true), 1e-3);
  EXPECT_LT(energy_error<3>(0.1, true), 1e-3);
}

// Reference: equilibrium. The servo pushes with the wanted force, and so does the floor.
TEST(Walls, a_plate_with_a_servo_presses_a_lattice_with_the_wanted_force) {
  auto settings = cases::lattice_model<2>(dem::LatticeType::triangular, {8, 8}, rock(2));
  settings.damping = {dem::DampingKind::nonviscous, 0.5, 0.5};
  const double top = 7.0 * spacing * std::sqrt(0.75) + 0.5 * spacing, wanted = 2e4;
  const WallMaterial material{1e10, 0.0, 0.0, false};
  ToolMotion<2> motion;
  motion.servo = dem::Servo<2>{{0.0, -1.0}, wanted, 0.1};
  settings.tools = {
      {"floor", ToolShape<2>(Plane<2>{{0.0, -0.5 * spacing}, {0.0, 1.0}}), {}, material},
      {"plate", ToolShape<2>(Plane<2>{{0.0, top + 1e-6}, {0.0, -1.0}}), motion, material}};
  dem::Engine<2> engine(settings);
  engine.start(0.5 * 2.0 / std::sqrt(engine.step_limit().omega2));
  for (int n = 0; n < 4000; ++n)
    cases::step(engine);
  const double push = engine.tools()[1].load().force[1], floor = -engine.tools()[0].load().force[1];
  std::printf("servo: %.6f, floor: %.6f of the wanted force\n", push / wanted, floor / wanted);
  for (const double force : {push, floor})
    verify({"force of a servo and of the floor under it", "equilibrium", 1e-4,
            "motion that damping leaves"},
           force / wanted - 1.0);
}

// Reference: statics.
TEST(Walls, a_floor_carries_the_weight_of_a_column) {
  auto settings = cases::lattice_model<3>(dem::LatticeType::cubic, {2, 2, 10}, rock(3));
  settings.gravity = {0.0, 0.0, -9.81};
  settings.damping = {dem::DampingKind::nonviscous, 0.5, 0.5};
  settings.tools = {{"floor",
                     ToolShape<3>(Plane<3>{{0.0, 0.0, -0.5 * spacing}, {0.0, 0.0, 1.0}}),
                     {},
                     WallMaterial{1e7, 2e6, 0.5, false}}};
  dem::Engine<3> engine(settings);
  engine.start(0.5 * 2.0 / std::sqrt(engine.step_limit().omega2));
  for (int n = 0; n < 20'000; ++n)
    cases::step(engine);
  const auto& mass = engine.particles().mass;
  const double weight = 9.81 * mass[0] * static_cast<double>(mass.size());
  const auto& load = engine.tools()[0].load();
  std::printf("weight on the floor: %.8f of the column\n", -load.force[2] / weight);
  verify({"weight that a floor carries", "statics", 1e-4, "motion that damping leaves"},
         -load.force[2] / weight - 1.0);
  EXPECT_NEAR(load.force.head<2>().norm(), 0.0, 1e-4 * weight);
  EXPECT_NEAR(load.moment[1], 0.5 * spacing * weight, 1e-3 * spacing * weight);
}

// Reference: a disc on a wall has k_n / m, and k_t (1 / m + r² / I) = 3 k_t / m for the shear with
// the rotation. Central differences fly apart above 2 / omega.
TEST(Walls, the_critical_step_is_that_of_a_disc_that_touches_a_wall) {
  auto settings = on_plane<2>(0.0);
  const dem::Engine<2> engine(settings);
  const double mass = engine.particles().mass[0];
  EXPECT_NEAR(engine.step_limit().omega2, 3.0 * k_wall / mass, 1e-9 * k_wall / mass);

  settings.tools[0].material.tangential_stiffness = 0.0;
  for (const double share : {0.99, 1.01}) {
    dem::Engine<2> one(settings);
    verify({"square of the frequency of a disc on a wall", "k_n / m", 1e-9, "rounding"},
           one.step_limit().omega2 * mass / k_wall - 1.0);
    one.start(share * 2.0 / std::sqrt(one.step_limit().omega2));
    double highest = 0.0;
    for (int n = 0; n < 3000; ++n) {
      cases::step(one);
      highest = std::max(highest, std::abs(one.particles().displacement[0][1]));
    }
    EXPECT_EQ(highest > 1e-3 * radius, share > 1.0) << highest;
  }
}

// Reference: two masses and a spring, k (1 / m + 1 / M).
TEST(Walls, the_critical_step_counts_the_mass_of_a_free_tool) {
  auto settings = on_plane<2>(0.0);
  settings.tools[0].material.tangential_stiffness = 0.0;
  settings.tools[0].motion.free_translation =
      dem::FreeTranslation<2>{{false, true}, 1e-3, {0.0, 0.0}};
  const dem::Engine<2> engine(settings);
  const double omega2 = k_wall * (1.0 / engine.particles().mass[0] + 1.0 / 1e-3);
  EXPECT_NEAR(engine.step_limit().omega2, omega2, 1e-9 * omega2);
}

// A tool that is still away is counted once with every particle, so that it may come.
TEST(Walls, the_critical_step_counts_a_tool_that_is_still_to_come) {
  auto settings = cases::lattice_model<2>(dem::LatticeType::triangular, {6, 6}, rock(2));
  const double alone = dem::Engine<2>(settings).step_limit().omega2;
  settings.tools = {{"far",
                     ToolShape<2>(Plane<2>{{0.0, -1.0}, {0.0, 1.0}}),
                     {},
                     WallMaterial{5e10, 0.0, 0.0, false}}};
  const dem::Engine<2> engine(settings);
  EXPECT_NEAR(engine.step_limit().omega2, alone + 5e10 / engine.particles().mass[0], 1e-9 * alone);
}

// Reference: a weight on a spring: potential energy is counted as work of the weight. The system is
// linear while the particle stays on the floor: the books close to rounding, 1e-19 m of a radius of
// 1 mm over an overlap of 8e-8 m.
TEST(Walls, the_work_of_the_weight_is_found_in_the_energies) {
  auto settings = on_plane<2>(0.0);
  settings.positions[0][1] -= 1e-9;
  dem::Engine<2> engine(settings);
  engine.start(step_of(engine));
  double start = 0.0;
  for (int n = 0; n < 1000; ++n) {
    cases::step(engine);
    const auto e = engine.energies();
    start = n == 0 ? balance(e) : start;
    EXPECT_NEAR(balance(e), start, 1e-11 * e.elastic);
  }
}

} // namespace
} // namespace kerf
