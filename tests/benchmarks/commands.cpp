#include "tests/benchmarks/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace kerf::benchmarks {

bool is_installed(const std::string& program) {
  return std::system(fmt::format("command -v {} > /dev/null", program).c_str()) == 0;
}

std::string output_of(const std::string& command) {
  std::string output;
  std::FILE* pipe = popen((command + " 2>&1 < /dev/null").c_str(), "r");
  if (pipe == nullptr)
    throw std::runtime_error(fmt::format("cannot start {}", command));
  char piece[4096];
  while (const std::size_t size = std::fread(piece, 1, sizeof piece, pipe))
    output.append(piece, size);
  if (pclose(pipe) != 0)
    throw std::runtime_error(
        fmt::format("{} failed:\n{}", command,
                    output.substr(output.size() - std::min<std::size_t>(output.size(), 2000))));
  return output;
}

double loop_time(const std::string& output) {
  static constexpr std::string_view words = "Loop time of ";
  const auto at = output.rfind(words);
  if (at == std::string::npos)
    throw std::runtime_error(fmt::format("a code did not say its time:\n{}", output));
  return std::strtod(output.c_str() + at + words.size(), nullptr);
}

TemporaryFolder::TemporaryFolder() {
  std::string name = std::filesystem::temp_directory_path() / "kerf-bench-XXXXXX";
  if (mkdtemp(name.data()) == nullptr)
    throw std::runtime_error(fmt::format("cannot make the folder {}", name));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored; // a folder in /tmp that stays is no harm
  std::filesystem::remove_all(path_, ignored);
}

} // namespace kerf::benchmarks
