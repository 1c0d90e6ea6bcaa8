// One line of progress per participant on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

namespace kerf::commands {

class ProgressDisplay {
public:
  explicit ProgressDisplay(bool terminal) : terminal_(terminal) {}

  /// Called about five times a second for each participant.
  void update(const std::string& participant, std::uint64_t step, std::uint64_t steps);

  /// Leaves the last state on the terminal.
  void finish();

private:
  void draw();

  using Clock = std::chrono::steady_clock;
  bool terminal_;
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> state_; // step, steps
  std::size_t drawn_lines_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_line_ = Clock::now();
};

} // namespace kerf::commands
