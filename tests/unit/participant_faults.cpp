// How a participant ends when it is refused or stopped, or when its broker is gone.
#include "coupler/participant/lifeline.hpp"
#include "tests/unit/mini_broker.hpp"

#include <future>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <zmq.hpp>

namespace kerf::coupler {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

Plan one_coupling() {
  Plan plan;
  plan.interfaces = {{"joint", {0, 1}, {}}};
  return plan;
}

/// Runs until it is stopped; returns the sentence.
std::string reason_of_stop(const Participant::Invitation& invitation) {
  try {
    Participant me(invitation);
    const Plan plan = me.declare(four_points());
    me.initialize(free_limits(plan));
    while (me.has_next_step()) {
      me.publish_motion();
      me.publish_forces();
      me.receive();
    }
    me.finalize();
    return "";
  } catch (const RunStopped& stop) {
    return stop.what();
  }
}

std::future<std::string> start(const Participant::Invitation& invitation) {
  return std::async(std::launch::async, reason_of_stop, invitation);
}

TEST(Refusal, of_a_wrong_token_reaches_the_participant_with_its_reason) {
  MiniBroker broker;
  auto invitation = broker.invitation();
  invitation.token = "guessed";
  auto reason = start(invitation);
  EXPECT_EQ(broker.await<Hello>(message::hello).token, "guessed");
  broker.say(Stop{"the token is not the one of this run"});
  EXPECT_EQ(reason.get(), "the token is not the one of this run");
}

TEST(Refusal, of_another_version_is_sent_by_the_server_itself) {
  MiniBroker broker;
  zmq::context_t context;
  zmq::socket_t old(context, zmq::socket_type::dealer);
  old.set(zmq::sockopt::linger, 0);
  old.connect(broker.control.endpoint());
  std::string header = encode(to_message(Hello{}))[0];
  header.replace(header.find(R"("kerf":1)"), 8, R"("kerf":0)");
  old.send(zmq::message_t(header), zmq::send_flags::none);
  EXPECT_THROW(broker.control.receive(5s), ProtocolError);
  zmq::message_t answer;
  ASSERT_TRUE(old.recv(answer));
  const std::string reason = from_message<Stop>(decode({answer.to_string()})).reason;
  EXPECT_NE(reason.find("version 0"), std::string::npos) << reason;
}

TEST(Refusal, during_the_handshake_ends_the_participant) {
  MiniBroker broker;
  auto reason = start(broker.invitation());
  broker.await<Hello>(message::hello);
  broker.say(Stop{"there is no participant \"rock\" in this case"});
  EXPECT_EQ(reason.get(), "there is no participant \"rock\" in this case");
}

TEST(Refusal, is_the_answer_when_no_broker_is_there) {
  const auto start_time = Clock::now();
  const std::string reason = reason_of_stop(
      {.endpoint = "ipc://@kerf-test-nobody", .name = "rock", .token = "", .join_limit = 200ms});
  EXPECT_EQ(reason, "no broker answered at ipc://@kerf-test-nobody within 0.2 s");
  EXPECT_LT(Clock::now() - start_time, 5s);
}

TEST(Refusal, of_other_frames_than_the_participant_has) {
  MiniBroker broker;
  auto ended = std::async(std::launch::async, [&] { return reason_of_stop(broker.invitation()); });
  broker.welcome();
  const auto declaration = broker.await<Declaration>(message::declaration);
  broker.say(one_coupling());
  broker.await<Limits>(message::limits);
  Schedule schedule{.time_step = 1, .steps = 1, .layout = 1};
  schedule.channel = {.transport = "loopback", .up_capacity = 1000, .down_capacity = 1000};
  broker.say(schedule);
  EXPECT_THROW(ended.get(), ProtocolError);
}

class Stopped : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Transport, Stopped, testing::Values("shm", "zmq", "loopback"),
                         [](const auto& which) { return std::string(which.param); });

TEST_P(Stopped, participant_ends_a_wait_within_a_second) {
  MiniBroker broker;
  auto reason = start(broker.invitation());
  broker.shake_hands(one_coupling(), GetParam(), 10);
  std::this_thread::sleep_for(100ms); // now it waits for forces
  const auto start_time = Clock::now();
  broker.say(Stop{"\"far\" was killed by signal 9 at step 0"});
  EXPECT_EQ(reason.get(), "\"far\" was killed by signal 9 at step 0");
  EXPECT_LT(Clock::now() - start_time, 1s);
}

TEST_P(Stopped, participant_ends_within_a_second_of_its_lifeline) {
  int lifeline[2];
  ASSERT_EQ(pipe(lifeline), 0);
  MiniBroker broker;
  auto invitation = broker.invitation();
  invitation.lifeline = lifeline[0];
  auto reason = start(invitation);
  broker.shake_hands(one_coupling(), GetParam(), 10);
  broker.receive(FrameKind::motion, 0);
  broker.outgoing(0);
  broker.send();
  broker.receive(FrameKind::motion, 1);
  const auto start_time = Clock::now();
  close(lifeline[1]);
  EXPECT_EQ(reason.get(),
            fmt::format("the broker (pid {}) is gone at step 1; this participant stops", getpid()));
  EXPECT_LT(Clock::now() - start_time, 1s);
  close(lifeline[0]);
}

TEST(Lifeline, may_be_cut_during_the_handshake_or_while_others_finish) {
  for (const bool at_the_end : {false, true}) {
    int lifeline[2];
    ASSERT_EQ(pipe(lifeline), 0);
    MiniBroker broker;
    auto invitation = broker.invitation();
    invitation.lifeline = lifeline[0];
    auto reason = start(invitation);
    if (at_the_end) {
      broker.shake_hands({}, "", 3);
      broker.await<Finished>(message::finished);
    } else {
      broker.welcome();
    }
    close(lifeline[1]);
    EXPECT_NE(reason.get().find("is gone"), std::string::npos);
    close(lifeline[0]);
  }
}

TEST(Lifeline, is_not_needed_to_notice_that_the_broker_has_closed_the_connection) {
  auto broker = std::make_unique<MiniBroker>();
  auto reason = start(broker->invitation());
  broker->shake_hands(one_coupling(), "loopback", 10);
  broker->receive(FrameKind::motion, 0);
  const auto start_time = Clock::now();
  broker.reset();
  EXPECT_NE(reason.get().find("is gone at step 0"), std::string::npos);
  EXPECT_LT(Clock::now() - start_time, 1s);
}

// A solver that is busy for long does not look; the watcher then ends the process itself.
TEST(Lifeline, ends_a_process_that_does_not_look) {
  int lifeline[2], log[2];
  ASSERT_EQ(pipe(lifeline), 0);
  ASSERT_EQ(pipe(log), 0);
  const pid_t child = fork();
  if (child == 0) {
    close(lifeline[1]);
    dup2(log[1], STDERR_FILENO);
    Lifeline line(lifeline[0]);
    line.set_broker(4242);
    line.set_step(17);
    for (;;)
      pause();
  }
  close(log[1]);
  std::this_thread::sleep_for(50ms);
  const auto start_time = Clock::now();
  close(lifeline[1]);
  int status = 0;
  waitpid(child, &status, 0);
#ifdef __SANITIZE_THREAD__
  EXPECT_LT(Clock::now() - start_time, 3s); // the sanitizer itself sleeps 1 s at every exit
#else
  EXPECT_LT(Clock::now() - start_time, 1s);
#endif
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
  std::string text(200, '\0');
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(log[0], text.data(), 200))));
  EXPECT_EQ(text, "the broker (pid 4242) is gone at step 17; this participant stops\n");
  close(log[0]);
  close(lifeline[0]);
}

TEST(Lifeline, that_holds_lets_its_watcher_go) {
  int lifeline[2];
  ASSERT_EQ(pipe(lifeline), 0);
  for (int i = 0; i < 100; ++i) {
    Lifeline line(lifeline[0]);
    EXPECT_FALSE(line.cut());
  }
  close(lifeline[0]);
  close(lifeline[1]);
}

TEST(Join, needs_the_address_of_a_broker) {
  unsetenv("KERF_BROKER");
  EXPECT_THROW(Participant::join("test"), std::invalid_argument);
  setenv("KERF_BROKER", "ipc://@kerf-test-nobody", 1);
  setenv("KERF_SEGMENT", "three", 1);
  EXPECT_THROW(Participant::join("test"), std::invalid_argument);
  unsetenv("KERF_SEGMENT");
  unsetenv("KERF_BROKER");
}

} // namespace
} // namespace kerf::coupler
