#include "fem_core/absorbing.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace kerf::fem {
namespace {

/// A plane wave in a medium: its speed, and its stress for a particle velocity of one.
template <int dim> struct PlaneWave {
  Vec<dim> direction, polarization;
  double speed = 0.0;                       // m/s
  Eigen::Matrix<double, dim, dim> stress{}; // Pa s/m

  PlaneWave(const IncomingWave<dim>& wave, const Medium& medium)
      : direction(wave.direction.normalized()), polarization(wave.polarization.normalized()) {
    const auto [lambda, mu] = medium.moduli;
    const double along = direction.dot(polarization);
    const double modulus = std::abs(along) > 0.5 ? lambda + 2.0 * mu : mu;
    speed = std::sqrt(modulus / medium.density);
    // u(t - d.x / c): strain rate -sym(v d) / c
    stress = -(lambda * along * Eigen::Matrix<double, dim, dim>::Identity() +
               mu * (polarization * direction.transpose() + direction * polarization.transpose())) /
             speed;
  }
};

template <int dim> void check(const IncomingWave<dim>& wave, const std::string& key) {
  if (!(wave.direction.norm() > 0.0))
    throw InputError(key + ".direction", "it must not be zero");
  if (!(wave.polarization.norm() > 0.0))
    throw InputError(key + ".polarization", "it must not be zero");
  const double along = std::abs(wave.direction.normalized().dot(wave.polarization.normalized()));
  if (along > 1e-6 && along < 1.0 - 1e-6)
    throw InputError(key + ".polarization",
                     "it must be along the direction (P wave) or across it (S wave)");
}

} // namespace

template <int dim>
Absorbing<dim>::Absorbing(const Mesh<dim>& mesh, std::vector<AbsorbingSetting<dim>> settings,
                          Space space, const std::function<Medium(std::uint32_t)>& medium)
    : settings_(std::move(settings)) {
  std::map<std::uint32_t, Matrix> dampers;
  struct Found {
    std::size_t setting;
    std::uint32_t node;
    double delay;
    Vec<dim> force;
  };
  std::vector<Found> found;
  for (std::size_t k = 0; k < settings_.size(); ++k) {
    const AbsorbingSetting<dim>& setting = settings_[k];
    const std::string key = fmt::format("absorbing[{}]", k);
    const auto faces = mesh.boundary.find(setting.tag);
    if (faces == mesh.boundary.end())
      throw InputError(key + ".tag",
                       fmt::format("the mesh has no faces with the tag \"{}\"", setting.tag));
    if (setting.wave)
      check(*setting.wave, key + ".wave");
    for (const Face& face : faces->second) {
      const auto corners = face_corners(mesh, face, mesh.positions);
      const Vec<dim> normal = area_vector<dim>(corners).normalized();
      const Medium behind = medium(face.element);
      const double p = std::sqrt(behind.density * behind.moduli.uniaxial()); // rho c_P
      const double s = std::sqrt(behind.density * behind.moduli.mu);
      const Matrix across = normal * normal.transpose();
      const Matrix impedance = p * across + s * (Matrix::Identity() - across);
      const auto weights = face_weights<dim>(corners, space);
      const auto nodes = mesh.nodes_of_face(face);
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        dampers.try_emplace(nodes[a], Matrix::Zero()).first->second += weights[a] * impedance;
        if (!setting.wave)
          continue;
        const PlaneWave<dim> wave(*setting.wave, behind);
        const Vec<dim> from_origin = mesh.position(nodes[a]) - setting.wave->origin;
        found.push_back({k, nodes[a], wave.direction.dot(from_origin) / wave.speed,
                         weights[a] * (wave.stress * normal + impedance * wave.polarization)});
      }
    }
  }
  for (const auto& [node, damper] : dampers)
    nodes_.push_back({node, damper});
  for (const Found& f : found) {
    const auto place = std::lower_bound(nodes_.begin(), nodes_.end(), f.node,
                                        [](const Node& n, std::uint32_t a) { return n.node < a; });
    arrivals_.push_back(
        {static_cast<std::uint32_t>(place - nodes_.begin()), f.setting, f.delay, f.force});
  }
}

template <int dim> void Absorbing<dim>::incoming(double time, std::span<double> force) const {
  std::fill(force.begin(), force.end(), 0.0);
  for (const Arrival& a : arrivals_)
    Eigen::Map<Vec<dim>>(&force[std::size_t{a.place} * dim]) +=
        settings_[a.setting].wave->velocity.value(time - a.delay) * a.force;
}

template class Absorbing<2>;
template class Absorbing<3>;

} // namespace kerf::fem
