// What Gmsh's model has: elements and physical groups.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace kerf::fem {

using Number = std::size_t; // of a node or an element in the file

/// Elements of one type.
struct GmshCells {
  std::vector<Number> numbers; // [size]
  std::vector<Number> nodes;   // [size][nodes of one]

  std::span<const Number> nodes_of(std::size_t k) const {
    const std::size_t count = nodes.size() / numbers.size();
    return std::span(nodes).subspan(k * count, count);
  }
};

/// The elements of some entities, or of all, by Gmsh's number of their type.
std::map<int, GmshCells> gmsh_cells(int dimension, const std::vector<int>& entities = {-1});

struct GmshGroup {
  int number;
  std::string name; // the number of a group without a name
  std::vector<int> entities;
};

std::vector<GmshGroup> gmsh_groups(int dimension);

} // namespace kerf::fem
