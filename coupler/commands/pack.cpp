// kerf pack - hands its arguments to `kerf-dem pack`, which has the generator.
#include "common/exit_code.hpp"
#include "coupler/commands/commands.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <unistd.h>

namespace kerf::commands {

int pack(const std::vector<std::string>& arguments) {
  const std::string program =
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "kerf-dem").string();
  std::vector<std::string> words = {program, "pack"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words)
    pointers.push_back(word.data());
  pointers.push_back(nullptr);
  setenv("OMP_WAIT_POLICY", "passive", 0); // its parallel regions are too short to spin between
  execv(program.c_str(), pointers.data()); // returns only when it fails
  fmt::print(stderr, "kerf: {} cannot be started: {}.\n", program, std::strerror(errno));
  return exit_code::run_failed;
}

} // namespace kerf::commands
