// A folder for mesh files, and Gmsh to write them.
#pragma once

#include "fem_core/program/mesh_file.hpp"
#include "tests/unit/fem_mesh_checks.hpp"

#include <gmsh.h>

#include <array>
#include <fstream>

namespace kerf::fem {

constexpr int gmsh_type(Shape shape) {
  return std::array{2, 3, 4, 5}[static_cast<std::size_t>(shape)];
}

inline std::vector<std::size_t>
numbers(std::span<const std::uint32_t> nodes) { // Gmsh counts from 1
  std::vector<std::size_t> result;
  for (const std::uint32_t node : nodes)
    result.push_back(node + 1);
  return result;
}

class MeshFileTest : public testing::Test {
protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  std::filesystem::path written(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }

  /// Has the call done with the Gmsh library.
  template <class Call> static void with_gmsh(Call call) {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    call();
    gmsh::finalize();
  }

  /// Gives a mesh to Gmsh and lets it write a file.
  /// @param change  what else is done with the model before
  template <int dim, class Change>
  std::filesystem::path save(const Mesh<dim>& mesh, const std::string& name, Change change) const {
    with_gmsh([&] {
      add(mesh);
      change();
      gmsh::write(path(name).string());
    });
    return path(name);
  }

private:
  /// Every region and every tag has an entity and a group of its own.
  template <int dim> static void add(const Mesh<dim>& mesh) {
    gmsh::model::add("mesh");
    std::map<std::string, std::vector<std::uint32_t>> regions = mesh.regions;
    if (regions.empty())
      for (std::uint32_t e = 0; e < mesh.num_elements(); ++e)
        regions["body"].push_back(e);
    int entity = 0;
    for (const auto& [tag, elements] : regions) {
      gmsh::model::addDiscreteEntity(dim, ++entity);
      if (entity == 1)
        add_nodes(mesh);
      for (const std::uint32_t e : elements)
        gmsh::model::mesh::addElementsByType(entity, gmsh_type(mesh.shape_of(e)), {e + 1},
                                             numbers(mesh.nodes_of_element(e)));
      gmsh::model::setPhysicalName(dim, gmsh::model::addPhysicalGroup(dim, {entity}), tag);
    }
    std::size_t element = mesh.num_elements();
    for (const auto& [tag, faces] : mesh.boundary) {
      gmsh::model::addDiscreteEntity(dim - 1, ++entity);
      for (const Face& face : faces) {
        const std::vector<std::size_t> nodes = numbers(mesh.nodes_of_face(face));
        gmsh::model::mesh::addElementsByType(entity, static_cast<int>(nodes.size()) - 1,
                                             {++element}, nodes); // line, triangle, quad: 1, 2, 3
      }
      gmsh::model::setPhysicalName(dim - 1, gmsh::model::addPhysicalGroup(dim - 1, {entity}), tag);
    }
    for (const auto& [tag, nodes] : mesh.node_sets) {
      std::vector<int> entities;
      for (const std::uint32_t node : nodes) {
        gmsh::model::addDiscreteEntity(0, ++entity);
        gmsh::model::mesh::addElementsByType(entity, 15, {++element}, {node + 1});
        entities.push_back(entity);
      }
      gmsh::model::setPhysicalName(0, gmsh::model::addPhysicalGroup(0, entities), tag);
    }
  }

  template <int dim> static void add_nodes(const Mesh<dim>& mesh) {
    std::vector<std::size_t> nodes;
    std::vector<double> x;
    for (std::size_t node = 0; node < mesh.num_nodes(); ++node) {
      nodes.push_back(node + 1);
      for (std::size_t a = 0; a < 3; ++a)
        x.push_back(a < dim ? mesh.positions[node * dim + a] : 0.25);
    }
    gmsh::model::mesh::addNodes(dim, 1, nodes, x);
  }

  static std::filesystem::path new_folder() {
    char name[] = "/tmp/kerf_mesh_XXXXXX";
    return mkdtemp(name);
  }
  std::filesystem::path folder_ = new_folder();
};

/// A plate with the radius 20.
inline const std::string disc_geometry = R"(SetFactory("OpenCASCADE");
Disk(1) = {0, 0, 0, 20};
Physical Surface("plate") = {1};
Physical Curve("rim") = {1};
)";

} // namespace kerf::fem
