// Packings as files: read by content, written by format.
#pragma once

#include "common/text_file.hpp"

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace kerf {

using PackingError = FileError;

struct Packing {
  int dim = 0;                   // 2 or 3
  std::vector<double> positions; // [n][dim] m
  std::vector<double> radii;     // [n] m
};

enum class PackingFormat {
  text, // lines of x y r (2D) or x y z r (3D); # starts a comment
  yade, // the same after a line #format x_y_z_r, as yade.export.text writes; 2D has z = 0
  vtk,  // legacy VTK in ASCII: points with a scalar "radius"; 2D has z = 0
  dump, // of LAMMPS and LIGGGHTS, ITEM: ATOMS id type x y z radius; the last moment of the file
};

/// Reads any of the formats, told apart by how the file begins. Lengths are in metres.
/// @param dim  what the packing must have; nothing: 2 for lines of x y r or when every z is zero
/// @throws PackingError when the file cannot be read or holds no particle, a line has another
///         number of values than it should, a value that is not a finite number, or a radius that
///         is not positive, or when the packing is not of that dimension
Packing read_packing(const std::filesystem::path& path, std::optional<int> dim = {});

/// The format that an extension stands for: .vtk, .dump or .liggghts or .lammpstrj, .yade; others
/// are text.
PackingFormat packing_format(const std::filesystem::path& path);

/// Writes a packing with all digits of its numbers, in one step.
/// @param comment  one line about it, where the format has a place for it
/// @throws std::runtime_error when the file cannot be written
void write_packing(const std::filesystem::path& path, const Packing& packing, PackingFormat format,
                   const std::string& comment);

} // namespace kerf
