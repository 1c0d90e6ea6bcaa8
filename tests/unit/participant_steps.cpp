// A participant that runs its loop against a scripted broker, over every transport.
#include "tests/unit/mini_broker.hpp"

#include <future>
#include <gtest/gtest.h>
#include <thread>

namespace kerf::coupler {
namespace {

using namespace std::chrono_literals;

Plan two_couplings(bool needs_own_forces) {
  Plan plan;
  plan.interfaces = {{"left", {0, 1}, {5.0, 6.0}}, {"right", {3}, {}}};
  plan.needs_own_forces = needs_own_forces;
  return plan;
}

class ParticipantLoop : public testing::TestWithParam<std::tuple<const char*, bool>> {
protected:
  const char* transport() const { return std::get<0>(GetParam()); }
  bool needs_own_forces() const { return std::get<1>(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Transport, ParticipantLoop,
                         testing::Combine(testing::Values("shm", "zmq", "loopback"),
                                          testing::Bool()),
                         [](const auto& which) {
                           return std::string(std::get<0>(which.param)) +
                                  (std::get<1>(which.param) ? "_with_own_forces" : "");
                         });

constexpr std::uint64_t steps = 500;

/// Publishes numbers that name their step, interface and place.
double value(std::uint64_t step, std::size_t interface, std::size_t place, double field) {
  return static_cast<double>(1000 * step + 100 * interface + 10 * place) + field;
}

void fill(std::span<double> values, std::uint64_t step, std::size_t interface, double field) {
  for (std::size_t j = 0; j < values.size(); ++j)
    values[j] = value(step, interface, j, field);
}

std::size_t count_wrong(std::span<const double> values, std::uint64_t step, std::size_t interface,
                        double field) {
  std::size_t wrong = 0;
  for (std::size_t j = 0; j < values.size(); ++j)
    wrong += values[j] != value(step, interface, j, field);
  return wrong;
}

/// The loop of a solver. Returns the number of values that it did not expect.
std::size_t run_participant(const Participant::Invitation& invitation) {
  Participant me(invitation);
  const Plan plan = me.declare(four_points());
  const Schedule schedule = me.initialize(free_limits(plan));
  std::size_t wrong = schedule.steps != steps;
  while (me.has_next_step()) {
    const std::uint64_t n = me.step();
    wrong += me.time() != 0.5 * static_cast<double>(n);
    for (std::size_t k = 0; k < plan.interfaces.size(); ++k) {
      fill(me.position(k), n, k, 0.1);
      fill(me.velocity(k), n, k, 0.2);
    }
    me.publish_motion();
    for (std::size_t k = 0; k < plan.interfaces.size(); ++k)
      fill(me.own_forces(k), n, k, 0.3);
    me.publish_forces();
    me.receive();
    for (std::size_t k = 0; k < plan.interfaces.size(); ++k)
      wrong += count_wrong(me.interface_forces(k), n, k, 0.4);
  }
  wrong += me.step() != steps;
  wrong += me.time() != 0.5 * steps;
  me.finalize(R"({"note": "done"})");
  return wrong;
}

TEST_P(ParticipantLoop, exchanges_every_field_of_every_step) {
  MiniBroker broker;
  const Plan plan = two_couplings(needs_own_forces());
  auto wrong_there = std::async(std::launch::async, run_participant, broker.invitation());

  broker.shake_hands(plan, transport(), steps);
  EXPECT_EQ(broker.declaration.ids, four_points().ids);
  EXPECT_EQ(broker.limits.inverse_mass[0], (std::vector<double>{1, 1, 1, 1}));
  std::size_t wrong_here = 0;
  for (std::uint64_t n = 0; n < steps; ++n) {
    const auto motion = broker.receive(FrameKind::motion, n);
    const auto& layout = broker.layout;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto x = layout.values(motion, FrameKind::motion, k, Field::position);
      const auto v = layout.values(motion, FrameKind::motion, k, Field::velocity);
      wrong_here += count_wrong(x, n, k, 0.1) + count_wrong(v, n, k, 0.2);
    }
    if (plan.needs_own_forces) {
      const auto own = broker.receive(FrameKind::own_forces, n);
      for (std::size_t k = 0; k < 2; ++k) {
        const auto f = layout.values(own, FrameKind::own_forces, k, Field::force);
        wrong_here += count_wrong(f, n, k, 0.3);
      }
    }
    const auto forces = broker.outgoing(n);
    for (std::size_t k = 0; k < 2; ++k)
      fill(layout.values(forces, FrameKind::interface_forces, k, Field::force), n, k, 0.4);
    broker.send();
  }
  const auto finished = broker.await<Finished>(message::finished);
  broker.say_goodbye();
  EXPECT_EQ(wrong_there.get(), 0u);
  EXPECT_EQ(wrong_here, 0u);
  EXPECT_EQ(finished.steps, steps);
  EXPECT_EQ(finished.summary, R"({"note":"done"})");
  EXPECT_GE(finished.compute_seconds, 0.0);
  EXPECT_GT(finished.waiting_seconds, 0.0);
}

TEST_P(ParticipantLoop, reports_progress_while_it_waits) {
  MiniBroker broker;
  auto ended = std::async(std::launch::async, run_participant, broker.invitation());
  broker.shake_hands(two_couplings(needs_own_forces()), transport(), steps);
  broker.receive(FrameKind::motion, 0);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(broker.await<Progress>(message::progress).step, 0u);
  broker.say(Stop{"the test has seen enough"});
  EXPECT_THROW(ended.get(), RunStopped);
}

TEST_P(ParticipantLoop, refuses_a_frame_of_another_step) {
  MiniBroker broker;
  auto ended = std::async(std::launch::async, run_participant, broker.invitation());
  broker.shake_hands(two_couplings(needs_own_forces()), transport(), steps);
  broker.outgoing(7);
  broker.send();
  EXPECT_THROW(ended.get(), ProtocolError);
}

TEST(Participant, without_interfaces_runs_freely_and_reports_its_progress) {
  MiniBroker broker;
  auto ended = std::async(std::launch::async, [&] {
    Participant me(broker.invitation());
    me.declare(four_points());
    me.initialize({});
    while (me.has_next_step()) {
      me.publish_motion();
      me.publish_forces();
      me.receive();
      std::this_thread::sleep_for(10ms);
    }
    me.finalize();
  });
  broker.shake_hands({}, "shm", 50);
  EXPECT_EQ(broker.await<Finished>(message::finished).steps, 50u);
  EXPECT_GE(broker.progress_reports, 2);
  EXPECT_LE(broker.progress_reports, 50);
  broker.say_goodbye();
  EXPECT_NO_THROW(ended.get());
}

TEST(Participant, may_be_asked_for_no_step_at_all) {
  MiniBroker broker;
  auto ended = std::async(std::launch::async, [&] {
    Participant me(broker.invitation());
    const Plan plan = me.declare(four_points());
    me.initialize(free_limits(plan));
    EXPECT_FALSE(me.has_next_step());
    me.finalize();
  });
  broker.shake_hands(two_couplings(false), "shm", 0);
  EXPECT_EQ(broker.await<Finished>(message::finished).steps, 0u);
  broker.say_goodbye();
  EXPECT_NO_THROW(ended.get());
}

TEST(Participant, is_told_when_it_calls_out_of_turn) {
  MiniBroker broker;
  auto ended = std::async(std::launch::async, [&] {
    Participant me(broker.invitation());
    EXPECT_THROW(me.initialize({}), std::logic_error);
    Declaration bad = four_points();
    bad.positions.pop_back();
    EXPECT_THROW(me.declare(bad), std::invalid_argument);
    const Plan plan = me.declare(four_points());
    EXPECT_THROW(me.initialize({}), std::invalid_argument);
    me.initialize(free_limits(plan));
    EXPECT_THROW(me.publish_motion(), std::logic_error);
    EXPECT_TRUE(me.has_next_step());
    EXPECT_THROW(me.receive(), std::logic_error);
    EXPECT_THROW(me.own_forces(0), std::logic_error);
    EXPECT_THROW(me.has_next_step(), std::logic_error);
    EXPECT_THROW(me.position(2), std::out_of_range);
    me.publish_motion();
    EXPECT_THROW(me.position(0), std::logic_error);
    EXPECT_THROW(me.finalize(), std::logic_error);
    me.fail(ErrorKind::failed, "", "the test is over");
  });
  broker.shake_hands(two_couplings(true), "shm", 5);
  EXPECT_EQ(broker.await<ErrorReport>(message::error).sentence, "the test is over");
  EXPECT_NO_THROW(ended.get());
}

} // namespace
} // namespace kerf::coupler
