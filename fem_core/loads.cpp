#include "fem_core/loads.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>

namespace kerf::fem {
namespace {

constexpr double gauss = 0.57735026918962576451; // 1 / sqrt(3)

/// Calls act(N, area vector) at the points of a rule that integrates N_a n dA of a face exactly.
template <int dim, class Act> void integrate(const FaceCorners<dim>& x, Space space, Act act) {
  Eigen::Vector4d N = Eigen::Vector4d::Zero();
  if constexpr (dim == 2) {
    const Vec<2> along = x.col(1) - x.col(0);
    const Vec<2> half(0.5 * along[1], -0.5 * along[0]); // of the normal, which is to the right
    for (const double xi : {-gauss, gauss}) {
      N.head<2>() << 0.5 * (1.0 - xi), 0.5 * (1.0 + xi);
      const double radius = N.head<2>().dot(x.row(0));
      act(N, space == Space::axisymmetric ? Vec<2>(2.0 * std::numbers::pi * radius * half) : half);
    }
  } else if (x.cols() == 3) {
    N.head<3>().setConstant(1.0 / 3.0);
    const Vec<3> a = x.col(1) - x.col(0), b = x.col(2) - x.col(0);
    act(N, Vec<3>(0.5 * a.cross(b)));
  } else {
    for (const double xi : {-gauss, gauss})
      for (const double eta : {-gauss, gauss}) {
        N << (1.0 - xi) * (1.0 - eta), (1.0 + xi) * (1.0 - eta), (1.0 + xi) * (1.0 + eta),
            (1.0 - xi) * (1.0 + eta);
        N *= 0.25;
        const Vec<3> of_xi =
            0.25 * ((1.0 - eta) * (x.col(1) - x.col(0)) + (1.0 + eta) * (x.col(2) - x.col(3)));
        const Vec<3> of_eta =
            0.25 * ((1.0 - xi) * (x.col(3) - x.col(0)) + (1.0 + xi) * (x.col(2) - x.col(1)));
        act(N, Vec<3>(of_xi.cross(of_eta)));
      }
  }
}

} // namespace

template <int dim> std::vector<double> face_weights(const FaceCorners<dim>& corners, Space space) {
  std::vector<double> weights(static_cast<std::size_t>(corners.cols()), 0.0);
  integrate<dim>(corners, space, [&](const Eigen::Vector4d& N, const Vec<dim>& area) {
    for (std::size_t a = 0; a < weights.size(); ++a)
      weights[a] += N[static_cast<Eigen::Index>(a)] * area.norm();
  });
  return weights;
}

template <int dim>
Loads<dim>::Loads(const Mesh<dim>& mesh, std::vector<LoadSetting<dim>> settings, Space space)
    : settings_(std::move(settings)), space_(space), shares_(settings_.size()),
      pushed_(settings_.size()) {
  std::vector<std::map<std::uint32_t, double>> weight_of(settings_.size());
  std::vector<std::vector<Face>> faces_of(settings_.size());
  for (std::size_t k = 0; k < settings_.size(); ++k) {
    const LoadSetting<dim>& load = settings_[k];
    const std::string key = fmt::format("loads[{}]", k);
    if (load.tag.empty() == !load.box)
      throw InputError(key + ".tag", "a load needs either a tag or a box to know its nodes");
    const auto faces = mesh.boundary.find(load.tag);
    if (!load.tag.empty() && faces != mesh.boundary.end()) {
      if (load.kind == LoadKind::pressure)
        faces_of[k] = faces->second;
      double area = 0.0;
      for (const Face& face : faces->second) {
        const auto nodes = mesh.nodes_of_face(face);
        const auto weights = face_weights<dim>(face_corners(mesh, face, mesh.positions), space);
        for (std::size_t a = 0; a < nodes.size(); ++a) {
          weight_of[k][nodes[a]] += weights[a];
          area += weights[a];
        }
      }
      if (load.kind == LoadKind::force)
        for (auto& [node, weight] : weight_of[k])
          weight /= area;
    } else {
      if (load.kind != LoadKind::force)
        throw InputError(key + ".tag", "traction and pressure need a tag of faces");
      std::vector<std::uint32_t> nodes =
          nodes_with_tag(mesh, load.tag.empty() ? "all" : load.tag, key + ".tag");
      if (load.box)
        std::erase_if(nodes,
                      [&](std::uint32_t a) { return !load.box->contains(mesh.position(a)); });
      if (nodes.empty())
        throw InputError(key + ".box", "no node of the mesh lies in the box");
      for (const std::uint32_t a : nodes)
        weight_of[k][a] = 1.0 / static_cast<double>(nodes.size());
    }
    for (const auto& [node, weight] : weight_of[k])
      nodes_.push_back(node);
    num_nodes_.push_back(weight_of[k].size());
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());

  const auto place_of = [this](std::uint32_t node) {
    return static_cast<std::uint32_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) -
                                      nodes_.begin());
  };
  for (std::size_t k = 0; k < settings_.size(); ++k) {
    if (settings_[k].kind != LoadKind::pressure)
      for (const auto& [node, weight] : weight_of[k])
        shares_[k].push_back({place_of(node), weight});
    for (const Face& face : faces_of[k]) {
      const auto nodes = mesh.nodes_of_face(face);
      Pushed& pushed = pushed_[k].emplace_back();
      pushed.size = static_cast<std::uint32_t>(nodes.size());
      pushed.corners = face_corners(mesh, face, mesh.positions);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        pushed.place[a] = place_of(nodes[a]);
    }
  }
}

template <int dim>
void Loads<dim>::compute(double time, std::span<const double> displacement,
                         std::span<double> force) const {
  std::fill(force.begin(), force.end(), 0.0);
  for (std::size_t k = 0; k < settings_.size(); ++k)
    add(k, time, displacement, force);
}

template <int dim>
Vec<dim> Loads<dim>::resultant(std::size_t load, double time,
                               std::span<const double> displacement) const {
  std::vector<double> force(nodes_.size() * dim, 0.0);
  add(load, time, displacement, force);
  Vec<dim> sum = Vec<dim>::Zero();
  for (std::size_t a = 0; a < nodes_.size(); ++a)
    sum += Eigen::Map<const Vec<dim>>(&force[a * dim]);
  return sum;
}

template <int dim>
void Loads<dim>::add(std::size_t k, double time, std::span<const double> displacement,
                     std::span<double> force) const {
  const auto at = [](auto values, std::uint32_t place) {
    using Value = std::remove_reference_t<decltype(values[0])>;
    using Vector = std::conditional_t<std::is_const_v<Value>, const Vec<dim>, Vec<dim>>;
    return Eigen::Map<Vector>(values.data() + std::size_t{place} * dim);
  };
  Vec<dim> value;
  for (int i = 0; i < dim; ++i)
    value[i] = settings_[k].value[static_cast<std::size_t>(i)].value(time);
  for (const auto& [place, weight] : shares_[k])
    at(force, place) += weight * value;
  for (const Pushed& face : pushed_[k]) {
    FaceCorners<dim> x = face.corners;
    for (std::uint32_t a = 0; a < face.size; ++a)
      x.col(a) += at(displacement, face.place[a]);
    integrate<dim>(x, space_, [&](const Eigen::Vector4d& N, const Vec<dim>& area) {
      for (std::uint32_t a = 0; a < face.size; ++a)
        at(force, face.place[a]) -= value[0] * N[a] * area;
    });
  }
}

template std::vector<double> face_weights<2>(const FaceCorners<2>&, Space);
template std::vector<double> face_weights<3>(const FaceCorners<3>&, Space);
template class Loads<2>;
template class Loads<3>;

} // namespace kerf::fem
