#include "fem_core/mesh/rings.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace kerf::fem {
namespace {

std::uint32_t add_node(Mesh<2>& mesh, const Vec<2>& position) {
  mesh.positions.insert(mesh.positions.end(), {position[0], position[1]});
  return static_cast<std::uint32_t>(mesh.num_nodes() - 1);
}

/// A point of the square [-1, 1]², between the square itself and the disc that it can be bent to
/// without a kink: half of each keeps the angles at the corners of the square away from 180 and the
/// layers around it even. The disc's map: x = a sqrt(1 - b²/2), y = b sqrt(1 - a²/2).
Vec<2> rounded_square(double a, double b) {
  const Vec<2> disc = {a * std::sqrt(1.0 - 0.5 * b * b), b * std::sqrt(1.0 - 0.5 * a * a)};
  return 0.5 * (Vec<2>(a, b) + disc);
}

} // namespace

Loop add_rings(Mesh<2>& mesh, Loop loop, std::size_t num_layers,
               const std::function<Vec<2>(std::size_t layer, std::size_t k)>& position) {
  std::vector<std::uint32_t>& quads = mesh.blocks[0].nodes;
  for (std::size_t layer = 1; layer <= num_layers; ++layer) {
    Loop outer;
    for (std::size_t k = 0; k < loop.size(); ++k)
      outer.push_back(add_node(mesh, position(layer, k)));
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const std::size_t next = (k + 1) % loop.size();
      quads.insert(quads.end(), {loop[k], outer[k], outer[next], loop[next]});
    }
    loop = std::move(outer);
  }
  return loop;
}

Vec<2> circle_direction(std::size_t k, std::size_t count) {
  const double turns = static_cast<double>(k) / static_cast<double>(count) - 0.125;
  return {std::cos(2.0 * std::numbers::pi * turns), std::sin(2.0 * std::numbers::pi * turns)};
}

Loop add_circle(Mesh<2>& mesh, const Vec<2>& center, double radius, std::uint32_t count) {
  Loop loop;
  for (std::size_t k = 0; k < count; ++k)
    loop.push_back(add_node(mesh, center + radius * circle_direction(k, count)));
  return loop;
}

Loop add_disc(Mesh<2>& mesh, const Vec<2>& center, double radius, std::uint32_t layers,
              std::uint32_t count) {
  assert(count % 4 == 0 && mesh.blocks.size() == 1);
  const std::uint32_t cells = count / 4, nodes = cells + 1;
  const auto first = static_cast<std::uint32_t>(mesh.num_nodes());
  // Equal angles on the sides of the square, which are those of the circle around it.
  const auto at = [&](std::uint32_t k) {
    return std::tan(0.25 * std::numbers::pi * (2.0 * k / cells - 1.0));
  };
  for (std::uint32_t j = 0; j < nodes; ++j)
    for (std::uint32_t i = 0; i < nodes; ++i)
      add_node(mesh, center + 0.5 * radius * rounded_square(at(i), at(j)));
  const auto node = [&](std::uint32_t i, std::uint32_t j) { return first + j * nodes + i; };
  std::vector<std::uint32_t>& quads = mesh.blocks[0].nodes;
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i)
      quads.insert(quads.end(), {node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});

  Loop square;
  for (std::uint32_t k = 0; k < cells; ++k)
    square.push_back(node(cells, k));
  for (std::uint32_t k = 0; k < cells; ++k)
    square.push_back(node(cells - k, cells));
  for (std::uint32_t k = 0; k < cells; ++k)
    square.push_back(node(0, cells - k));
  for (std::uint32_t k = 0; k < cells; ++k)
    square.push_back(node(k, 0));
  return add_rings(mesh, square, layers, [&](std::size_t layer, std::size_t k) -> Vec<2> {
    const double share = static_cast<double>(layer) / layers;
    return (1.0 - share) * mesh.position(square[k]) +
           share * (center + radius * circle_direction(k, count));
  });
}

} // namespace kerf::fem
