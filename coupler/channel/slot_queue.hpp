// One direction of a link through memory that two threads or processes share: two slots for
// frames, and the two counters that say who may touch which.
#pragma once

#include "coupler/channel/channel.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kerf::coupler {

/// A counter of frames that the other side can sleep on. Both flags of the hand-over stand here:
/// whoever waits raises `waiting` and looks again before it sleeps, whoever advances stores `value`
/// before it looks at `waiting`. Both in sequential order, so that one of them sees the other.
struct alignas(64) WaitWord {
  std::atomic<std::uint32_t> value;
  std::atomic<std::uint32_t> waiting;
};

/// What stands before the slots of one direction. Offsets, never pointers.
struct SlotControl {
  WaitWord sent;  // frames the sender has completed
  WaitWord taken; // frames the receiver has given back
  struct alignas(64) {
    std::atomic<std::uint64_t> bytes[2]; // of the frame in each slot
  } length;
};
static_assert(sizeof(SlotControl) == 192);
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

inline constexpr std::uint32_t num_slots = 2; // with one, two sides that both send deadlock

/// Bytes of one direction whose frames have at most `capacity` bytes.
constexpr std::size_t slot_queue_bytes(std::size_t capacity) noexcept {
  return sizeof(SlotControl) + num_slots * ((capacity + 63) / 64 * 64);
}

/// The end that sends. The memory is zero at first, aligned to 64, and outlives both ends.
class SlotSender {
public:
  SlotSender(std::byte* memory, std::size_t capacity);
  std::span<std::byte> outgoing(const Wait& wait); // as in Channel
  void send(std::size_t bytes);

private:
  SlotControl* control_;
  std::byte* slots_;
  std::size_t capacity_;
  std::uint32_t sent_ = 0;
};

/// The end that receives. It trusts neither the counter nor the length that it reads.
class SlotReceiver {
public:
  SlotReceiver(std::byte* memory, std::size_t capacity);
  /// @throws ProtocolError when the sender's counter or length is impossible
  std::span<const std::byte> receive(const Wait& wait); // as in Channel

private:
  SlotControl* control_;
  std::byte* slots_;
  std::size_t capacity_;
  std::uint32_t received_ = 0;
  bool holds_a_frame_ = false;
};

} // namespace kerf::coupler
