// A broker that does what a test says, with a real program as its only participant.
#pragma once

#include "coupler/channel/control.hpp"
#include "coupler/channel/frame_layout.hpp"
#include "tests/conformance/child_process.hpp"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace kerf::coupler {

using Rows = std::vector<double>; // [points][dimension], the interfaces one after the other

/// A folder that is gone at the end of its test.
class ScratchFolder {
public:
  ScratchFolder() {
    std::string path = std::filesystem::temp_directory_path() / "kerf-conformance-XXXXXX";
    if (mkdtemp(path.data()) == nullptr)
      throw std::system_error(errno, std::generic_category(), path);
    path_ = path;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

private:
  std::filesystem::path path_;
};

/// The other side of the protocol, call by call; every wait ends with the participant, or after
/// 10 s. It throws when the participant breaks the protocol, so that the test fails.
class ScriptedBroker {
public:
  /// @param arguments      the program first
  /// @param settings       of the participant, JSON
  /// @param case_settings  JSON
  ScriptedBroker(const std::vector<std::string>& arguments, std::string settings,
                 std::string case_settings, std::string transport)
      : settings_(std::move(settings)), case_settings_(std::move(case_settings)),
        transport_(std::move(transport)),
        control_(fmt::format("ipc://@kerf-conformance-{}-{}", getpid(), ++count())),
        segment_(transport_ == "shm" ? create_segment() : -1),
        child(arguments,
              {{"KERF_BROKER", control_.endpoint()},
               {"KERF_PARTICIPANT", "body"},
               {"KERF_TOKEN", "0123456789abcdef"}},
              segment_, folder_ / "participant.log") {
    std::filesystem::create_directory(run_folder);
  }
  ~ScriptedBroker() {
    if (segment_ >= 0)
      close(segment_);
  }
  ScriptedBroker(const ScriptedBroker&) = delete;
  ScriptedBroker& operator=(const ScriptedBroker&) = delete;

  // --- the handshake ---

  /// The next message, which must be of this type; reports of progress before it are left out.
  template <class Body> Body await(const char* type) {
    for (const auto deadline = Clock::now() + limit;;) {
      const auto incoming = control_.receive(std::chrono::milliseconds(50));
      if (!incoming) {
        give_up_without_participant();
        if (Clock::now() > deadline)
          throw std::runtime_error(fmt::format("no {} came", type));
        continue;
      }
      peer_ = incoming->peer;
      if (incoming->message.type == message::error)
        throw std::runtime_error(from_message<ErrorReport>(incoming->message).sentence);
      if (incoming->message.type != message::progress)
        return from_message<Body>(incoming->message);
    }
  }
  template <class Body> void say(const Body& body) { control_.send(peer_, to_message(body)); }
  void say_goodbye() { control_.send(peer_, {message::goodbye, "{}", {}}); }

  const Declaration& welcome(bool plan_only = false) {
    const auto hello = await<Hello>(message::hello);
    say(Assignment{hello.name, settings_, case_settings_, run_folder, plan_only, getpid()});
    return declaration = await<Declaration>(message::declaration);
  }

  const Limits& propose(const Plan& a_plan) {
    plan = a_plan;
    say(plan);
    return limits = await<Limits>(message::limits);
  }

  /// Half of the critical step of the participant alone: only forces in time act beside its own.
  void schedule(std::uint64_t steps) {
    layout = FrameLayout(declaration.dimension, declaration.ids, plan.interfaces);
    time_step = limits.largest_omega2 > 0.0 ? 1.0 / std::sqrt(limits.largest_omega2) : 1e-3;
    Schedule schedule{.time_step = time_step, .steps = steps};
    if (steps > 0) {
      schedule.layout = layout.checksum();
      schedule.channel = {.transport = transport_,
                          .descriptor = segment_,
                          .up_capacity = layout.up_capacity(),
                          .down_capacity = layout.down_capacity()};
      channel_ = open_broker_end(schedule.channel);
    }
    say(schedule);
  }

  // --- the steps ---

  struct Motion {
    Rows position, velocity; // x^n, m; v^(n-1/2), m/s
  };
  Motion motion(std::uint64_t step) {
    const auto frame = receive(FrameKind::motion, step);
    return {rows(frame, FrameKind::motion, Field::position),
            rows(frame, FrameKind::motion, Field::velocity)};
  }
  Rows own_forces(std::uint64_t step) {
    return rows(receive(FrameKind::own_forces, step), FrameKind::own_forces, Field::force);
  }
  void give(std::uint64_t step, const Rows& forces) {
    const auto frame = channel_->outgoing(wait_);
    layout.write_header(frame, FrameKind::interface_forces, step);
    auto next = forces.begin();
    for (std::size_t i = 0; i < plan.interfaces.size(); ++i)
      for (double& f : layout.values(frame, FrameKind::interface_forces, i, Field::force))
        f = *next++;
    channel_->send(layout.bytes(FrameKind::interface_forces));
  }

  // --- rows of all interfaces ---

  std::size_t size() const { return components().size(); }

  /// [size()] where each value stands in an array [num_points][dimension].
  std::vector<std::size_t> components() const {
    const auto dim = static_cast<std::size_t>(declaration.dimension);
    std::vector<std::size_t> result;
    for (const Interface& interface : plan.interfaces)
      for (const std::uint32_t point : interface.points)
        for (std::size_t a = 0; a < dim; ++a)
          result.push_back(point * dim + a);
    return result;
  }

  Rows inverse_masses() const { // [size()] 1/kg
    Rows all;
    for (const Rows& of_interface : limits.inverse_mass)
      all.insert(all.end(), of_interface.begin(), of_interface.end());
    return all;
  }

  Declaration declaration;
  Plan plan;
  Limits limits;
  FrameLayout layout;
  double time_step = 0.0; // s

private:
  using Clock = std::chrono::steady_clock;
  static constexpr auto limit = std::chrono::seconds(10);

  static int& count() {
    static int brokers = 0;
    return brokers;
  }
  void give_up_without_participant() {
    if (const auto code = child.end_within(std::chrono::seconds(0)))
      throw std::runtime_error(
          fmt::format("the participant ended with {} and said: {}", *code, child.output()));
  }
  std::span<const std::byte> receive(FrameKind kind, std::uint64_t step) {
    const auto frame = channel_->receive(wait_);
    check_frame(frame, kind, step, layout);
    return frame;
  }
  Rows rows(std::span<const std::byte> frame, FrameKind kind, Field field) const {
    Rows all;
    for (std::size_t i = 0; i < plan.interfaces.size(); ++i) {
      const auto values = layout.values(frame, kind, i, field);
      all.insert(all.end(), values.begin(), values.end());
    }
    return all;
  }

  ScratchFolder folder_;
  std::string settings_, case_settings_, transport_;
  ControlServer control_;
  int segment_;
  std::string peer_;
  std::unique_ptr<Channel> channel_;
  Wait wait_{.limit = limit, .idle = [this] { give_up_without_participant(); }};

public:
  const std::filesystem::path run_folder = folder_ / "run";
  ChildProcess child;
};

} // namespace kerf::coupler
