#include "fem_core/program/gmsh_reader.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/mesh/orientation.hpp"
#include "fem_core/program/gmsh_model.hpp"
#include "fem_core/program/gmsh_session.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <unordered_map>

namespace kerf::fem {
namespace {

using NodeKey = std::array<std::uint32_t, 4>; // nodes of a side, ascending

NodeKey key_of(std::span<const std::uint32_t> nodes) {
  NodeKey key;
  key.fill(std::numeric_limits<std::uint32_t>::max());
  std::copy(nodes.begin(), nodes.end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

template <int dim> class Reader {
public:
  Reader(const MeshFile& file, bool is_geometry) : file_(file), is_geometry_(is_geometry) {}

  Mesh<dim> read() {
    const std::map<int, GmshCells> body = read_body();
    number_nodes(body);
    for (const auto& [type, cells] : body) // in the order of Shape, as Gmsh's types are
      add_block(shape_of(type), cells);
    orient(mesh_);
    read_regions();
    read_boundary();
    read_node_sets();
    return std::move(mesh_);
  }

private:
  [[noreturn]] void fail(const std::string& sentence) const {
    throw InputError("mesh.file", file_.path.string() + ": " + sentence);
  }

  /// The elements that have to be; of a geometry with groups, those that Gmsh would save.
  std::map<int, GmshCells> read_body() const {
    std::vector<int> entities;
    for (const GmshGroup& group : gmsh_groups(dim)) {
      entities.insert(entities.end(), group.entities.begin(), group.entities.end());
      if (group.name == "all")
        fail("a group has the name \"all\", which means every node; give it another name");
    }
    std::sort(entities.begin(), entities.end());
    entities.erase(std::unique(entities.begin(), entities.end()), entities.end());
    const std::map<int, GmshCells> body =
        is_geometry_ && !entities.empty() ? gmsh_cells(dim, entities) : gmsh_cells(dim);
    if (dim == 2 && !gmsh_cells(3).empty())
      fail("it has elements of volume; give case.dimension = 3, or a mesh of surfaces");
    if (body.empty())
      fail(fmt::format("it has no elements of {0}; mesh it in {1}D{2}. When there are physical "
                       "groups, Gmsh saves their elements only: is there one of {0}s?",
                       dim == 2 ? "surface" : "volume", dim,
                       dim == 3 ? ", or give case.dimension = 2" : ""));
    return body;
  }

  Shape shape_of(int type) const {
    switch (type) { // Gmsh reference manual, "MSH file format"
    case 2:
      return Shape::tri3;
    case 3:
      return Shape::quad4;
    case 4:
      return Shape::tet4;
    case 5:
      return Shape::hex8;
    default:
      break;
    }
    std::string name;
    int dimension, order, num_nodes, num_primary;
    std::vector<double> coordinates;
    gmsh::model::mesh::getElementProperties(type, name, dimension, order, num_nodes, coordinates,
                                            num_primary);
    fail(fmt::format("it has elements of type \"{}\"; kerf has {}. {}", name,
                     dim == 2 ? "tri3 and quad4" : "tet4 and hex8",
                     order > 1 ? "Give Mesh.ElementOrder = 1 in Gmsh"
                               : "Mesh the body with these only"));
  }

  void number_nodes(const std::map<int, GmshCells>& body) {
    std::vector<Number> used;
    for (const auto& [type, cells] : body)
      used.insert(used.end(), cells.nodes.begin(), cells.nodes.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (const Number number : used)
      node_.emplace(number, static_cast<std::uint32_t>(node_.size()));

    std::vector<Number> numbers;
    std::vector<double> x, none;
    gmsh::model::mesh::getNodes(numbers, x, none, -1, -1, false, false);
    mesh_.positions.resize(dim * used.size());
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (std::size_t k = 0; k < numbers.size(); ++k)
      if (const auto found = node_.find(numbers[k]); found != node_.end()) {
        for (std::size_t a = 0; a < dim; ++a)
          mesh_.positions[dim * found->second + a] = file_.scale * x[3 * k + a];
        lowest = std::min(lowest, file_.scale * x[3 * k + 2]);
        highest = std::max(highest, file_.scale * x[3 * k + 2]);
      }
    const auto [least, most] = std::minmax_element(mesh_.positions.begin(), mesh_.positions.end());
    if (dim == 2 && highest - lowest > 1e-9 * (*most - *least))
      fail(fmt::format("its z runs from {:.6g} to {:.6g} m; a mesh of the plane must have the same "
                       "z everywhere",
                       lowest, highest));
  }

  /// Elements in the order of their numbers. In a file of version 2.2 one of two groups stands
  /// there twice; the second is taken as another number of the first.
  void add_block(Shape shape, const GmshCells& cells) {
    std::vector<std::size_t> order(cells.numbers.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return cells.numbers[a] < cells.numbers[b]; });
    std::map<std::vector<Number>, std::uint32_t> known;
    const bool can_repeat = has_entity_of_two_groups();
    auto next = static_cast<std::uint32_t>(mesh_.num_elements());
    Block block{.shape = shape, .nodes = {}};
    for (const std::size_t k : order) {
      const std::span<const Number> nodes = cells.nodes_of(k);
      if (can_repeat) {
        const auto [found, is_new] = known.try_emplace({nodes.begin(), nodes.end()}, next);
        if (!is_new) {
          element_[cells.numbers[k]] = found->second;
          continue;
        }
      }
      element_[cells.numbers[k]] = next++;
      for (const Number node : nodes)
        block.nodes.push_back(node_.at(node));
    }
    mesh_.blocks.push_back(std::move(block));
  }

  bool has_entity_of_two_groups() const {
    std::set<int> seen;
    for (const GmshGroup& group : gmsh_groups(dim))
      for (const int entity : group.entities)
        if (!seen.insert(entity).second)
          return true;
    return false;
  }

  void read_regions() {
    for (const GmshGroup& group : gmsh_groups(dim)) {
      std::vector<std::uint32_t>& region = mesh_.regions[group.name];
      for (const auto& [type, cells] : gmsh_cells(dim, group.entities))
        for (const Number number : cells.numbers)
          region.push_back(element_.at(number));
      std::sort(region.begin(), region.end());
      region.erase(std::unique(region.begin(), region.end()), region.end());
    }
  }

  void read_boundary() {
    std::map<NodeKey, std::optional<Face>> sides; // of the groups
    std::vector<bool> is_on_side(mesh_.num_nodes());
    const auto groups = gmsh_groups(dim - 1);
    for (const GmshGroup& group : groups)
      for_each_side(group, [&](Number, const NodeKey& key) {
        sides[key];
        for (const std::uint32_t node : key)
          if (node < is_on_side.size())
            is_on_side[node] = true;
      });
    if (sides.empty())
      return;
    for (std::uint32_t element = 0; element < mesh_.num_elements(); ++element)
      for (int side = 0; side < sides_of(mesh_.shape_of(element)); ++side) {
        const std::vector<std::uint32_t> nodes =
            mesh_.nodes_of_face({element, static_cast<std::uint8_t>(side)});
        if (!std::all_of(nodes.begin(), nodes.end(), [&](auto n) { return is_on_side[n]; }))
          continue;
        if (const auto found = sides.find(key_of(nodes));
            found != sides.end() && !found->second) // the first of two
          found->second = Face{element, static_cast<std::uint8_t>(side)};
      }
    std::map<std::string, std::set<std::pair<std::uint32_t, std::uint8_t>>> faces_by_name;
    for (const GmshGroup& group : groups)
      for_each_side(group, [&](Number number, const NodeKey& key) {
        const std::optional<Face>& face = sides.at(key);
        if (!face)
          fail_without_side(group, number);
        faces_by_name[group.name].emplace(face->element, face->side);
      });
    for (const auto& [name, faces] : faces_by_name)
      for (const auto& [element, side] : faces)
        mesh_.boundary[name].push_back({element, side});
  }

  [[noreturn]] void fail_without_side(const GmshGroup& group, Number number) const {
    fail(fmt::format("element {} of the group \"{}\" is no side of an element of the body; mesh "
                     "both together, and join surfaces that touch with Coherence or "
                     "BooleanFragments",
                     number, group.name));
  }

  template <class Visit> void for_each_side(const GmshGroup& group, Visit visit) const {
    for (const auto& [type, cells] : gmsh_cells(dim - 1, group.entities))
      for (std::size_t k = 0; k < cells.numbers.size(); ++k) {
        std::vector<std::uint32_t> nodes;
        for (const Number number : cells.nodes_of(k))
          if (const auto found = node_.find(number); found != node_.end())
            nodes.push_back(found->second);
        if (nodes.size() != cells.nodes_of(k).size() || nodes.size() > 4)
          fail_without_side(group, cells.numbers[k]);
        visit(cells.numbers[k], key_of(nodes));
      }
  }

  void read_node_sets() {
    for (int dimension = 0; dimension < dim - 1; ++dimension)
      for (const GmshGroup& group : gmsh_groups(dimension)) {
        std::vector<Number> numbers;
        std::vector<double> x;
        gmsh::model::mesh::getNodesForPhysicalGroup(dimension, group.number, numbers, x);
        std::vector<std::uint32_t>& set = mesh_.node_sets[group.name];
        for (const Number number : numbers) {
          const auto found = node_.find(number);
          if (found == node_.end())
            fail(fmt::format("node {} of the group \"{}\" belongs to no element of the body; put "
                             "the point into it, in Gmsh with Point{{…}} In Surface{{…}}",
                             number, group.name));
          set.push_back(found->second);
        }
        std::sort(set.begin(), set.end());
        set.erase(std::unique(set.begin(), set.end()), set.end());
      }
  }

  const MeshFile& file_;
  bool is_geometry_;
  Mesh<dim> mesh_;
  std::unordered_map<Number, std::uint32_t> node_, element_;
};

template <int dim> Mesh<dim> read_with_gmsh(const MeshFile& file, bool is_geometry) {
  GmshSession session;
  gmsh::option::setString("Geometry.OCCTargetUnit", "M");
  gmsh::open(file.path.string());
  session.check(file.path);
  if (is_geometry) {
    if (file.element_size)
      gmsh::option::setNumber("Mesh.MeshSizeMax", *file.element_size / file.scale);
    gmsh::model::mesh::generate(dim);
    session.check(file.path);
  }
  return Reader<dim>(file, is_geometry).read();
}

} // namespace
} // namespace kerf::fem

void kerf_gmsh_read_2(const kerf::fem::MeshFile& file, bool is_geometry, kerf::fem::Mesh<2>& mesh) {
  mesh = kerf::fem::read_with_gmsh<2>(file, is_geometry);
}
void kerf_gmsh_read_3(const kerf::fem::MeshFile& file, bool is_geometry, kerf::fem::Mesh<3>& mesh) {
  mesh = kerf::fem::read_with_gmsh<3>(file, is_geometry);
}
