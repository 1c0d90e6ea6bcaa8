// A participant's conversation with its broker beside the frames of the steps.
#pragma once

#include "coupler/channel/bodies.hpp"
#include "coupler/channel/control.hpp"
#include "coupler/participant/lifeline.hpp"

#include <chrono>
#include <string>

namespace kerf::coupler {

/// Sends and awaits control messages, and notices when the broker wants to stop or is gone: by
/// the lifeline, or without one by the broken connection. Every call that reads may throw
/// RunStopped, or ProtocolError when the broker says something out of turn.
class ControlLine {
public:
  using Clock = std::chrono::steady_clock;

  ControlLine(const std::string& endpoint, int lifeline);

  void send(const Message& message) { client_.send(message); }

  /// Waits for a message of one type.
  Message await(const char* type, Clock::duration limit);

  /// When the link of the frames has closed: the broker's reason follows, or it is gone.
  [[noreturn]] void await_stop();

  /// Reads what is there and reports the progress, unless it did so within the last 0.1 s.
  void attend(const Progress& progress);
  /// The same, cheap enough for every step.
  void attend_sometimes(Clock::time_point now, const Progress& progress) {
    if (lifeline_.cut() || now - last_report_ >= between_reports)
      attend(progress);
  }

  /// True when the broker wants a checkpoint, after which the run stops.
  bool wants_checkpoint() const noexcept { return wants_checkpoint_; }

  Lifeline& lifeline() noexcept { return lifeline_; }

private:
  static constexpr auto between_reports = std::chrono::milliseconds(100);

  bool broker_is_gone();
  bool is_order(const Message& message);

  std::string endpoint_;
  Lifeline lifeline_;
  ControlClient client_;
  bool connection_broke_ = false;
  bool wants_checkpoint_ = false;
  Clock::time_point last_report_{};
};

} // namespace kerf::coupler
