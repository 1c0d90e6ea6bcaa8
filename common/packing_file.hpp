// Packings as text: one particle a line.
#pragma once

#include "common/text_file.hpp"

#include <filesystem>
#include <vector>

namespace kerf {

using PackingError = FileError;

struct Packing {
  std::vector<double> positions; // [n][dim] m
  std::vector<double> radii;     // [n] m
};

/// Reads lines of `x y r` (dim 2) or `x y z r` (dim 3), in metres. `#` starts a comment; empty
/// lines count for nothing.
/// @throws PackingError when the file cannot be read or holds no particle, or a line has another
///         number of values, a value that is not a finite number, or a radius that is not positive
Packing read_packing(const std::filesystem::path& path, int dim);

} // namespace kerf
