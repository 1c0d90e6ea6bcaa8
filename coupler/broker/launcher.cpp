#include "coupler/broker/launcher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace kerf::coupler {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// Between fork and exec only calls that are safe there; everything is prepared by the parent.
[[noreturn]] void become(pid_t parent, char* const* arguments, char* const* environment, int log,
                         int segment, int lifeline) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) // the launcher died before that
    _exit(3);
  signal(SIGINT, SIG_IGN); // Ctrl-C is for the launcher: it ends the run in order
  signal(SIGHUP, SIG_IGN);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  if (segment >= 0)
    fcntl(segment, F_SETFD, 0);
  fcntl(lifeline, F_SETFD, 0);
  execvpe(arguments[0], arguments, environment);
  const char* reason = strerror(errno);
  (void)!write(STDERR_FILENO, "cannot start ", 13);
  (void)!write(STDERR_FILENO, arguments[0], strlen(arguments[0]));
  (void)!write(STDERR_FILENO, ": ", 2);
  (void)!write(STDERR_FILENO, reason, strlen(reason));
  (void)!write(STDERR_FILENO, "\n", 1);
  _exit(127);
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> result;
  for (std::string& s : strings)
    result.push_back(s.data());
  result.push_back(nullptr);
  return result;
}

} // namespace

std::string Ending::sentence() const {
  if (signaled)
    return fmt::format("was killed by signal {} ({})", code, strsignal(code));
  if (code == 127)
    return "could not be started (exit code 127)";
  return fmt::format("ended with exit code {}", code);
}

Launcher::~Launcher() {
  stop(std::chrono::milliseconds(0));
  for (const int end : lifeline_)
    if (end >= 0)
      close(end);
}

void Launcher::start(const Command& command) {
  if (lifeline_[0] < 0 && pipe2(lifeline_, O_CLOEXEC) != 0)
    fail("pipe");
  const int log = open(command.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (log < 0)
    fail(command.log.c_str());

  std::map<std::string, std::string> variables = command.environment;
  variables["KERF_LIFELINE"] = std::to_string(lifeline_[0]);
  if (command.segment >= 0)
    variables["KERF_SEGMENT"] = std::to_string(command.segment);
  std::vector<std::string> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string line = *entry;
    if (!variables.contains(line.substr(0, line.find('='))))
      environment.push_back(line);
  }
  for (const auto& [key, value] : variables)
    environment.push_back(key + "=" + value);
  std::vector<std::string> arguments = command.arguments;
  const std::vector<char*> argv = pointers(arguments), envp = pointers(environment);

  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0)
    become(parent, argv.data(), envp.data(), log, command.segment, lifeline_[0]);
  close(log);
  if (pid < 0)
    fail("fork");
  children_.push_back({command.name, pid});
}

std::vector<Ending> Launcher::ended() {
  std::vector<Ending> endings;
  for (Child& child : children_) {
    int status = 0;
    if (!child.running || waitpid(child.pid, &status, WNOHANG) != child.pid)
      continue;
    child.running = false;
    const bool signaled = WIFSIGNALED(status);
    endings.push_back(
        {child.name, child.pid, signaled, signaled ? WTERMSIG(status) : WEXITSTATUS(status)});
  }
  return endings;
}

pid_t Launcher::pid(const std::string& name) const {
  const auto child = std::ranges::find(children_, name, &Child::name);
  return child == children_.end() ? 0 : child->pid;
}

bool Launcher::all_ended() const {
  return std::ranges::none_of(children_, [](const Child& child) { return child.running; });
}

bool Launcher::wait_until(std::chrono::steady_clock::time_point deadline) {
  while (ended(), !all_ended()) {
    if (std::chrono::steady_clock::now() >= deadline)
      return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

void Launcher::stop(std::chrono::milliseconds patience) {
  const auto signal_all = [this](int number) {
    for (const Child& child : children_)
      if (child.running)
        kill(child.pid, number);
  };
  if (wait_until(std::chrono::steady_clock::now() + patience))
    return;
  signal_all(SIGTERM);
  if (wait_until(std::chrono::steady_clock::now() + std::chrono::milliseconds(200)))
    return;
  signal_all(SIGKILL);
  wait_until(std::chrono::steady_clock::now() + std::chrono::seconds(10));
}

} // namespace kerf::coupler
