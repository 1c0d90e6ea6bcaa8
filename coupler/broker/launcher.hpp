// Starts the participants of a run as child processes and watches over them.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

namespace kerf::coupler {

/// How a child is started.
struct Command {
  std::string name;                               // of the participant
  std::vector<std::string> arguments;             // the program first
  std::map<std::string, std::string> environment; // added to the launcher's own
  std::filesystem::path log;                      // receives stdout and stderr
  int segment = -1; // descriptor that the child inherits, or -1; announced as KERF_SEGMENT
};

/// What became of a child.
struct Ending {
  std::string name;
  pid_t pid = 0;
  bool signaled = false;
  int code = 0; // exit code, or the signal

  std::string sentence() const; // "was killed by signal 9 (Killed)", "ended with exit code 3"
};

/// The children of one run. They end with this process: each holds the read end of a pipe whose
/// other end closes with the launcher, and gets SIGTERM when the launcher dies before the
/// participant library is up. Ctrl-C is for the launcher alone.
class Launcher {
public:
  Launcher() = default;
  ~Launcher(); // kills what is left
  Launcher(const Launcher&) = delete;
  Launcher& operator=(const Launcher&) = delete;

  /// @throws std::system_error when the process cannot be made; a program that cannot be executed
  ///         shows up as a child that ended with exit code 127
  void start(const Command& command);

  /// Children that ended since the last call, in the order of their start.
  std::vector<Ending> ended();

  pid_t pid(const std::string& name) const;
  bool all_ended() const;

  /// Waits until every child has ended by itself; sends SIGTERM after `patience`, SIGKILL 0.2 s
  /// later.
  void stop(std::chrono::milliseconds patience);

private:
  struct Child {
    std::string name;
    pid_t pid = 0;
    bool running = true;
  };
  bool wait_until(std::chrono::steady_clock::time_point deadline);

  std::vector<Child> children_;
  int lifeline_[2] = {-1, -1};
};

} // namespace kerf::coupler
