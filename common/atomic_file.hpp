// Files that are complete or absent: written under a temporary name, then renamed.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace kerf {

/// Calls write(temporary path) and gives the result its final name. When write throws, nothing is
/// left behind. Folders that are missing are made.
/// @throws std::runtime_error when the file system refuses; and whatever write throws
template <class Write> void write_atomically(const std::filesystem::path& path, Write write) {
  if (path.has_parent_path())
    std::filesystem::create_directories(path.parent_path());
  std::filesystem::path temporary = path;
  temporary += ".part";
  try {
    write(temporary);
    std::filesystem::rename(temporary, path);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

/// Replaces the content of a text file in one step.
/// @throws std::runtime_error when the disk is full or the folder cannot be written
inline void write_text(const std::filesystem::path& path, std::string_view text) {
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file)
      throw std::runtime_error("cannot write " + path.string());
  });
}

} // namespace kerf
