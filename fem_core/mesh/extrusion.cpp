#include "fem_core/mesh/extrusion.hpp"

#include "fem_core/mesh/axis.hpp"

#include <cassert>

namespace kerf::fem {
namespace {

constexpr std::uint8_t back = 4, front = 5; // sides of hex8; its others are those of the quad4

/// The numbers of each layer after those of the one before.
template <class Sets> Sets repeated(const Sets& sets, std::size_t stride, std::size_t layers) {
  Sets result;
  for (const auto& [tag, members] : sets)
    for (std::size_t layer = 0; layer < layers; ++layer)
      for (const std::uint32_t member : members)
        result[tag].push_back(static_cast<std::uint32_t>(layer * stride + member));
  return result;
}

} // namespace

Mesh<3> extrude(const Mesh<2>& plane, std::span<const double> z, const std::string& lower,
                const std::string& upper) {
  assert(plane.blocks.size() == 1 && plane.blocks[0].shape == Shape::quad4 && z.size() > 1);
  const std::size_t layers = z.size() - 1;
  const std::size_t nodes = plane.num_nodes(), quads = plane.num_elements();
  check_numbering(8.0 * static_cast<double>(quads) * static_cast<double>(layers));
  check_numbering(static_cast<double>(nodes) * static_cast<double>(z.size()));

  Mesh<3> mesh;
  mesh.period.length.head<2>() = plane.period.length;
  mesh.positions.reserve(3 * nodes * z.size());
  for (const double height : z)
    for (std::size_t n = 0; n < nodes; ++n)
      mesh.positions.insert(mesh.positions.end(),
                            {plane.positions[2 * n], plane.positions[2 * n + 1], height});

  Block block{.shape = Shape::hex8, .nodes = {}};
  block.nodes.reserve(8 * quads * layers);
  for (std::size_t layer = 0; layer < layers; ++layer)
    for (std::size_t e = 0; e < quads; ++e)
      for (const std::size_t side : {layer, layer + 1})
        for (const std::uint32_t node : plane.nodes_of_element(e))
          block.nodes.push_back(static_cast<std::uint32_t>(side * nodes + node));
  mesh.blocks.push_back(std::move(block));

  for (const auto& [tag, faces] : plane.boundary)
    for (std::size_t layer = 0; layer < layers; ++layer)
      for (const Face& face : faces)
        mesh.boundary[tag].push_back(
            {static_cast<std::uint32_t>(layer * quads + face.element), face.side});
  for (std::size_t e = 0; e < quads; ++e) {
    mesh.boundary[lower].push_back({static_cast<std::uint32_t>(e), back});
    mesh.boundary[upper].push_back({static_cast<std::uint32_t>((layers - 1) * quads + e), front});
  }
  mesh.regions = repeated(plane.regions, quads, layers);
  mesh.node_sets = repeated(plane.node_sets, nodes, z.size());
  return mesh;
}

} // namespace kerf::fem
