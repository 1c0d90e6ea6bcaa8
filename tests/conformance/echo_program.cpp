// The example participant as a process of its own, as a launcher starts it.
#include "tests/unit/mini_broker.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

namespace kerf::coupler {
namespace {

/// Starts kerf-echo with the descriptors and variables of an invitation.
pid_t start_echo(const Participant::Invitation& invitation) {
  const pid_t child = fork();
  if (child != 0)
    return child;
  setenv("KERF_BROKER", invitation.endpoint.c_str(), 1);
  setenv("KERF_PARTICIPANT", invitation.name.c_str(), 1);
  setenv("KERF_TOKEN", invitation.token.c_str(), 1);
  setenv("KERF_SEGMENT", std::to_string(invitation.segment).c_str(), 1);
  setenv("KERF_LIFELINE", std::to_string(invitation.lifeline).c_str(), 1);
  fcntl(invitation.segment, F_SETFD, 0);
  fcntl(invitation.lifeline, F_SETFD, 0);
  execl(KERF_ECHO_PROGRAM, "kerf-echo", "--points", "4", nullptr);
  _exit(127);
}

// Under a constant force central differences from rest are exact: x^n = x^0 + f t^2 / (2 m). All
// numbers here are sums of few powers of two, so the comparison is exact as well.
TEST(EchoProgram, moves_a_free_mass_as_newton_says_and_ends_with_its_broker) {
  int pipe_ends[2];
  ASSERT_EQ(pipe2(pipe_ends, O_CLOEXEC), 0);
  MiniBroker broker;
  auto invitation = broker.invitation();
  invitation.lifeline = pipe_ends[0];
  const pid_t child = start_echo(invitation);

  Plan plan;
  plan.interfaces = {{"joint", {0, 2}, {}}};
  plan.needs_own_forces = true;
  constexpr std::uint64_t steps = 8; // of 0.5 s
  broker.shake_hands(plan, "shm", steps);
  EXPECT_EQ(broker.declaration.num_points(), 4u);
  EXPECT_EQ(broker.declaration.dimension, 2); // the case says so
  for (std::uint64_t n = 0; n < steps; ++n) {
    const auto motion = broker.receive(FrameKind::motion, n);
    const auto x = broker.layout.values(motion, FrameKind::motion, 0, Field::position);
    const double t = 0.5 * static_cast<double>(n);
    EXPECT_EQ(x[1], t * t); // m = 1 kg, f = 2 N in y
    EXPECT_EQ(x[3], 0.0);
    const auto own = broker.receive(FrameKind::own_forces, n);
    for (const double f : broker.layout.values(own, FrameKind::own_forces, 0, Field::force))
      EXPECT_EQ(f, 0.0);
    const auto frame = broker.outgoing(n);
    const auto f = broker.layout.values(frame, FrameKind::interface_forces, 0, Field::force);
    for (std::size_t j = 0; j < f.size(); ++j)
      f[j] = j == 1 ? 2.0 : 0.0;
    broker.send();
  }
  EXPECT_EQ(broker.await<Finished>(message::finished).steps, steps);

  close(pipe_ends[1]); // instead of a goodbye
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
  close(pipe_ends[0]);
}

} // namespace
} // namespace kerf::coupler
