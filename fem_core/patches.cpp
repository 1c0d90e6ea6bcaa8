#include "fem_core/patches.hpp"

#include "common/spatial_order.hpp"

#include <algorithm>
#include <limits>
#include <cstdlib>

namespace kerf::fem {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Elements of a patch: as many as keep the rows of its nodes in the cache of one core.
std::size_t patch_size(Shape shape) {
  if (getenv("PS")) return atoi(getenv("PS"));
  switch (shape) {
  case Shape::hex8:
    return 1024;
  case Shape::tet4:
    return 4096;
  case Shape::quad4:
    return 1024;
  case Shape::tri3:
    break;
  }
  return 2048;
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
      for (const std::uint32_t e : of_patch)
        for (const std::uint32_t a : mesh.nodes_of_element(e)) {
          if (patch_of[a] != none && patch_of[a] != number)
            is_special[a] = true;
          patch_of[a] = number;
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

  std::vector<std::uint32_t> place(mesh.num_nodes(), none); // among the shared ones of its patch
  std::uint32_t copies = 0;
  for (Patch& patch : patches) {
    patch.first_copy = copies;
    patch.first_shared = static_cast<std::uint32_t>(shared.size());
    const auto count = static_cast<std::size_t>(nodes_of(groups[patch.group].shape));
    auto& of_group = nodes[patch.group];
    of_group.resize(of_group.size() + (patch.num_elements + batch_size - 1) / batch_size *
                                          batch_size * count);
    std::vector<std::uint32_t> met;
    for_nodes(patch, [&](std::uint32_t a, std::size_t k, std::size_t c) {
      if (row_of_node[a] == none)
        give_row(a);
      const std::uint32_t row = row_of_node[a];
      std::uint32_t local = row - patch.first_row;
      if (row >= num_plain) {
        if (place[a] == none) {
          place[a] = static_cast<std::uint32_t>(met.size());
          met.push_back(a);
          shared.push_back(row);
        }
        local = patch.num_own + place[a];
      }
      of_group[(k / batch_size * count + c) * batch_size + k % batch_size] =
          static_cast<std::uint16_t>(local);
    });
    patch.num_shared = static_cast<std::uint32_t>(met.size());
    copies += patch.num_rows();
    for (const std::uint32_t a : met)
      place[a] = none;
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
