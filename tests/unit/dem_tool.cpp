// Rigid tools: where they are after many steps, what moves them, and their work.
#include "dem_core/tool.hpp"
#include "tests/cases/surfaces.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace kerf {
namespace {

using dem::Plane;
using kerf::TimeTable;
using dem::Tool;
using dem::ToolMotion;
using dem::ToolShape;
using std::numbers::pi;

template <int dim> Tool<dim> tool_with(const ToolMotion<dim>& motion) {
  return Tool<dim>(ToolShape<dim>(Plane<dim>{Vec<dim>::Zero(), Vec<dim>::UnitX()}), motion);
}

/// Runs steps 0 to count - 1, with the loads that load(tool) adds, and goes to t_count.
template <int dim>
void run(
    Tool<dim>& tool, std::uint64_t count, double dt,
    const std::function<void(Tool<dim>&)>& load = [](Tool<dim>&) {}) {
  for (std::uint64_t step = 0; step < count; ++step) {
    tool.begin_step(step, dt);
    load(tool);
    tool.end_step();
  }
  tool.begin_step(count, dt);
}

// Reference: areas of the triangles and trapezoids under the table.
TEST(TimeTable, is_linear_between_its_points_and_constant_beyond) {
  const TimeTable table({-1.0, 1.0, 2.0}, {0.0, 4.0, -2.0});
  EXPECT_EQ(table.value(-5.0), 0.0);
  EXPECT_EQ(table.value(0.0), 2.0);
  EXPECT_EQ(table.value(1.5), 1.0);
  EXPECT_EQ(table.value(9.0), -2.0);
  EXPECT_DOUBLE_EQ(table.integral(1.0), 3.0);
  EXPECT_DOUBLE_EQ(table.integral(2.0), 4.0);
  EXPECT_DOUBLE_EQ(table.integral(4.0), 0.0);
  EXPECT_DOUBLE_EQ(table.integral(-3.0), -1.0);
  EXPECT_DOUBLE_EQ(table.mean(0.0, 1.0), 3.0);
  EXPECT_DOUBLE_EQ(table.mean(0.5, 2.0), (3.5 * 0.5 + 1.0) / 1.5);
}

TEST(TimeTable, refuses_what_is_no_table) {
  EXPECT_THROW(TimeTable({}, {}), std::invalid_argument);
  EXPECT_THROW(TimeTable({0.0, 1.0}, {0.0}), std::invalid_argument);
  EXPECT_THROW(TimeTable({0.0, 0.0}, {0.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(TimeTable(std::nan("")), std::invalid_argument);
}

// Reference: rotation by omega t about an axis that has moved by v t. Tolerance: the rounding of
// the angle of 10 turns and of the positions; a sum over the steps would be off by some 1e-10.
TEST(Tool, turns_on_exact_arcs_about_an_axis_that_moves_with_it_in_2D) {
  ToolMotion<2> motion;
  motion.reference = {0.5, 0.2};
  motion.velocity = {0.3, -0.1};
  motion.rotation_rate = 20.0 * pi;
  auto tool = tool_with(motion);
  const double dt = 1e-6;
  run<2>(tool, 1'000'003, dt);
  const double t = 1'000'003 * dt, angle = 20.0 * pi * t;
  const Vec<2> expected = Vec<2>(0.5 + 0.3 * t, 0.2 - 0.1 * t) +
                          2.0 * Vec<2>(std::cos(angle + 0.5), std::sin(angle + 0.5));
  const Vec<2> body(0.5 + 2.0 * std::cos(0.5), 0.2 + 2.0 * std::sin(0.5));
  const double error = (tool.pose().to_space(body) - expected).norm();
  std::printf("arc in 2D: off by %.1e m after 1e6 steps\n", error);
  EXPECT_LT(error, 1e-13);
  EXPECT_LT((tool.pose().to_body(expected) - body).norm(), 1e-13);
}

TEST(Tool, turns_on_exact_arcs_about_an_axis_that_moves_with_it_in_3D) {
  ToolMotion<3> motion;
  motion.reference = {0.5, 0.2, -0.1};
  motion.velocity = {0.0, 0.0, 1.0};
  motion.axis = {0.0, 0.0, -3.0};
  motion.rotation_rate = TimeTable({0.0, 1.0}, {0.0, 8.0 * pi}); // angle 4 pi t² until t = 1 s
  auto tool = tool_with(motion);
  const double dt = 1e-6;
  run<3>(tool, 1'000'000, dt);
  const double angle = -4.0 * pi;
  const Vec<3> expected(0.5 + 2.0 * std::cos(angle), 0.2 + 2.0 * std::sin(angle), 0.4 + 1.0);
  const double error = (tool.pose().to_space({2.5, 0.2, 0.4}) - expected).norm();
  std::printf("arc in 3D: off by %.1e m after 1e6 steps\n", error);
  EXPECT_LT(error, 1e-13);
  EXPECT_NEAR(tool.velocity().rotation[2], -8.0 * pi, 1e-4); // half a step before
}

// Reference: integral of the table; ramp from 0 to 2 m/s in 1 s, then 2 m/s. dt does not meet it.
TEST(Tool, follows_a_table_of_velocities_exactly) {
  ToolMotion<2> motion;
  motion.velocity[1] = TimeTable({0.0, 1.0}, {0.0, 2.0});
  auto tool = tool_with(motion);
  const double dt = 3e-5;
  run<2>(tool, 100'000, dt);
  EXPECT_NEAR(tool.pose().reference[1], 1.0 + 2.0 * 2.0, 1e-14);
  EXPECT_DOUBLE_EQ(tool.velocity().translation[1], 2.0);
}

// The velocity of a point, times the step, is the way that it has come, but for omega² r dt² / 2.
TEST(Tool, has_the_velocity_field_that_has_brought_it_here) {
  ToolMotion<3> motion;
  motion.reference = {1.0, 0.0, 0.0};
  motion.velocity = {0.5, 0.0, TimeTable({0.0, 1.0}, {0.0, 1.0})};
  motion.axis = {1.0, 2.0, 2.0};
  motion.rotation_rate = 5.0;
  auto tool = tool_with(motion);
  const double dt = 1e-5;
  const Vec<3> body(1.3, 0.4, -0.2);
  run<3>(tool, 1000, dt);
  const Vec<3> before = tool.pose().to_space(body);
  tool.end_step();
  tool.begin_step(1001, dt);
  const Vec<3> now = tool.pose().to_space(body);
  EXPECT_LT((dt * tool.velocity_at(now) - (now - before)).norm(), 0.5 * 25.0 * 0.6 * dt * dt);
}

TEST(Tool, does_not_move_unless_told_to) {
  auto tool = tool_with(ToolMotion<3>{});
  run<3>(tool, 10, 1e-3, [](Tool<3>& t) { t.add_load({1.0, 2.0, 3.0}, {1.0, 1.0, 1.0}, 1e6); });
  EXPECT_EQ(tool.pose().to_space({1.0, 2.0, 3.0}), Vec<3>(1.0, 2.0, 3.0));
  EXPECT_EQ(tool.work(), 0.0);
}

// A spring of stiffness k begins 1 mm ahead. The tool comes with its largest velocity; in contact
// the missing force halves in every step, exactly as long as the bound does not cut it.
TEST(Tool, with_a_servo_comes_to_a_spring_and_halves_the_missing_force_in_each_step) {
  const double k = 1e7, wanted = 500.0, dt = 1e-5;
  ToolMotion<2> motion;
  motion.velocity = {0.25, 0.1}; // across the servo, and in part along it, where it does not count
  motion.servo = dem::Servo<2>{{0.0, -2.0}, wanted, 0.5};
  auto tool = tool_with(motion);
  double missing = wanted;
  int halved = 0;
  for (std::uint64_t step = 0; step < 400; ++step) {
    tool.begin_step(step, dt);
    const double compression = -tool.pose().reference[1] - 1e-3;
    const double push = std::max(0.0, k * compression);
    if (push > 0.0)
      tool.add_load({0.0, push}, tool.pose().reference, k);
    tool.end_step();
    EXPECT_LE(std::abs(tool.velocity().translation[1]), 0.5);
    EXPECT_NEAR(tool.velocity().translation[0], 0.25, 1e-12);
    if (push == 0.0) {
      EXPECT_EQ(tool.velocity().translation[1], -0.5);
    } else if (missing < 90.0 && missing > 1e-6) { // 0.5 · 90 N / (k dt) = 0.45 m/s
      EXPECT_NEAR((wanted - push) / missing, 0.5, 1e-4);
      ++halved;
    }
    missing = wanted - push;
  }
  std::printf("servo: %d halvings, then %.1e N are missing of %g N\n", halved, missing, wanted);
  EXPECT_GT(halved, 20);
  EXPECT_NEAR(missing, 0.0, 1e-9 * wanted);
}

TEST(Tool, with_a_servo_follows_a_wanted_force_that_changes) {
  const double k = 1e6, dt = 1e-5;
  ToolMotion<3> motion;
  motion.servo =
      dem::Servo<3>{{1.0, 0.0, 0.0}, TimeTable({0.0, 0.01, 0.02}, {0.0, 100.0, 20.0}), 1.0};
  auto tool = tool_with(motion);
  const auto spring = [&](Tool<3>& t) {
    t.add_load({-k * t.pose().reference[0], 0.0, 0.0}, t.pose().reference, k);
  };
  run<3>(tool, 1000, dt, spring);
  EXPECT_NEAR(k * tool.pose().reference[0], 100.0 - 2.0 * 0.1, 1e-9); // two steps of 0.1 N behind
  auto later = tool_with(motion);
  run<3>(later, 3000, dt, spring);
  EXPECT_NEAR(k * later.pose().reference[0], 20.0, 1e-9);
}

// Reference: angle M t² / (2 I), rate M t / I. Central differences that begin with half a step are
// exact for a constant moment, at t_n and at t_(n-1/2).
TEST(Tool, as_a_free_disc_is_turned_by_a_constant_moment_as_in_closed_form) {
  const double inertia = 0.02, force = 3.0, arm = 0.1, dt = 1e-4;
  ToolMotion<2> motion;
  motion.reference = {0.3, 0.0};
  motion.velocity = {2.0, 0.0};
  motion.free_rotation = dem::FreeRotation{inertia, -0.1};
  auto tool = tool_with(motion);
  const auto drive = [&](Tool<2>& t) {
    t.add_load({force, 0.0}, t.pose().reference + Vec<2>(0.0, -arm), 0.0); // moment + force arm
  };
  const int steps = 10'000;
  run<2>(tool, steps, dt, drive);
  const double t = steps * dt, acceleration = (force * arm - 0.1) / inertia;
  const double angle = 0.5 * acceleration * t * t; // 5 rad
  const Eigen::Matrix2d expected = Eigen::Rotation2Dd(angle).toRotationMatrix();
  EXPECT_LT((tool.pose().rotation - expected).norm(), 1e-11);
  EXPECT_NEAR(tool.velocity().rotation[0], acceleration * (t - 0.5 * dt), 1e-11);
  EXPECT_NEAR(tool.pose().reference[0], 0.3 + 2.0 * t, 1e-14);
  // Work of the contacts on the tool until the last whole step.
  const double last = (steps - 1) * dt;
  const double turned = 0.5 * acceleration * last * last;
  EXPECT_NEAR(tool.work(), -(force * 2.0 * last + force * arm * turned), 1e-10);
}

// In 3D only the part of the moment along the axis turns the wheel.
TEST(Tool, as_a_free_wheel_in_3D_turns_about_its_axis_only) {
  ToolMotion<3> motion;
  motion.axis = {0.0, 2.0, 0.0};
  motion.rotation_rate = 4.0; // to begin with
  motion.free_rotation = dem::FreeRotation{0.5, 0.0};
  auto tool = tool_with(motion);
  run<3>(tool, 100, 1e-3, [](Tool<3>& t) { t.add_load({1.0, 5.0, 0.0}, {0.0, 0.0, 2.0}, 0.0); });
  EXPECT_NEAR(tool.velocity().rotation[1], 4.0 + 2.0 / 0.5 * 0.0995, 1e-13);
  EXPECT_EQ(tool.velocity().rotation[0], 0.0);
  const double angle = 4.0 * 0.1 + 0.5 * 4.0 * 0.01;
  EXPECT_NEAR(tool.pose().rotation(0, 2), std::sin(angle), 1e-13);
}

// Reference: x = v t + F t² / (2 m), which central differences give exactly.
TEST(Tool, as_a_free_body_falls_along_its_free_axes_and_follows_its_velocity_along_others) {
  ToolMotion<3> motion;
  motion.velocity = {1.0, 2.0, 3.0};
  motion.free_translation = dem::FreeTranslation<3>{{false, false, true}, 4.0, {0.0, 0.0, -40.0}};
  auto tool = tool_with(motion);
  run<3>(tool, 1000, 1e-3, [](Tool<3>& t) { t.add_load({9.0, 9.0, 8.0}, {0.0, 0.0, 0.0}, 0.0); });
  EXPECT_NEAR(tool.pose().reference[0], 1.0, 1e-14);
  EXPECT_NEAR(tool.pose().reference[1], 2.0, 1e-14);
  EXPECT_NEAR(tool.pose().reference[2], 3.0 - 0.5 * 8.0, 1e-12);
}

// Reference: the work of a linear spring over a step is its mean force times the way, so that the
// work done on it is its energy k x² / 2 at every t_n, to rounding; and omega dt = 2 asin of half
// the step in sqrt(k / m) is the frequency of the difference equation.
TEST(Tool, as_a_free_body_does_the_work_that_its_spring_holds) {
  const double k = 1e6, mass = 2.0, dt = 1e-4;
  ToolMotion<2> motion;
  motion.velocity = {3.0, 0.0};
  motion.free_translation = dem::FreeTranslation<2>{{true, false}, mass, {0.0, 0.0}};
  auto tool = tool_with(motion);
  const double omega = 2.0 * std::asin(0.5 * dt * std::sqrt(k / mass)) / dt;
  for (std::uint64_t step = 0; step < 2000; ++step) {
    tool.begin_step(step, dt);
    const double x = tool.pose().reference[0];
    EXPECT_NEAR(x,
                3.0 * dt * std::sin(omega * dt * static_cast<double>(step)) / std::sin(omega * dt),
                1e-13);
    tool.add_load({-k * x, 0.0}, tool.pose().reference, k);
    tool.end_step();
    EXPECT_NEAR(tool.work(), 0.5 * k * x * x, 1e-10);
  }
}

// Reference: the power of each force is force . v(point), which is F . v + M . omega of the sums.
TEST(Tool, has_the_power_of_force_times_velocity_plus_moment_times_rate) {
  ToolMotion<3> motion;
  motion.reference = {0.1, 0.2, 0.3};
  motion.velocity = {1.0, -2.0, 0.5};
  motion.axis = {1.0, 1.0, 1.0};
  motion.rotation_rate = 7.0;
  auto tool = tool_with(motion);
  cases::Random random(8);
  const double dt = 1e-3;
  double work = 0.0, work_ahead = 0.0; // until t_n, until t_(n+1/2)
  for (std::uint64_t step = 0; step < 50; ++step) {
    tool.begin_step(step, dt);
    double power = 0.0;
    Vec<3> force = Vec<3>::Zero();
    for (int k = 0; k < 5; ++k) {
      const Vec<3> f = random.point<3>(-1.0, 1.0), x = random.point<3>(-1.0, 1.0);
      tool.add_load(f, x, 0.0);
      power -= f.dot(tool.velocity_at(x));
      force += f;
    }
    EXPECT_LT((tool.load().force - force).norm(), 1e-14);
    const double sums = -(tool.load().force.dot(tool.velocity().translation) +
                          tool.load().moment.dot(tool.velocity().rotation));
    EXPECT_NEAR(sums, power, 1e-13);
    tool.end_step();
    EXPECT_NEAR(tool.power(), power, 1e-13);
    if (step > 0)
      work = work_ahead + 0.5 * dt * power;
    EXPECT_NEAR(tool.work(), work, 1e-13);
    work_ahead = work + 0.5 * dt * power;
  }
}

TEST(Tool, gives_the_same_bits_in_every_run) {
  const auto last = [] {
    ToolMotion<3> motion;
    motion.axis = {0.0, 1.0, 0.0};
    motion.free_rotation = dem::FreeRotation{0.1, 0.0};
    motion.servo = dem::Servo<3>{{0.0, 0.0, -1.0}, 10.0, 0.1};
    auto tool = tool_with(motion);
    run<3>(tool, 500, 1e-4, [](Tool<3>& t) {
      t.add_load({0.3, 0.1, -1e4 * t.pose().reference[2]}, {0.1, 0.2, 0.3}, 1e4);
    });
    return std::pair(tool.pose().to_space({1.0, 2.0, 3.0}), tool.work());
  };
  EXPECT_EQ(last(), last());
}

// The search and the contact take place in the frame of the body; the pose brings them back.
TEST(Tool, of_facets_is_touched_where_it_has_moved_to) {
  ToolMotion<3> motion;
  motion.reference = {0.5, 0.5, 0.5};
  motion.velocity = {10.0, 0.0, 0.0};
  motion.axis = {0.0, 0.0, 1.0};
  motion.rotation_rate = 0.25 * pi; // 45 degrees at t = 1 s
  Tool<3> tool(ToolShape<3>(cases::box_surface({1.0, 1.0, 1.0})), motion);
  run<3>(tool, 1000, 1e-3);
  // The vertical edge (1, 1, z) of the box points to y now.
  const Vec<3> centre(10.5, 0.5 + std::sqrt(0.5) + 0.09, 0.4);
  std::vector<std::uint32_t> near;
  std::vector<FacetContact<3>> contacts;
  const Vec<3> body = tool.pose().to_body(centre);
  tool.shape().near(body, 0.1, near);
  tool.shape().find_contacts(body, 0.1, near, contacts);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_NEAR(contacts[0].gap, -0.01, 1e-14);
  EXPECT_EQ(contacts[0].feature.kind, FeatureKind::edge);
  EXPECT_LT((tool.pose().rotation * contacts[0].normal - Vec<3>(0.0, -1.0, 0.0)).norm(), 1e-13);
  EXPECT_LT((tool.pose().to_space(contacts[0].point) - (centre - Vec<3>(0.0, 0.09, 0.0))).norm(),
            1e-13);
  EXPECT_LT(near.size(), 12U);
}

TEST(ToolShape, of_a_plane_is_touched_from_its_free_side_however_deep) {
  const ToolShape<2> floor(Plane<2>{{0.0, 1.0}, {0.0, 5.0}});
  std::vector<std::uint32_t> near;
  std::vector<FacetContact<2>> contacts;
  floor.near({3.0, 1.2}, 0.1, near);
  EXPECT_TRUE(near.empty());
  for (const double height : {1.05, 1.0, 0.7}) {
    floor.near({3.0, height}, 0.1, near);
    floor.find_contacts({3.0, height}, 0.1, near, contacts);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].gap, height - 1.1, 1e-15);
    EXPECT_EQ(contacts[0].normal, Vec<2>(0.0, -1.0));
    EXPECT_LT((contacts[0].point - Vec<2>(3.0, 1.0)).norm(), 1e-15);
    std::uint32_t from = 7;
    floor.continue_contacts(contacts, contacts, {&from, 1});
    EXPECT_EQ(from, 0U);
    floor.continue_contacts({}, contacts, {&from, 1});
    EXPECT_EQ(from, no_contact);
  }
  EXPECT_EQ(floor.surface(), nullptr);
}

TEST(Tool, that_cannot_be_is_refused_with_a_sentence) {
  const auto sentence = [](const ToolMotion<3>& motion) -> std::string {
    try {
      tool_with(motion);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  ToolMotion<3> motion;
  EXPECT_EQ(sentence(motion), "");
  motion.axis.setZero();
  EXPECT_EQ(sentence(motion), "the length of the axis of a tool must be positive, not 0");
  motion = {};
  motion.servo = dem::Servo<3>{{0.0, 0.0, 1.0}, 10.0, 0.0};
  EXPECT_EQ(sentence(motion), "the largest velocity of a servo must be positive, not 0");
  motion.servo->max_velocity = 1.0;
  motion.free_translation = dem::FreeTranslation<3>{{true, false, true}, 1.0, Vec<3>::Zero()};
  EXPECT_EQ(sentence(motion), "a tool with a servo along z cannot be free along it");
  motion.free_translation->axes = {};
  EXPECT_EQ(sentence(motion), "a free tool needs an axis along which it is free");
  motion.free_translation->mass = -1.0;
  EXPECT_EQ(sentence(motion), "the mass of a free tool must be positive, not -1");
  motion = {};
  motion.free_rotation = dem::FreeRotation{};
  EXPECT_EQ(sentence(motion), "the moment of inertia of a free tool must be positive, not 0");
  motion = {};
  motion.reference[1] = std::nan("");
  EXPECT_EQ(sentence(motion), "the reference point of a tool must be finite");
  EXPECT_THROW(ToolShape<3>(Plane<3>{Vec<3>::Zero(), Vec<3>::Zero()}), std::invalid_argument);
  EXPECT_THROW(ToolShape<3>(Surface<3>{}), std::invalid_argument);
}

} // namespace
} // namespace kerf
