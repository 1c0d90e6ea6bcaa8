// See control_line.hpp.
#include "coupler/participant/control_line.hpp"

#include "coupler/participant/participant.hpp"

#include <fmt/format.h>

namespace kerf::coupler {
namespace {

constexpr auto no_time = std::chrono::milliseconds(0);
constexpr auto slice = std::chrono::milliseconds(50);

[[noreturn]] void throw_unexpected(const Message& message) {
  if (message.type == message::stop)
    throw RunStopped(from_message<Stop>(message).reason);
  throw ProtocolError(fmt::format("the broker sent \"{}\" out of turn", message.type));
}

} // namespace

ControlLine::ControlLine(const std::string& endpoint, int lifeline)
    : endpoint_(endpoint), lifeline_(lifeline), client_(endpoint) {}

bool ControlLine::broker_is_gone() {
  connection_broke_ = connection_broke_ || client_.lost();
  return connection_broke_ || lifeline_.cut();
}

/// Takes what the broker may say at any time and the solver sees to at its next step.
bool ControlLine::is_order(const Message& message) {
  wants_checkpoint_ = wants_checkpoint_ || message.type == message::checkpoint;
  return message.type == message::checkpoint;
}

Message ControlLine::await(const char* type, Clock::duration limit) {
  const auto deadline = Clock::now() + limit;
  for (;;) {
    // Looked at before the messages are: what the broker said last may still be there.
    const bool gone = broker_is_gone();
    if (auto message = client_.receive(gone ? no_time : slice)) {
      if (message->type == type)
        return std::move(*message);
      if (!is_order(*message))
        throw_unexpected(*message);
    }
    if (gone)
      throw RunStopped(lifeline_.sentence());
    if (Clock::now() >= deadline)
      throw RunStopped(fmt::format("no broker answered at {} within {:g} s", endpoint_,
                                   std::chrono::duration<double>(limit).count()));
  }
}

void ControlLine::await_stop() {
  throw_unexpected(await(message::stop, std::chrono::seconds(1)));
}

void ControlLine::attend(const Progress& progress) {
  const bool gone = broker_is_gone();
  if (const auto message = client_.receive(no_time); message && !is_order(*message))
    throw_unexpected(*message);
  if (gone)
    throw RunStopped(lifeline_.sentence());
  const auto now = Clock::now();
  if (now - last_report_ < between_reports)
    return;
  last_report_ = now;
  client_.send(to_message(progress));
}

} // namespace kerf::coupler
