#include "dem_core/program/read_clusters.hpp"

#include "dem_core/program/read_selection.hpp"
#include "dem_core/program/read_table.hpp"

#include <stdexcept>
#include <string>
#include <utility>

namespace kerf::dem {

namespace {

template <int dim> auto read_inertia(const Node& node) {
  node.must_hold(dim == 2 ? 1 : 6, dim == 2 ? "number" : "numbers: xx yy zz yz xz xy");
  Eigen::Matrix<double, rotations<dim>, rotations<dim>> inertia;
  if constexpr (dim == 2) {
    inertia << node[0].number();
  } else {
    const auto at = [&](std::size_t k) { return node[k].number(); };
    inertia << at(0), at(5), at(4), at(5), at(1), at(3), at(4), at(3), at(2);
  }
  return inertia;
}

template <int dim> ClusterSettings<dim> read_cluster(const Node& node) {
  ClusterSettings<dim> cluster;
  cluster.name = node.key();
  const std::map<std::string, bool> motions = {{"free", true}, {"prescribed", false}};
  cluster.is_free = node["motion"].is_null() || node["motion"].one_of(motions);
  if (!node["mass"].is_null())
    cluster.mass = node["mass"].positive();
  if (!node["center"].is_null())
    cluster.centre = node["center"].vector<dim>();
  if (!node["inertia"].is_null())
    cluster.inertia = read_inertia<dim>(node["inertia"]);
  cluster.has_reference = !node["reference"].is_null();
  cluster.motion.reference = node["reference"].vector_or_zero<dim>();
  const Vec<dim> velocity = node["velocity"].vector_or_zero<dim>();
  if (node["velocities"].is_null())
    for (int a = 0; a < dim; ++a)
      cluster.motion.velocity[static_cast<std::size_t>(a)] = velocity[a];
  else
    cluster.motion.velocity = read_vector_table<dim>(node["velocities"]);
  if (const Node rotation = node["rotation"]; !rotation.is_null()) {
    cluster.motion.rotation_rate = read_value_or_table(rotation["rate"], rotation["rates"]);
    if constexpr (dim == 3)
      cluster.motion.axis = rotation["axis"].vector<3>();
    if (!(cluster.motion.axis.norm() > 0.0))
      rotation["axis"].fail("the axis has no length", "give a direction");
  }
  return cluster;
}

} // namespace

template <int dim>
std::vector<ClusterSettings<dim>> read_clusters(const Node& list, std::size_t particles) {
  std::vector<ClusterSettings<dim>> clusters;
  for (std::size_t k = 0; k < list.size(); ++k) {
    ClusterSettings<dim> cluster = read_cluster<dim>(list[k]);
    if (!list[k]["file"].is_null()) {
      for (auto& [number, members] : read_groups(list[k]["file"], particles)) {
        cluster.name = fmt::format("{}, body {} of its file", list[k].key(), number);
        cluster.ids = std::move(members);
        clusters.push_back(cluster);
      }
      continue;
    }
    if (!list[k]["box"].is_null())
      cluster.box = list[k]["box"].box<dim>();
    if (!list[k]["ids"].is_null())
      cluster.ids = read_ids(list[k]["ids"]);
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

template std::vector<ClusterSettings<2>> read_clusters<2>(const Node&, std::size_t);
template std::vector<ClusterSettings<3>> read_clusters<3>(const Node&, std::size_t);

} // namespace kerf::dem
