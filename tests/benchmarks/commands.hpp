// Other programs: started, listened to, given a folder for their files.
#pragma once

#include <filesystem>
#include <string>

namespace kerf::benchmarks {

/// Whether the shell finds a program.
bool is_installed(const std::string& program);

/// What a command prints.
/// @throws std::runtime_error with the end of it when the command fails
std::string output_of(const std::string& command);

/// The last "Loop time of 1.234" in what a code printed, s.
/// @throws std::runtime_error with the output when there is none
double loop_time(const std::string& output);

/// A folder of its own in the folder for temporary files.
class TemporaryFolder {
public:
  /// @throws std::runtime_error when it cannot be made
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

private:
  std::filesystem::path path_;
};

} // namespace kerf::benchmarks
