// Closed surfaces as files: STL meshes in 3D, polygons as text in 2D.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace kerf {

/// A surface file that cannot be used; what() begins with the file, and its line where there is
/// one.
class SurfaceError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

struct TriangleMesh {
  std::vector<std::array<double, 3>> vertices; // m
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Reads STL, ASCII or binary. Corners with the same coordinates become one vertex.
/// @throws SurfaceError when the file cannot be read, ends early, or holds no triangle
TriangleMesh read_stl(const std::filesystem::path& path);

/// Reads the corners of a polygon, a line `x y` each, in metres, in order; `#` starts a comment.
/// The last corner is joined to the first.
/// @throws SurfaceError when the file cannot be read, a line does not hold two finite numbers, or
///         there are fewer than three
std::vector<std::array<double, 2>> read_polygon(const std::filesystem::path& path);

} // namespace kerf
