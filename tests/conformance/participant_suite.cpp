// What every participant has to keep, whatever it computes (docs/protocol.md). Each test starts
// the real program and plays the broker; each runs over both transports.
#include "tests/conformance/scripted_broker.hpp"
#include "tests/conformance/solvers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <random>
#include <set>

namespace kerf::coupler {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t steps = 20;
constexpr double force_scale = 10.0; // N; strains stay far below one

class EveryParticipant : public testing::TestWithParam<std::tuple<Solver, std::string>> {
protected:
  const Solver& solver() const { return std::get<0>(GetParam()); }
  std::size_t dim() const { return static_cast<std::size_t>(solver().dimension); }

  std::unique_ptr<ScriptedBroker> start(const std::vector<std::string>& overrides = {}) const {
    const auto [settings, case_settings] = settings_of(solver(), overrides);
    return std::make_unique<ScriptedBroker>(solver().command, settings, case_settings,
                                            std::get<1>(GetParam()));
  }
};

/// "kerf_dem_shm"
std::string name_of(const testing::TestParamInfo<EveryParticipant::ParamType>& which) {
  std::string name = std::get<0>(which.param).name + '_' + std::get<1>(which.param);
  std::ranges::replace(name, '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Participant, EveryParticipant,
                         testing::Combine(testing::Values(echo, dem, fem),
                                          testing::Values<std::string>("shm", "zmq")),
                         name_of);

/// Every n-th point.
std::vector<std::uint32_t> every(std::uint32_t n, std::size_t num_points) {
  std::vector<std::uint32_t> points;
  for (std::uint32_t i = 0; i < num_points; i += n)
    points.push_back(i);
  return points;
}

/// Two couplings that share points, and a blending that differs from point to point.
Plan two_couplings(std::size_t num_points) {
  Plan plan;
  for (std::size_t i = 0; i < num_points; ++i)
    plan.weights.push_back(0.3 + 0.7 * static_cast<double>(i) / static_cast<double>(num_points));
  plan.interfaces = {{"joint", every(2, num_points), {}}, {"other", every(3, num_points), {}}};
  return plan;
}

/// One coupling of all points.
Plan whole_body(std::size_t num_points) {
  Plan plan = two_couplings(num_points);
  plan.interfaces = {{"joint", every(1, num_points), {}}};
  return plan;
}

/// Forces without any order, other ones at every step.
Rows random_forces(std::size_t size, std::uint64_t step) {
  std::mt19937_64 generator(step);
  std::uniform_real_distribution<double> uniform(-force_scale, force_scale); // N
  Rows forces(size);
  for (double& f : forces)
    f = uniform(generator);
  return forces;
}

/// What a handful of roundings of these terms can come to.
double round_off(std::initializer_list<double> terms) {
  double sum = 0.0;
  for (const double term : terms)
    sum += std::abs(term);
  return 8.0 * std::numeric_limits<double>::epsilon() * sum;
}

/// A process that fails in order: soon, with an exit code, and with a sentence in its output.
void expect_end(ChildProcess& child, const std::string& sentence) {
  const auto code = child.end_within(1s);
  ASSERT_TRUE(code) << "it goes on";
  EXPECT_GT(*code, 0);
  EXPECT_NE(child.output().find(sentence), std::string::npos) << child.output();
}

// --- the handshake ------------------------------------------------------------------------------

TEST_P(EveryParticipant, says_hello_with_its_name_its_token_its_pid_and_the_version) {
  const auto broker = start();
  const auto hello = broker->await<Hello>(message::hello);
  EXPECT_EQ(hello.protocol, protocol_version);
  EXPECT_EQ(hello.name, "body");
  EXPECT_EQ(hello.token, "0123456789abcdef");
  EXPECT_EQ(hello.pid, broker->child.pid());
  EXPECT_TRUE(hello.program.starts_with(solver().name)) << hello.program;
}

TEST_P(EveryParticipant, that_is_refused_ends_with_the_reason_in_its_output) {
  const auto broker = start();
  broker->await<Hello>(message::hello);
  broker->say(Stop{"participant \"body\" is connected already (pid 4242)"});
  expect_end(broker->child, "participant \"body\" is connected already (pid 4242)");
}

TEST_P(EveryParticipant, declares_points_with_unique_ids_and_what_particles_or_meshes_have) {
  const auto broker = start();
  const Declaration& d = broker->welcome();
  EXPECT_EQ(d.dimension, solver().dimension);
  ASSERT_EQ(d.num_points(), solver().points);
  EXPECT_EQ(std::set(d.ids.begin(), d.ids.end()).size(), d.num_points());
  EXPECT_EQ(d.positions.size(), d.num_points() * dim());
  EXPECT_GE(d.memory_estimate, 0.0);
  ASSERT_EQ(d.nodes_per_element, solver().nodes_per_element);
  const auto positive = [](double value) { return value > 0.0; };
  if (d.nodes_per_element == 0) {
    EXPECT_EQ(d.radii.size(), d.num_points());
    EXPECT_TRUE(std::ranges::all_of(d.radii, positive));
    EXPECT_EQ(d.stiffness.size(), d.num_points());
    EXPECT_TRUE(std::ranges::all_of(d.stiffness, positive));
    return;
  }
  const auto nodes = static_cast<std::size_t>(d.nodes_per_element);
  ASSERT_FALSE(d.elements.empty());
  ASSERT_EQ(d.elements.size() % nodes, 0u);
  for (const std::uint32_t node : d.elements)
    ASSERT_LT(node, d.num_points());
  ASSERT_FALSE(d.boundary.empty());
  const auto nodes_of_face = static_cast<std::size_t>(d.nodes_per_face());
  for (const auto& [tag, faces] : d.boundary) {
    EXPECT_FALSE(faces.empty()) << tag;
    ASSERT_EQ(faces.size() % nodes_of_face, 0u) << tag;
    for (auto face = faces.begin(); face != faces.end(); face += nodes_of_face) {
      int elements = 0; // that have all nodes of the face: one, or it lies inside
      for (auto element = d.elements.begin(); element != d.elements.end(); element += nodes)
        elements += std::all_of(face, face + nodes_of_face, [&](std::uint32_t node) {
          return std::find(element, element + nodes, node) != element + nodes;
        });
      EXPECT_EQ(elements, 1) << tag << ", face " << (face - faces.begin()) / nodes_of_face;
    }
  }
}

TEST_P(EveryParticipant, answers_limits_of_the_points_of_its_interfaces) {
  const auto broker = start();
  const Plan plan = two_couplings(broker->welcome().num_points());
  const Limits& limits = broker->propose(plan);
  ASSERT_EQ(fault_in(limits, plan, solver().dimension),
            ""); // sizes, finite numbers, nothing below zero
  EXPECT_EQ(limits.largest_omega2 > 0.0, solver().is_elastic);
  EXPECT_FALSE(limits.limited_by.empty());
  for (std::size_t i = 0; i < plan.interfaces.size(); ++i) {
    EXPECT_TRUE(std::ranges::all_of(limits.inverse_mass[i], [](double m) { return m > 0.0; }));
    EXPECT_LE(*std::ranges::max_element(limits.omega2[i]), limits.largest_omega2);
  }
}

// Shares of one half are exact in binary; the integration over an element rounds a few times.
TEST_P(EveryParticipant, is_half_as_heavy_under_a_weight_of_one_half) {
  Rows inverse_mass[2];
  for (const bool half : {false, true}) {
    const auto broker = start();
    Plan plan = whole_body(broker->welcome().num_points());
    plan.weights.assign(half ? solver().points : 0, 0.5); // none: one everywhere
    broker->propose(plan);
    inverse_mass[half] = broker->inverse_masses();
  }
  ASSERT_EQ(inverse_mass[0].size(), dim() * solver().points);
  ASSERT_EQ(inverse_mass[1].size(), dim() * solver().points);
  for (std::size_t j = 0; j < inverse_mass[0].size(); ++j)
    EXPECT_DOUBLE_EQ(inverse_mass[1][j], (solver().blends ? 2.0 : 1.0) * inverse_mass[0][j]);
}

TEST_P(EveryParticipant, finishes_a_plan_without_steps_and_writes_nothing) {
  const auto broker = start();
  broker->propose(two_couplings(broker->welcome(true).num_points()));
  broker->schedule(0);
  EXPECT_EQ(broker->await<Finished>(message::finished).steps, 0u);
  broker->say_goodbye();
  EXPECT_EQ(broker->child.end_within(1s), 0) << broker->child.output();
  EXPECT_TRUE(std::filesystem::is_empty(broker->run_folder));
}

// --- the steps ----------------------------------------------------------------------------------

TEST_P(EveryParticipant, sends_the_right_frame_at_every_step) {
  for (const bool needs_own_forces : {false, true}) {
    const auto broker = start();
    Plan plan = two_couplings(broker->welcome().num_points());
    plan.needs_own_forces = needs_own_forces;
    broker->propose(plan);
    broker->schedule(steps);
    for (std::uint64_t n = 0; n < steps; ++n) { // kind, step, layout and length are checked
      ASSERT_NO_THROW(broker->motion(n)) << "step " << n;
      if (needs_own_forces) {
        ASSERT_NO_THROW(broker->own_forces(n)) << "step " << n;
      }
      broker->give(n, Rows(broker->size(), 0.0));
    }
    EXPECT_EQ(broker->await<Finished>(message::finished).steps, steps);
  }
}

// Central differences, Rojek (2008) eqs 3-5: v^(n+1/2) = v^(n-1/2) + dt a and
// x^(n+1) = x^n + dt v^(n+1/2), where a is all that was sent and received over the mass that the
// limits gave. The first step starts from v^0 and makes half a step of it.
TEST_P(EveryParticipant, moves_as_the_forces_say_that_it_sends_and_receives) {
  const auto broker = start(solver().damps);
  Plan plan = two_couplings(broker->welcome().num_points());
  plan.needs_own_forces = true;
  broker->propose(plan);
  broker->schedule(steps);
  const Rows inverse_mass = broker->inverse_masses();
  const std::vector<std::size_t> component = broker->components();
  const double dt = broker->time_step;
  ScriptedBroker::Motion before;
  Rows own, received(broker->declaration.positions.size()); // of the step before
  double largest_own = 0.0;
  for (std::uint64_t n = 0; n < steps; ++n) {
    const auto [x, v] = broker->motion(n);
    for (std::size_t j = 0; j < x.size(); ++j) {
      if (n == 0) {
        EXPECT_EQ(x[j], broker->declaration.positions[component[j]]);
        continue;
      }
      const double v_before = before.velocity[j], x_before = before.position[j];
      const double pace = (n == 1 ? 0.5 : 1.0) * dt * inverse_mass[j]; // s/kg
      const double from_own = pace * own[j], from_others = pace * received[component[j]];
      ASSERT_NEAR(v[j], v_before + from_own + from_others,
                  round_off({v[j], v_before, from_own, from_others}))
          << "value " << j << " at step " << n;
      ASSERT_NEAR(x[j], x_before + dt * v[j], round_off({x[j], x_before}))
          << "value " << j << " at step " << n;
    }
    before = {x, v};
    own = broker->own_forces(n);
    for (const double f : own)
      largest_own = std::max(largest_own, std::abs(f));
    const Rows forces = random_forces(broker->size(), n);
    received.assign(received.size(), 0.0);
    for (std::size_t j = 0; j < forces.size(); ++j) // a point of both couplings gets both
      received[component[j]] += forces[j];
    broker->give(n, forces);
  }
  EXPECT_EQ(largest_own > 1e-3 * force_scale, solver().is_elastic); // or nothing was compared
}

// Newton's third law: what acts inside a body cancels, under any blending.
TEST_P(EveryParticipant, gains_exactly_the_momentum_of_the_forces_that_it_receives) {
  const auto broker = start();
  broker->propose(whole_body(broker->welcome().num_points()));
  broker->schedule(steps);
  const Rows inverse_mass = broker->inverse_masses();
  Rows expected, momentum(dim()); // N s
  double scale = 0.0;
  for (std::uint64_t n = 0; n < steps; ++n) {
    const Rows v = broker->motion(n).velocity;
    std::ranges::fill(momentum, 0.0);
    for (std::size_t j = 0; j < v.size(); ++j) {
      momentum[j % dim()] += v[j] / inverse_mass[j];
      scale += std::abs(v[j] / inverse_mass[j]); // every step rounds every velocity
    }
    if (n == 0)
      expected = momentum;
    for (std::size_t a = 0; a < dim(); ++a)
      EXPECT_NEAR(momentum[a], expected[a], round_off({scale})) << "step " << n;
    const Rows forces = random_forces(broker->size(), n);
    for (std::size_t j = 0; j < forces.size(); ++j)
      expected[j % dim()] += (n == 0 ? 0.5 : 1.0) * broker->time_step * forces[j];
    broker->give(n, forces);
  }
}

// --- the end ------------------------------------------------------------------------------------

TEST_P(EveryParticipant, reports_its_steps_and_ends_with_code_0_after_goodbye) {
  const auto broker = start();
  broker->propose(whole_body(broker->welcome().num_points()));
  broker->schedule(steps);
  for (std::uint64_t n = 0; n < steps; ++n) {
    broker->motion(n);
    broker->give(n, Rows(broker->size(), 0.0));
  }
  const auto finished = broker->await<Finished>(message::finished);
  EXPECT_EQ(finished.steps, steps);
  EXPECT_GE(finished.compute_seconds, 0.0);
  EXPECT_GE(finished.exchange_seconds, 0.0);
  EXPECT_GE(finished.waiting_seconds, 0.0);
  EXPECT_TRUE(nlohmann::json::parse(finished.summary).is_object());
  EXPECT_FALSE(broker->child.end_within(50ms)) << "it waits for the others";
  broker->say_goodbye();
  EXPECT_EQ(broker->child.end_within(1s), 0) << broker->child.output();
}

/// In step 3, waiting for forces that do not come.
void bring_to_step_3(ScriptedBroker& broker) {
  broker.propose(whole_body(broker.welcome().num_points()));
  broker.schedule(steps);
  for (std::uint64_t n = 0; n < 3; ++n) {
    broker.motion(n);
    broker.give(n, Rows(broker.size(), 0.0));
  }
  broker.motion(3);
}

TEST_P(EveryParticipant, that_is_stopped_ends_within_a_second_and_says_why) {
  const auto broker = start();
  bring_to_step_3(*broker);
  broker->say(Stop{"participant \"far\" was killed by signal 9 at step 3"});
  expect_end(broker->child, "participant \"far\" was killed by signal 9 at step 3");
}

TEST_P(EveryParticipant, ends_within_a_second_of_its_lifeline_and_says_why) {
  const auto broker = start();
  bring_to_step_3(*broker);
  broker->child.cut_lifeline();
  expect_end(broker->child, fmt::format("the broker (pid {}) is gone at step 3", getpid()));
}

} // namespace
} // namespace kerf::coupler
