#include "fem_core/mesh.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <numeric>
#include <set>

namespace kerf::fem {
namespace {

/// Calls visit(faces) or visit(members) for whatever has the tag.
template <class Sets, class Visit>
void with_tag(const Sets& sets, const std::string& tag, Visit visit) {
  if (const auto found = sets.find(tag); found != sets.end())
    visit(found->second);
}

template <int dim> std::set<std::string> tags_of(const Mesh<dim>& mesh) {
  std::set<std::string> tags;
  for (const auto& [tag, faces] : mesh.boundary)
    tags.insert(tag);
  for (const auto& [tag, elements] : mesh.regions)
    tags.insert(tag);
  for (const auto& [tag, nodes] : mesh.node_sets)
    tags.insert(tag);
  return tags;
}

} // namespace

template <int dim> std::size_t Mesh<dim>::num_elements() const {
  std::size_t size = 0;
  for (const Block& block : blocks)
    size += block.size();
  return size;
}

template <int dim> Shape Mesh<dim>::shape_of(std::size_t element) const {
  for (const Block& block : blocks) {
    if (element < block.size())
      return block.shape;
    element -= block.size();
  }
  assert(false);
  return {};
}

template <int dim>
std::span<const std::uint32_t> Mesh<dim>::nodes_of_element(std::size_t element) const {
  for (const Block& block : blocks) {
    const auto count = static_cast<std::size_t>(nodes_of(block.shape));
    if (element < block.size())
      return std::span(block.nodes).subspan(element * count, count);
    element -= block.size();
  }
  assert(false);
  return {};
}

template <int dim> std::vector<std::uint32_t> Mesh<dim>::nodes_of_face(const Face& face) const {
  const std::span<const std::uint32_t> nodes = nodes_of_element(face.element);
  std::vector<std::uint32_t> result;
  for (const std::uint8_t a : side_nodes(shape_of(face.element), face.side))
    result.push_back(nodes[a]);
  return result;
}

template <int dim>
Eigen::Matrix<double, dim, Eigen::Dynamic, 0, dim, 8>
Mesh<dim>::corners(std::size_t element) const {
  const std::span<const std::uint32_t> nodes = nodes_of_element(element);
  Eigen::Matrix<double, dim, Eigen::Dynamic, 0, dim, 8> result(
      dim, static_cast<Eigen::Index>(nodes.size()));
  const Vec<dim> first = position(nodes[0]);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    result.col(static_cast<Eigen::Index>(a)) = first + period.shortest(position(nodes[a]) - first);
  return result;
}

template <int dim>
std::vector<std::uint32_t> nodes_with_tag(const Mesh<dim>& mesh, const std::string& tag,
                                          const std::string& key) {
  if (tag == "all") {
    std::vector<std::uint32_t> nodes(mesh.num_nodes());
    std::iota(nodes.begin(), nodes.end(), 0u);
    return nodes;
  }
  std::set<std::string> tags = tags_of(mesh);
  if (!tags.contains(tag)) {
    std::vector<std::string> known(tags.begin(), tags.end());
    known.insert(known.begin(), "all");
    throw InputError(key, fmt::format("the mesh has no tag \"{}\"; its tags are {}", tag,
                                      fmt::join(known, ", ")));
  }
  std::vector<std::uint32_t> nodes;
  const auto add = [&](const auto& members) {
    nodes.insert(nodes.end(), members.begin(), members.end());
  };
  with_tag(mesh.boundary, tag, [&](const std::vector<Face>& faces) {
    for (const Face& face : faces)
      add(mesh.nodes_of_face(face));
  });
  with_tag(mesh.regions, tag, [&](const std::vector<std::uint32_t>& elements) {
    for (const std::uint32_t element : elements)
      add(mesh.nodes_of_element(element));
  });
  with_tag(mesh.node_sets, tag, add);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

template struct Mesh<2>;
template struct Mesh<3>;
template std::vector<std::uint32_t> nodes_with_tag<2>(const Mesh<2>&, const std::string&,
                                                      const std::string&);
template std::vector<std::uint32_t> nodes_with_tag<3>(const Mesh<3>&, const std::string&,
                                                      const std::string&);

} // namespace kerf::fem
