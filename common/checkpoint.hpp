// Checkpoints of a run: folders checkpoints/<step, 9 digits> with one file for each process and,
// last of all, checkpoint.json, without which there is no checkpoint.
#pragma once

#include "common/state.hpp"

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace kerf {

/// A checkpoint that cannot be used; one sentence that names the file.
class CheckpointError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// The state of one process at the beginning of a step.
struct Checkpoint {
  std::string writer; // program and version
  std::uint64_t step = 0;
  State state;
};

/// Writes a file that is complete or absent. The same state gives the same bytes.
/// @throws std::runtime_error when it cannot be written
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// @param writer  program and version that must have written it
/// @throws CheckpointError when the file is missing, cut, changed, or of another program
Checkpoint read_checkpoint(const std::filesystem::path& file, const std::string& writer);

std::filesystem::path checkpoint_folder(const std::filesystem::path& run_folder,
                                        std::uint64_t step);

/// Steps of the complete checkpoints of a run, ascending.
std::vector<std::uint64_t> list_checkpoints(const std::filesystem::path& run_folder);

/// Removes all but the newest complete checkpoints up to the last of them; what is being written
/// for later steps stays.
void keep_checkpoints(const std::filesystem::path& run_folder, std::size_t count);

/// Removes what a run has written after a step.
void remove_checkpoints_after(const std::filesystem::path& run_folder, std::uint64_t step);

} // namespace kerf
