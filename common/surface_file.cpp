#include "common/surface_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>

namespace kerf {

namespace {

using Corner = std::array<double, 3>;

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    throw SurfaceError(fmt::format("{} cannot be opened", path.string()));
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<Corner> read_ascii(const std::string& content, const std::string& name) {
  std::vector<Corner> corners;
  std::istringstream text(content);
  std::string line;
  for (std::size_t number = 1; std::getline(text, line); ++number) {
    std::istringstream words(line);
    std::string key;
    if (!(words >> key) || key != "vertex")
      continue;
    Corner& corner = corners.emplace_back();
    for (double& coordinate : corner)
      if (!(words >> coordinate) || !std::isfinite(coordinate))
        throw SurfaceError(fmt::format("{}:{}: a vertex needs three finite numbers", name, number));
  }
  return corners;
}

/// 80 bytes of header, the number of triangles, then 50 bytes for each: a normal, three corners as
/// 32-bit numbers, and two bytes more.
std::vector<Corner> read_binary(const std::string& content, std::size_t triangles,
                                const std::string& name) {
  std::vector<Corner> corners;
  for (std::size_t t = 0; t < triangles; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<float, 3> values;
      std::memcpy(values.data(), content.data() + 84 + 50 * t + 12 * (k + 1), sizeof values);
      for (const float value : values)
        if (!std::isfinite(value))
          throw SurfaceError(fmt::format("{}: triangle {} is not finite", name, t));
      corners.push_back({values[0], values[1], values[2]});
    }
  return corners;
}

} // namespace

TriangleMesh read_stl(const std::filesystem::path& path) {
  const std::string content = content_of(path), name = path.string();
  std::uint32_t announced = 0;
  if (content.size() >= 84)
    std::memcpy(&announced, content.data() + 80, sizeof announced);
  const bool is_binary = content.size() >= 84 && content.size() == 84 + 50 * std::size_t{announced};
  if (!is_binary && !content.starts_with("solid"))
    throw SurfaceError(fmt::format("{} is not STL: it does not begin with \"solid\", nor has it "
                                   "the length of the binary form",
                                   name));
  const std::vector<Corner> corners =
      is_binary ? read_binary(content, announced, name) : read_ascii(content, name);
  if (corners.empty() || corners.size() % 3 != 0)
    throw SurfaceError(
        fmt::format("{} holds {} corners, which are not triangles", name, corners.size()));

  TriangleMesh mesh;
  std::map<Corner, std::uint32_t> index;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const auto [vertex, is_new] =
        index.emplace(corners[k], static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new)
      mesh.vertices.push_back(corners[k]);
    if (k % 3 == 0)
      mesh.triangles.emplace_back();
    mesh.triangles.back()[k % 3] = vertex->second;
  }
  return mesh;
}

std::vector<std::array<double, 2>> read_polygon(const std::filesystem::path& path) {
  std::istringstream text(content_of(path));
  std::vector<std::array<double, 2>> corners;
  std::string line;
  for (std::size_t number = 1; std::getline(text, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    if (words >> std::ws; words.eof())
      continue;
    auto& corner = corners.emplace_back();
    std::string rest;
    if (!(words >> corner[0] >> corner[1]) || words >> rest || !std::isfinite(corner[0]) ||
        !std::isfinite(corner[1]))
      throw SurfaceError(
          fmt::format("{}:{}: a corner needs two finite numbers, x y", path.string(), number));
  }
  if (corners.size() < 3)
    throw SurfaceError(fmt::format("{} holds {} corners of a polygon, which needs at least 3",
                                   path.string(), corners.size()));
  return corners;
}

} // namespace kerf
