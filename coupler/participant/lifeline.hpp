// Ends a participant when its broker is gone, whatever the solver is doing.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

namespace kerf::coupler {

/// Watches, in a thread of its own, the read end of a pipe whose other end closes with the broker.
/// When that happens cut() becomes true. A solver that does not look at it has 0.5 s to end; then
/// the process prints why and exits with code 3.
class Lifeline {
public:
  /// @param descriptor  read end of the pipe, kept open by the caller; -1: nothing is watched
  explicit Lifeline(int descriptor);
  ~Lifeline();
  Lifeline(const Lifeline&) = delete;
  Lifeline& operator=(const Lifeline&) = delete;

  bool watched() const noexcept { return descriptor_ >= 0; }
  bool cut() const noexcept { return cut_.load(std::memory_order_relaxed); }

  // What the sentence says.
  void set_broker(std::int64_t pid) noexcept { broker_pid_.store(pid, std::memory_order_relaxed); }
  void set_step(std::uint64_t step) noexcept { step_.store(step, std::memory_order_relaxed); }
  std::string sentence() const; // "the broker (pid 7) is gone at step 12; this participant stops"

private:
  void watch();
  bool wait_for_end(int milliseconds); // -1: no limit

  int descriptor_;
  int end_ = -1; // eventfd that ends the thread
  std::atomic<bool> cut_ = false;
  std::atomic<std::int64_t> broker_pid_ = 0;
  std::atomic<std::uint64_t> step_ = 0;
  std::thread thread_;
};

} // namespace kerf::coupler
