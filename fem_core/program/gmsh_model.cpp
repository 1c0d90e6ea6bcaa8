#include "fem_core/program/gmsh_model.hpp"

#include <gmsh.h>

namespace kerf::fem {

std::map<int, GmshCells> gmsh_cells(int dimension, const std::vector<int>& entities) {
  std::map<int, GmshCells> cells;
  for (const int entity : entities) {
    std::vector<int> types;
    std::vector<std::vector<Number>> numbers, nodes;
    gmsh::model::mesh::getElements(types, numbers, nodes, dimension, entity);
    for (std::size_t k = 0; k < types.size(); ++k) {
      GmshCells& own = cells[types[k]];
      own.numbers.insert(own.numbers.end(), numbers[k].begin(), numbers[k].end());
      own.nodes.insert(own.nodes.end(), nodes[k].begin(), nodes[k].end());
    }
  }
  return cells;
}

std::vector<GmshGroup> gmsh_groups(int dimension) {
  std::vector<GmshGroup> groups;
  gmsh::vectorpair found;
  gmsh::model::getPhysicalGroups(found, dimension);
  for (const auto& [d, number] : found) {
    GmshGroup& group = groups.emplace_back(GmshGroup{number, "", {}});
    gmsh::model::getPhysicalName(d, number, group.name);
    if (group.name.empty())
      group.name = std::to_string(number);
    gmsh::model::getEntitiesForPhysicalGroup(d, number, group.entities);
  }
  return groups;
}

} // namespace kerf::fem
