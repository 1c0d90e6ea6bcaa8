// See lifeline.hpp.
#include "coupler/participant/lifeline.hpp"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <stdexcept>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <system_error>
#include <unistd.h>

namespace kerf::coupler {

Lifeline::Lifeline(int descriptor) : descriptor_(descriptor) {
  if (!watched())
    return;
  if (fcntl(descriptor, F_SETFD, FD_CLOEXEC) != 0)
    throw std::invalid_argument(fmt::format("the lifeline {} is no open descriptor", descriptor));
  end_ = eventfd(0, EFD_CLOEXEC);
  if (end_ < 0)
    throw std::system_error(errno, std::generic_category(), "cannot make an eventfd");
  // Signals are for the solver's own thread.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { watch(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  // Until here the launcher's death ended this process by a signal; from now on it ends in order.
  prctl(PR_SET_PDEATHSIG, 0);
}

Lifeline::~Lifeline() {
  if (!watched())
    return;
  const std::uint64_t one = 1;
  if (write(end_, &one, sizeof one) == sizeof one)
    thread_.join();
  else
    thread_.detach(); // cannot happen: an eventfd takes many such writes
  close(end_);
}

std::string Lifeline::sentence() const {
  const auto pid = broker_pid_.load(std::memory_order_relaxed);
  return fmt::format("the broker{} is gone at step {}; this participant stops",
                     pid > 0 ? fmt::format(" (pid {})", pid) : "",
                     step_.load(std::memory_order_relaxed));
}

void Lifeline::watch() {
  for (;;) {
    pollfd ends[2] = {{descriptor_, POLLIN, 0}, {end_, POLLIN, 0}};
    if (poll(ends, 2, -1) < 0 && errno != EINTR)
      break;
    if (ends[1].revents != 0)
      return;
    if ((ends[0].revents & POLLIN) != 0) { // nobody writes; without data it is the end
      char ignored[64];
      if (read(descriptor_, ignored, sizeof ignored) <= 0)
        break;
    } else if (ends[0].revents != 0) {
      break;
    }
  }
  cut_.store(true, std::memory_order_relaxed);
  if (wait_for_end(500))
    return;
  const std::string line = sentence() + '\n';
  if (write(STDERR_FILENO, line.data(), line.size()) < 0)
    _exit(3); // nobody reads the log either
  _exit(3);
}

bool Lifeline::wait_for_end(int milliseconds) {
  pollfd end = {end_, POLLIN, 0};
  return poll(&end, 1, milliseconds) > 0;
}

} // namespace kerf::coupler
