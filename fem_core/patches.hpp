// The division of the elements into patches, which decides where everything is kept.
#pragma once

#include "fem_core/kernels/patch_view.hpp"
#include "fem_core/mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::fem {

/// Periods along an axis that an image of Patches is moved by.
constexpr int periods_of(std::uint8_t image, int axis) {
  return image / (axis == 0 ? 1 : axis == 1 ? 3 : 9) % 3 - 1;
}

/// Elements that one kernel computes.
struct ElementGroup {
  Shape shape = Shape::quad4;
  std::vector<std::uint32_t> elements; // numbers in the mesh, all of this shape
};

/// Some hundred elements side by side in space, which fit the cache. What a patch computes does not
/// depend on who computes it, and what several patches add up is added in their order: so the bits
/// do not depend on the number of threads.
struct Patch {
  std::uint32_t group;
  std::uint32_t num_elements;
  std::uint32_t first_batch;  // in the arrays of the group, which hold batches of batch_size
  std::uint32_t first_row;    // the patch alone has the rows from here on
  std::uint32_t num_own;      // that many
  std::uint32_t first_shared; // in Patches::shared: its other rows
  std::uint32_t num_shared;
  std::uint32_t first_copy; // in arrays that hold the rows of all patches one behind the other

  std::uint32_t num_rows() const { return num_own + num_shared; }
};

/// Rows are the places of the nodes. First come plain nodes, which one patch alone has and finishes
/// while they are in the cache; then special ones, whose forces are summed over patches, or which
/// have a boundary condition, a load or a coupling; last those without any element.
class Patches {
public:
  Patches() = default;
  /// @param special  [num_nodes] nodes that must have a special row, besides shared ones
  template <int dim>
  Patches(const Mesh<dim>& mesh, std::vector<ElementGroup> groups,
          const std::vector<bool>& special);

  std::size_t num_rows() const { return node_of_row.size(); }
  std::size_t num_copies() const {
    return patches.empty() ? 0 : patches.back().first_copy + patches.back().num_rows();
  }
  std::size_t num_batches(std::size_t group) const { return element_of[group].size() / batch_size; }

  std::vector<ElementGroup> groups;
  std::vector<Patch> patches;
  std::uint32_t num_plain = 0;   // rows below are plain
  std::uint32_t num_special = 0; // those behind them that have elements
  std::vector<std::uint32_t> row_of_node, node_of_row;

  /// [groups][batches][batch_size] number in the mesh; what fills the last batch of a patch repeats
  /// an element of it, and is not counted.
  std::vector<std::vector<std::uint32_t>> element_of;
  /// [groups][batches][nodes][batch_size] row of the patch, own ones, then shared ones, times
  /// row_size<dim>: where it begins.
  std::vector<std::vector<std::uint16_t>> nodes;
  std::vector<std::uint32_t> shared; // special rows of each patch
  /// The image of a periodic mesh that a patch sees of a shared row: three digits to the base
  /// three, x lowest, of how many periods it is moved along each axis plus one.
  std::vector<std::uint8_t> image;
  /// Special row k has the entries of `shared` from first_part[k] on, in the order of the patches.
  std::vector<std::uint32_t> first_part, parts;
};

} // namespace kerf::fem
