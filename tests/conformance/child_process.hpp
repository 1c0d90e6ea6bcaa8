// A program that a test starts as a participant, and watches.
#pragma once

#include <cerrno>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace kerf::coupler {

/// A participant as a process of its own, started as docs/protocol.md says. It is not the
/// Launcher that starts it: a test has to be able to cut the lifeline alone.
class ChildProcess {
public:
  /// @param segment  descriptor that the child inherits, or -1
  ChildProcess(std::vector<std::string> arguments, std::map<std::string, std::string> variables,
               int segment, std::filesystem::path log)
      : log_(std::move(log)) {
    int lifeline[2];
    if (pipe2(lifeline, O_CLOEXEC) != 0)
      throw std::system_error(errno, std::generic_category(), "pipe");
    lifeline_ = lifeline[1];
    variables["KERF_LIFELINE"] = std::to_string(lifeline[0]);
    variables["OMP_NUM_THREADS"] = "1";
    variables["OMP_WAIT_POLICY"] = "passive";
    if (segment >= 0)
      variables["KERF_SEGMENT"] = std::to_string(segment);
    std::vector<std::string> environment;
    for (char** entry = environ; *entry != nullptr; ++entry)
      if (const std::string line = *entry;
          !line.starts_with("KERF_") && !variables.contains(line.substr(0, line.find('='))))
        environment.push_back(line);
    for (const auto& [key, value] : variables)
      environment.push_back(key + "=" + value);

    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log_.c_str(),
                                     O_WRONLY | O_CREAT | O_APPEND, 0644);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    for (const int kept : {lifeline[0], segment}) // onto itself: stays open in the child
      if (kept >= 0)
        posix_spawn_file_actions_adddup2(&files, kept, kept);
    const int error = posix_spawn(&pid_, arguments[0].c_str(), &files, nullptr,
                                  pointers(arguments).data(), pointers(environment).data());
    posix_spawn_file_actions_destroy(&files);
    close(lifeline[0]);
    if (error != 0) {
      close(lifeline_);
      throw std::system_error(error, std::generic_category(), "cannot start " + arguments[0]);
    }
  }
  ~ChildProcess() {
    if (!end_within(std::chrono::seconds(0))) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    cut_lifeline();
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }

  /// The exit code of the process when it ends in time; negative: the signal that killed it.
  std::optional<int> end_within(std::chrono::milliseconds limit) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    for (;;) {
      int status = 0;
      if (!code_ && waitpid(pid_, &status, WNOHANG) == pid_)
        code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
      if (code_ || std::chrono::steady_clock::now() >= deadline)
        return code_;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  void cut_lifeline() {
    if (lifeline_ >= 0)
      close(std::exchange(lifeline_, -1));
  }

  std::string output() const {
    std::ifstream file(log_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

private:
  static std::vector<char*> pointers(std::vector<std::string>& strings) {
    std::vector<char*> result;
    for (std::string& s : strings)
      result.push_back(s.data());
    result.push_back(nullptr);
    return result;
  }

  std::filesystem::path log_;
  int lifeline_ = -1; // the write end; nobody writes, it only closes
  pid_t pid_ = 0;
  std::optional<int> code_;
};

} // namespace kerf::coupler
