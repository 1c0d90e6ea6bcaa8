#include "coupler/commands/progress.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace kerf::commands {

void ProgressDisplay::update(const std::string& participant, std::uint64_t step,
                             std::uint64_t steps) {
  state_[participant] = {step, steps};
  if (terminal_)
    draw();
  else if (Clock::now() - last_line_ > std::chrono::seconds(10)) { // a log needs no more
    last_line_ = Clock::now();
    for (const auto& [name, at] : state_)
      fmt::print("{}: step {} of {} ({:.0f} %)\n", name, at.first, at.second,
                 100.0 * static_cast<double>(at.first) / static_cast<double>(at.second));
    std::fflush(stdout);
  }
}

void ProgressDisplay::draw() {
  if (drawn_lines_ > 0)
    fmt::print("\x1b[{}A", drawn_lines_);
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  for (const auto& [name, at] : state_) {
    const double share = static_cast<double>(at.first) / static_cast<double>(at.second);
    const std::string left =
        share > 0.02 ? fmt::format("{:.0f} s left", elapsed * (1.0 / share - 1.0)) : "";
    fmt::print("\r\x1b[K{:<12} {:>3.0f} %  step {} of {}  {}\n", name, 100.0 * share, at.first,
               at.second, left);
  }
  drawn_lines_ = state_.size();
  std::fflush(stdout);
}

void ProgressDisplay::finish() {
  if (!terminal_ || drawn_lines_ == 0)
    return;
  for (auto& [name, at] : state_)
    at.first = at.second;
  draw();
}

} // namespace kerf::commands
