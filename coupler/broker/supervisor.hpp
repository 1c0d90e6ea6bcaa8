// Who brings the participants of a run to life and notices when they die.
#pragma once

#include "coupler/participant/participant.hpp"

#include <stdexcept>
#include <string>
#include <sys/types.h>
#include <utility>

namespace kerf::coupler {

/// A participant ended without having finished.
class ParticipantLost : public std::runtime_error {
public:
  ParticipantLost(std::string name, pid_t pid, const std::string& how)
      : std::runtime_error(how), name_(std::move(name)), pid_(pid) {}
  const std::string& name() const noexcept { return name_; }
  pid_t pid() const noexcept { return pid_; }

private:
  std::string name_;
  pid_t pid_;
};

/// The user ended the run: Ctrl-C, SIGTERM, or a closed terminal.
class Interrupted : public std::runtime_error {
public:
  /// @param place       where the run was, for example "at step 12 of 200"
  /// @param checkpoint  a sentence about the last one
  explicit Interrupted(int signal, const std::string& place = "", std::string checkpoint = "")
      : std::runtime_error(place), signal_(signal), checkpoint_(std::move(checkpoint)) {}
  int signal() const noexcept { return signal_; }
  const std::string& checkpoint() const noexcept { return checkpoint_; }

private:
  int signal_;
  std::string checkpoint_;
};

class Supervisor {
public:
  virtual ~Supervisor() = default;

  /// Starts a participant with its invitation; returns once it may call back.
  virtual void start(const Participant::Invitation& invitation) = 0;

  /// Cheap; called whenever the broker waits and every 0.1 s.
  /// @throws ParticipantLost, Interrupted
  virtual void check() = 0;

  /// The participant has finished: from now on it may end.
  virtual void release(const std::string& name) = 0;
};

} // namespace kerf::coupler
