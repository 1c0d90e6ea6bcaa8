// A broker for tests of the participant library: it does what the test says, step by step.
#pragma once

#include "coupler/channel/control.hpp"
#include "coupler/channel/frame_layout.hpp"
#include "coupler/participant/participant.hpp"

#include <fmt/format.h>
#include <stdexcept>
#include <string>
#include <unistd.h>

namespace kerf::coupler {

class MiniBroker {
public:
  MiniBroker() : control(fmt::format("ipc://@kerf-test-broker-{}-{}", getpid(), ++count())) {}
  ~MiniBroker() {
    if (segment >= 0)
      close(segment);
  }
  MiniBroker(const MiniBroker&) = delete;
  MiniBroker& operator=(const MiniBroker&) = delete;

  Participant::Invitation invitation() const {
    return {.endpoint = control.endpoint(),
            .name = "rock",
            .token = "secret",
            .segment = segment,
            .program = "test 1"};
  }

  /// The next message of a type; reports of progress before it are counted.
  template <class Body> Body await(const char* type) {
    for (;;) {
      const auto incoming = control.receive(std::chrono::seconds(10));
      if (!incoming)
        throw std::runtime_error(fmt::format("no {} came", type));
      peer = incoming->peer;
      if (incoming->message.type == message::progress && std::string(type) != message::progress) {
        ++progress_reports;
        continue;
      }
      return from_message<Body>(incoming->message);
    }
  }

  template <class Body> void say(const Body& body) { control.send(peer, to_message(body)); }
  void say_goodbye() { control.send(peer, {message::goodbye, "{}", {}}); }

  Hello welcome() {
    Hello hello = await<Hello>(message::hello);
    say(Assignment{hello.name, R"({"kind": "echo"})", R"({"dimension": 2})", "/nowhere", false,
                   getpid()});
    return hello;
  }

  /// The handshake with a participant of which these interfaces are coupled.
  void shake_hands(const Plan& plan, const std::string& transport, std::uint64_t steps) {
    welcome();
    declaration = await<Declaration>(message::declaration);
    say(plan);
    limits = await<Limits>(message::limits);
    layout = FrameLayout(declaration.dimension, declaration.ids, plan.interfaces);
    Schedule schedule{.time_step = 0.5, .steps = steps};
    if (!plan.interfaces.empty()) {
      schedule.layout = layout.checksum();
      schedule.channel = {.transport = transport,
                          .descriptor = segment,
                          .up_capacity = layout.up_capacity(),
                          .down_capacity = layout.down_capacity()};
      channel = open_broker_end(schedule.channel);
    }
    say(schedule);
  }

  std::span<const std::byte> receive(FrameKind kind, std::uint64_t step) {
    const auto frame = channel->receive({.limit = std::chrono::seconds(10), .idle = {}});
    check_frame(frame, kind, step, layout);
    return frame;
  }

  std::span<std::byte> outgoing(std::uint64_t step) {
    const auto frame = channel->outgoing({.limit = std::chrono::seconds(10), .idle = {}});
    layout.write_header(frame, FrameKind::interface_forces, step);
    return frame;
  }
  void send() { channel->send(layout.bytes(FrameKind::interface_forces)); }

  ControlServer control;
  int segment = create_segment();
  std::string peer;
  int progress_reports = 0;
  Declaration declaration;
  Limits limits;
  FrameLayout layout;
  std::unique_ptr<Channel> channel;

private:
  static int& count() {
    static int brokers = 0;
    return brokers;
  }
};

/// Four points on a line in the plane.
inline Declaration four_points() {
  Declaration d;
  d.dimension = 2;
  d.ids = {10, 11, 12, 13};
  d.positions = {0, 0, 1, 0, 2, 0, 3, 0};
  return d;
}

/// Limits of unit masses without stiffness.
inline Limits free_limits(const Plan& plan) {
  Limits limits;
  for (const Interface& interface : plan.interfaces) {
    limits.inverse_mass.emplace_back(interface.points.size() * 2, 1.0);
    limits.omega2.emplace_back(interface.points.size(), 0.0);
  }
  return limits;
}

} // namespace kerf::coupler
