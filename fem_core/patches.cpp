#include "fem_core/patches.hpp"

#include "common/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace kerf::fem {
namespace {

constexpr std::uint8_t at_home = 1 + 3 + 9;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Elements of a patch: as many as keep the rows of its nodes in the cache of one core. Without any
/// common node 16 bits still tell where each row begins.
constexpr std::size_t patch_size(Shape shape) {
  switch (shape) {
  case Shape::hex8:
    return 1024;
  case Shape::tet4:
    return 4096;
  case Shape::quad4:
  case Shape::tri3:
    break;
  }
  return 2048;
}

/// The image of each corner of an element.
template <int dim>
std::array<std::uint8_t, 8> images_of(const Mesh<dim>& mesh, std::uint32_t element) {
  std::array<std::uint8_t, 8> images;
  images.fill(at_home);
  if ((mesh.period.length.array() == 0.0).all())
    return images;
  const auto nodes = mesh.nodes_of_element(element);
  const auto corners = mesh.corners(element);
  for (std::size_t c = 0; c < nodes.size(); ++c) {
    int digit = 1;
    for (int a = 0; a < dim; ++a, digit *= 3)
      if (mesh.period.length[a] > 0.0)
        images[c] = static_cast<std::uint8_t>(
            images[c] + digit * std::lround((corners(a, static_cast<Eigen::Index>(c)) -
                                             mesh.position(nodes[c])[a]) /
                                            mesh.period.length[a]));
  }
  return images;
}

/// The elements of a patch in the order of their lanes. Simplices of one vector come from all over
/// the patch: neighbours share nodes, and their sums would wait for one another.
std::vector<std::uint32_t> in_lanes(std::span<const std::uint32_t> elements, Shape shape) {
  const std::size_t n = elements.size(), batches = (n + batch_size - 1) / batch_size;
  std::vector<std::uint32_t> lanes(batches * batch_size);
  const bool spread = shape == Shape::tri3 || shape == Shape::tet4;
  const std::size_t full = n - (batches - 1) * batch_size; // lanes that the last batch fills
  for (std::size_t b = 0; b < batches; ++b)
    for (std::size_t l = 0; l < batch_size; ++l) {
      std::size_t k = b * batch_size + l;
      if (spread)
        k = l * (batches - 1) + std::min(l, full) + b;
      const bool filled = b + 1 < batches || l < full;
      lanes[b * batch_size + l] =
          filled ? elements[k] : lanes[b * batch_size]; // computed, but not counted
    }
  return lanes;
}

} // namespace

template <int dim>
Patches::Patches(const Mesh<dim>& mesh, std::vector<ElementGroup> all,
                 const std::vector<bool>& special)
    : groups(std::move(all)), element_of(groups.size()), nodes(groups.size()) {
  // Patches, and who has each node.
  std::vector<std::uint32_t> patch_of(mesh.num_nodes(), none);
  std::vector<bool> is_special = special;
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    auto& elements = groups[g].elements;
    std::vector<Vec<dim>> centres;
    for (const std::uint32_t e : elements)
      centres.push_back(mesh.corners(e).rowwise().mean());
    std::vector<std::uint32_t> sorted;
    for (const std::uint32_t k : spatial_order<dim>(centres))
      sorted.push_back(elements[k]);
    elements = std::move(sorted);
    const std::size_t size = patch_size(groups[g].shape);
    for (std::size_t first = 0; first < elements.size(); first += size) {
      const auto of_patch =
          std::span(elements).subspan(first, std::min(size, elements.size() - first));
      const auto lanes = in_lanes(of_patch, groups[g].shape);
      const auto number = static_cast<std::uint32_t>(patches.size());
      patches.push_back({.group = g,
                         .num_elements = static_cast<std::uint32_t>(of_patch.size()),
                         .first_batch = static_cast<std::uint32_t>(num_batches(g)),
                         .first_row = 0,
                         .num_own = 0,
                         .first_shared = 0,
                         .num_shared = 0,
                         .first_copy = 0});
      element_of[g].insert(element_of[g].end(), lanes.begin(), lanes.end());
      for (const std::uint32_t e : of_patch) {
        const auto images = images_of(mesh, e);
        const auto corners = mesh.nodes_of_element(e);
        for (std::size_t c = 0; c < corners.size(); ++c) {
          const std::uint32_t a = corners[c];
          if ((patch_of[a] != none && patch_of[a] != number) || images[c] != at_home)
            is_special[a] = true;
          patch_of[a] = number;
        }
      }
    }
  }

  // Rows: plain nodes by patch as they are met, then special ones, then those without elements.
  row_of_node.assign(mesh.num_nodes(), none);
  const auto for_nodes = [&](const Patch& patch, auto&& act) {
    const auto count = static_cast<std::size_t>(nodes_of(groups[patch.group].shape));
    const std::size_t first = std::size_t{patch.first_batch} * batch_size;
    const std::size_t end = first + (patch.num_elements + batch_size - 1) / batch_size * batch_size;
    for (std::size_t k = first; k < end; ++k)
      for (std::size_t c = 0; c < count; ++c)
        act(mesh.nodes_of_element(element_of[patch.group][k])[c], k, c);
  };
  const auto give_row = [&](std::uint32_t a) {
    row_of_node[a] = static_cast<std::uint32_t>(node_of_row.size());
    node_of_row.push_back(a);
  };
  for (Patch& patch : patches) {
    patch.first_row = static_cast<std::uint32_t>(node_of_row.size());
    for_nodes(patch, [&](std::uint32_t a, std::size_t, std::size_t) {
      if (!is_special[a] && row_of_node[a] == none)
        give_row(a);
    });
    patch.num_own = static_cast<std::uint32_t>(node_of_row.size()) - patch.first_row;
  }
  num_plain = static_cast<std::uint32_t>(node_of_row.size());

  // Among the shared ones of a patch, by node and image.
  std::map<std::pair<std::uint32_t, std::uint8_t>, std::uint32_t> place;
  std::uint32_t copies = 0;
  for (Patch& patch : patches) {
    patch.first_copy = copies;
    patch.first_shared = static_cast<std::uint32_t>(shared.size());
    const auto count = static_cast<std::size_t>(nodes_of(groups[patch.group].shape));
    auto& of_group = nodes[patch.group];
    of_group.resize(of_group.size() +
                    (patch.num_elements + batch_size - 1) / batch_size * batch_size * count);
    place.clear();
    for_nodes(patch, [&](std::uint32_t a, std::size_t k, std::size_t c) {
      if (row_of_node[a] == none)
        give_row(a);
      const std::uint32_t row = row_of_node[a];
      std::uint32_t local = row - patch.first_row;
      if (row >= num_plain) {
        const std::uint8_t seen = images_of(mesh, element_of[patch.group][k])[c];
        const auto [entry, is_new] =
            place.try_emplace({a, seen}, static_cast<std::uint32_t>(place.size()));
        if (is_new) {
          shared.push_back(row);
          image.push_back(seen);
        }
        local = patch.num_own + entry->second;
      }
      of_group[(k / batch_size * count + c) * batch_size + k % batch_size] =
          static_cast<std::uint16_t>(local * row_size<dim>);
    });
    patch.num_shared = static_cast<std::uint32_t>(place.size());
    copies += patch.num_rows();
  }
  num_special = static_cast<std::uint32_t>(node_of_row.size()) - num_plain;
  for (std::uint32_t a = 0; a < mesh.num_nodes(); ++a)
    if (row_of_node[a] == none)
      give_row(a);

  first_part.assign(num_special + 1, 0);
  for (const std::uint32_t row : shared)
    ++first_part[row - num_plain + 1];
  for (std::size_t k = 0; k < num_special; ++k)
    first_part[k + 1] += first_part[k];
  parts.resize(shared.size());
  std::vector<std::uint32_t> next(first_part.begin(), first_part.end() - 1);
  for (std::uint32_t k = 0; k < shared.size(); ++k)
    parts[next[shared[k] - num_plain]++] = k;
}

template Patches::Patches(const Mesh<2>&, std::vector<ElementGroup>, const std::vector<bool>&);
template Patches::Patches(const Mesh<3>&, std::vector<ElementGroup>, const std::vector<bool>&);

} // namespace kerf::fem
