// The link on which one participant and the broker exchange the frames of the steps.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

namespace kerf::coupler {

/// The other end did not answer before the deadline.
class TimeoutError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// The other end will never answer: it has closed the link, as a transport with connections sees.
class ClosedError : public TimeoutError {
public:
  using TimeoutError::TimeoutError;
};

/// How long to wait for a frame, and what to look after meanwhile.
struct Wait {
  std::chrono::steady_clock::duration limit = std::chrono::seconds(30);
  /// Called at least every 50 ms while waiting, never when the frame is there within 1 ms; may
  /// throw to give up (the peer has died, the run was stopped).
  std::function<void()> idle;
};

/// One end of a two-way link. Frames arrive whole, once, and in order; the memory of a frame
/// belongs to the channel, so that nothing is copied where the transport allows it.
class Channel {
public:
  virtual ~Channel() = default;

  /// Memory of the next outgoing frame, [capacity] bytes, aligned to 64. The same memory is
  /// returned until send() is called.
  /// @throws TimeoutError when the peer has not taken the earlier frames in time
  virtual std::span<std::byte> outgoing(const Wait& wait) = 0;

  /// Hands the first `bytes` bytes of outgoing() to the peer.
  /// @throws std::invalid_argument when that is more than the capacity
  virtual void send(std::size_t bytes) = 0;

  /// The next incoming frame; the memory stays valid until the next call of receive().
  /// @throws TimeoutError when none arrives in time
  virtual std::span<const std::byte> receive(const Wait& wait) = 0;
};

/// What both ends must know to open the same channel; travels as JSON in the schedule message.
struct ChannelAddress {
  std::string transport = {};    // "shm", "zmq", "loopback"
  std::string endpoint = {};     // zmq: endpoint; loopback: name; shm: path that opens the memory
  int descriptor = -1;           // shm: inherited file descriptor, or -1 to open `endpoint`
  std::size_t up_capacity = 0;   // bytes of the largest frame from the participant
  std::size_t down_capacity = 0; // bytes of the largest frame from the broker
};

/// Opens the broker's end. For "shm", address.descriptor is a memfd that this call sizes, seals
/// and maps; for "zmq", the endpoint is bound (a wildcard is replaced in `address`).
/// @throws std::invalid_argument for an unknown transport; std::system_error from the system
std::unique_ptr<Channel> open_broker_end(ChannelAddress& address);

/// Opens the participant's end of what open_broker_end() made.
/// @throws std::invalid_argument when the memory or the endpoint is not what the address says
std::unique_ptr<Channel> open_participant_end(const ChannelAddress& address);

/// A memfd without a name that a launcher can hand down before its size is known.
int create_segment();

} // namespace kerf::coupler
