// See slot_queue.hpp. How a side waits: it looks, yields the core for about 100 µs (the answer
// usually comes from a process on the same core), then sleeps on a futex until it is woken.
#include "coupler/channel/slot_queue.hpp"

#include "coupler/protocol/protocol_error.hpp"

#include <algorithm>
#include <climits>
#include <fmt/format.h>
#include <linux/futex.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace kerf::coupler {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto yielding_time = std::chrono::microseconds(100);
constexpr auto slice = std::chrono::milliseconds(50);

/// Sleeps until the word is woken, the time has passed, or a signal came. Process-shared: the two
/// sides map the word at different addresses.
void futex_wait(std::atomic<std::uint32_t>& word, std::uint32_t value, Clock::duration time) {
  const auto nanoseconds = std::chrono::duration_cast<std::chrono::nanoseconds>(time).count();
  const timespec timeout{static_cast<time_t>(nanoseconds / 1'000'000'000),
                         static_cast<long>(nanoseconds % 1'000'000'000)};
  syscall(SYS_futex, &word, FUTEX_WAIT, value, &timeout, nullptr, 0);
}

void futex_wake(std::atomic<std::uint32_t>& word) {
  syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

void advance(WaitWord& word, std::uint32_t value) {
  word.value.store(value, std::memory_order_seq_cst);
  if (word.waiting.load(std::memory_order_seq_cst) != 0)
    futex_wake(word.value);
}

/// Returns false when the limit has passed.
bool sleep_while(WaitWord& word, std::uint32_t value, const Wait& wait, Clock::time_point start) {
  const auto deadline =
      wait.limit < Clock::time_point::max() - start ? start + wait.limit : Clock::time_point::max();
  auto next_idle = start + slice;
  while (word.value.load(std::memory_order_acquire) == value) {
    const auto now = Clock::now();
    if (now >= deadline)
      return false;
    if (now >= next_idle) {
      if (wait.idle)
        wait.idle();
      next_idle = Clock::now() + slice;
      continue;
    }
    word.waiting.store(1, std::memory_order_seq_cst);
    if (word.value.load(std::memory_order_seq_cst) == value)
      futex_wait(word.value, value, std::min(next_idle, deadline) - now);
    word.waiting.store(0, std::memory_order_relaxed);
  }
  return true;
}

/// Waits until the word has another value. Returns false when the limit has passed.
bool wait_while(WaitWord& word, std::uint32_t value, const Wait& wait) {
  if (word.value.load(std::memory_order_acquire) != value)
    return true;
  const auto start = Clock::now();
  const auto end_of_yielding = start + std::min<Clock::duration>(yielding_time, wait.limit);
  do {
    sched_yield();
    if (word.value.load(std::memory_order_acquire) != value)
      return true;
  } while (Clock::now() < end_of_yielding);
  return sleep_while(word, value, wait, start);
}

double seconds(Clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

std::byte* slot(std::byte* slots, std::size_t capacity, std::uint32_t number) {
  return slots + (number % num_slots) * ((capacity + 63) / 64 * 64);
}

} // namespace

SlotSender::SlotSender(std::byte* memory, std::size_t capacity)
    : control_(reinterpret_cast<SlotControl*>(memory)), slots_(memory + sizeof(SlotControl)),
      capacity_(capacity) {}

std::span<std::byte> SlotSender::outgoing(const Wait& wait) {
  if (!wait_while(control_->taken, sent_ - num_slots, wait))
    throw TimeoutError(fmt::format("the other end did not take the last {} frames within {:g} s",
                                   num_slots, seconds(wait.limit)));
  const std::uint32_t taken = control_->taken.value.load(std::memory_order_acquire);
  if (sent_ - taken >= num_slots)
    throw ProtocolError(
        fmt::format("the other end claims to have taken {} frames of {}", taken, sent_));
  return {slot(slots_, capacity_, sent_), capacity_};
}

void SlotSender::send(std::size_t bytes) {
  if (bytes > capacity_)
    throw std::invalid_argument(
        fmt::format("a frame of {} bytes does not fit the capacity of {}", bytes, capacity_));
  control_->length.bytes[sent_ % num_slots].store(bytes, std::memory_order_relaxed);
  advance(control_->sent, ++sent_);
}

SlotReceiver::SlotReceiver(std::byte* memory, std::size_t capacity)
    : control_(reinterpret_cast<SlotControl*>(memory)), slots_(memory + sizeof(SlotControl)),
      capacity_(capacity) {}

std::span<const std::byte> SlotReceiver::receive(const Wait& wait) {
  if (holds_a_frame_) {
    holds_a_frame_ = false;
    advance(control_->taken, received_);
  }
  if (!wait_while(control_->sent, received_, wait))
    throw TimeoutError(fmt::format("no frame came within {:g} s", seconds(wait.limit)));
  const std::uint32_t sent = control_->sent.value.load(std::memory_order_acquire);
  if (sent - received_ > num_slots)
    throw ProtocolError(
        fmt::format("the other end claims to have sent {} frames, {} were taken", sent, received_));
  const std::uint64_t bytes =
      control_->length.bytes[received_ % num_slots].load(std::memory_order_relaxed);
  if (bytes > capacity_)
    throw ProtocolError(
        fmt::format("a frame claims {} bytes, the capacity is {}", bytes, capacity_));
  const std::byte* frame = slot(slots_, capacity_, received_);
  ++received_;
  holds_a_frame_ = true;
  return {frame, bytes};
}

} // namespace kerf::coupler
