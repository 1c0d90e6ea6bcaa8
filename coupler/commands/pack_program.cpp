#include "coupler/commands/pack_program.hpp"

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace kerf::commands {
namespace {

using std::string;

/// Waits for the program, its output in the log. @return whether it ended with exit code 0
bool run(std::vector<string> words, const std::filesystem::path& log) {
  std::vector<char*> arguments;
  for (string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  setenv("OMP_WAIT_POLICY", "passive", 0); // its parallel regions are too short to spin between
  pid_t pid = 0;
  const int error = posix_spawn(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw std::system_error(error, std::generic_category(), "cannot start " + words[0]);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// The last line of the log, which says what was wrong.
string complaint(const std::filesystem::path& log) {
  std::ifstream file(log);
  string line, last;
  while (std::getline(file, line))
    if (!line.empty())
      last = line;
  const string speaker = "kerf pack: ";
  return last.starts_with(speaker) ? last.substr(speaker.size()) : last;
}

} // namespace

std::optional<string> run_pack(const std::vector<string>& arguments,
                               const std::filesystem::path& log) {
  const auto programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::vector<string> words = {(programs / "kerf-dem").string(), "pack"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run(words, log) ? std::nullopt : std::optional(complaint(log));
}

} // namespace kerf::commands
