// The overlap: particles held to their material points in the elements that blend with them.
#include "coupler/broker/coupling.hpp"
#include "coupler/methods/books.hpp"
#include "coupler/methods/lagrange.hpp"
#include "coupler/methods/locate.hpp"
#include "coupler/methods/overlap.hpp"
#include "coupler/methods/penalty.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace kerf::coupler {
namespace {

template <int dim> class OverlapCoupling final : public Coupling {
public:
  OverlapCoupling(const OverlapSettings& settings, const Declaration& particles,
                  const Declaration& mesh);

  bool needs_own_forces() const override { return settings_.lagrange; }
  std::pair<double, double> coupled_omega2(const PointLimits& a, const PointLimits& b) override;
  void start(double time_step) override;
  void compute(std::uint64_t step, const Motion& a, const Motion& b, std::span<double> force_a,
               std::span<double> force_b) override;
  void enter_books(std::uint64_t step, const Motion& a, const Motion& b,
                   std::span<const double> force_a, std::span<const double> force_b) override;

  State state() const override;
  void restore(const State& state) override;

private:
  /// Everything else is computed anew in each step.
  template <class Visit> void visit_state(Visit& visit) {
    visit("book", book_);
    visit("force_on_particles", last_force_[0]);
    visit("force_on_mesh", last_force_[1]);
  }

  void set_weights(const Declaration& particles, const std::vector<double>& node_alpha,
                   const std::vector<double>& point_alpha, const std::vector<double>& distance);
  void predict_gap(std::uint64_t step, const Motion& a, const Motion& b);

  OverlapSettings settings_;
  Interpolation<dim> N_; // rows: interface particles; columns: interface nodes
  std::vector<double> offset_, chi_, acceleration_gap_, lambda_; // [n][dim]
  std::vector<double> inverse_mass_[2];                          // [n or m][dim]
  std::vector<double> acceleration_;                             // [m][dim]
  std::vector<double> last_force_[2];                            // [n or m][dim]
  std::optional<LagrangeSystem<dim>> system_;
  double dt_ = 0.0;
};

/// Values of some points out of those of all points.
template <class T>
std::vector<T> pick(const std::vector<T>& all, const std::vector<std::uint32_t>& points,
                    int width) {
  std::vector<T> some;
  some.reserve(points.size() * static_cast<std::size_t>(width));
  for (const std::uint32_t p : points)
    for (int k = 0; k < width; ++k)
      some.push_back(all[p * static_cast<std::size_t>(width) + static_cast<std::size_t>(k)]);
  return some;
}

template <int dim>
OverlapCoupling<dim>::OverlapCoupling(const OverlapSettings& settings, const Declaration& particles,
                                      const Declaration& mesh)
    : settings_(settings) {
  const auto tag = mesh.boundary.find(settings.boundary);
  if (tag == mesh.boundary.end()) {
    std::string known;
    for (const auto& [name, faces] : mesh.boundary)
      known += (known.empty() ? "" : ", ") + name;
    throw CouplingError("boundary", fmt::format("the mesh has no boundary \"{}\"\ngive one of {}",
                                                settings.boundary, known));
  }
  Period<dim> period;
  for (int k = 0; k < dim; ++k)
    period.length[k] = settings.period.empty() ? 0.0 : settings.period[k];
  const double slack = 1e-9 * settings.width;
  const std::span<const std::uint32_t> faces = tag->second;
  const auto distance_of = [&](std::span<const double> points, double far) {
    return distance_to_boundary<dim>(faces, mesh.positions, points, far, period);
  };

  // Particles inside the mesh, and how deep they are.
  const MeshView<dim> view{mesh.positions, mesh.elements, period};
  const auto locations = locate<dim>(view, particles.positions);
  std::vector<std::uint32_t> inside;
  for (std::size_t p = 0; p < locations.size(); ++p)
    if (locations[p])
      inside.push_back(static_cast<std::uint32_t>(p));
  if (inside.empty())
    throw CouplingError("between",
                        fmt::format("the bodies do not overlap: none of the {} particles lies in "
                                    "the mesh\nlet particles reach into the mesh by the width",
                                    particles.ids.size()));
  const std::vector<double> depth =
      distance_of(pick(particles.positions, inside, dim), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (depth[i] > settings.width + slack)
      throw CouplingError(
          "width", fmt::format("particle {} lies {:g} m inside the mesh, beyond the width of "
                               "{:g} m\nwiden the overlap or end the particles earlier",
                               particles.ids[inside[i]], depth[i], settings.width));
  std::vector<double> point_alpha(inside.size());
  overlap_alpha(depth, settings.width, point_alpha);
  std::vector<double> node_alpha(mesh.ids.size());
  overlap_alpha(distance_of(mesh.positions, settings.width), settings.width, node_alpha);

  // Interface nodes: the corners of the elements around those particles.
  std::vector<std::uint32_t>& nodes = side_[1].points;
  for (const std::uint32_t p : inside)
    for (int a = 0; a < corners<dim>; ++a)
      nodes.push_back(mesh.elements[locations[p]->element * corners<dim> + a]);
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  side_[0].points = inside;

  for (const std::uint32_t p : inside) {
    auto& row = N_.node.emplace_back();
    for (int a = 0; a < corners<dim>; ++a) {
      const std::uint32_t node = mesh.elements[locations[p]->element * corners<dim> + a];
      row[a] = static_cast<std::uint32_t>(std::ranges::lower_bound(nodes, node) - nodes.begin());
    }
    N_.shape.push_back(locations[p]->shape);
  }

  offset_.assign(inside.size() * dim, 0.0);
  chi_ = acceleration_gap_ = lambda_ = offset_;
  const std::vector<double> no_offset = offset_;
  constraint<dim>(N_, pick(particles.positions, inside, dim), pick(mesh.positions, nodes, dim),
                  no_offset, offset_);
  set_weights(particles, node_alpha, point_alpha, distance_of(particles.positions, settings.width));
}

/// @param distance  [all particles] to the boundary where alpha = 0, m
template <int dim>
void OverlapCoupling<dim>::set_weights(const Declaration& particles,
                                       const std::vector<double>& node_alpha,
                                       const std::vector<double>& point_alpha,
                                       const std::vector<double>& distance) {
  if (settings_.blending) {
    // Outside the mesh alpha goes on below zero, so that a contact across the boundary finds the
    // right value between its particles.
    std::vector<double>& weights = side_[0].weights;
    for (const double d : distance)
      weights.push_back(1.0 + std::min(d / settings_.width, 1.0));
    for (std::size_t i = 0; i < point_alpha.size(); ++i)
      weights[side_[0].points[i]] = 1.0 - point_alpha[i]; // eqs 47-50
    side_[1].weights = node_alpha;                        // eqs 44-46
  }
  if (!settings_.lagrange)
    side_[0].stiffness = penalty_stiffness(
        point_alpha, pick(particles.stiffness, side_[0].points, 1), settings_.stiffness_ratio,
        settings_.uniform_stiffness ? StiffnessProfile::uniform : StiffnessProfile::blended);
}

template <int dim>
std::pair<double, double> OverlapCoupling<dim>::coupled_omega2(const PointLimits& a,
                                                               const PointLimits& b) {
  inverse_mass_[0].assign(a.inverse_mass.begin(), a.inverse_mass.end());
  inverse_mass_[1].assign(b.inverse_mass.begin(), b.inverse_mass.end());
  std::vector<double> added[2] = {std::vector<double>(a.omega2.size(), 0.0),
                                  std::vector<double>(b.omega2.size(), 0.0)};
  // A constraint only takes freedom away: it cannot raise the largest frequency.
  if (!settings_.lagrange)
    penalty_omega2<dim>(N_, side_[0].stiffness, a.inverse_mass, b.inverse_mass, added[0], added[1]);
  const auto largest = [](std::span<const double> own, const std::vector<double>& more) {
    double result = 0.0;
    for (std::size_t k = 0; k < own.size(); ++k)
      result = std::max(result, own[k] + more[k]);
    return result;
  };
  return {largest(a.omega2, added[0]), largest(b.omega2, added[1])};
}

template <int dim> void OverlapCoupling<dim>::start(double time_step) {
  dt_ = time_step;
  acceleration_.assign(inverse_mass_[1].size(), 0.0);
  for (int s = 0; s < 2; ++s)
    last_force_[s].assign(inverse_mass_[s].size(), 0.0);
  if (settings_.lagrange)
    system_.emplace(N_, inverse_mass_[0], inverse_mass_[1]);
}

template <int dim> State OverlapCoupling<dim>::state() const {
  State state;
  StateWriter writer(state);
  const_cast<OverlapCoupling*>(this)->visit_state(writer); // which only reads
  return state;
}

template <int dim> void OverlapCoupling<dim>::restore(const State& state) {
  const std::size_t sizes[2] = {last_force_[0].size(), last_force_[1].size()};
  StateReader reader(state);
  visit_state(reader);
  reader.finish();
  if (sizes[0] != last_force_[0].size() || sizes[1] != last_force_[1].size())
    throw std::invalid_argument("it has another interface");
}

template <int dim>
void OverlapCoupling<dim>::predict_gap(std::uint64_t step, const Motion& a, const Motion& b) {
  for (std::size_t k = 0; k < acceleration_.size(); ++k)
    acceleration_[k] = b.own_forces[k] * inverse_mass_[1][k];
  // x^(n+1) = x^n + dt v + dt² a, and half of that acceleration in the first step, where v = v^0.
  const double share = step == 0 ? 0.5 : 1.0;
  for (std::size_t i = 0; i < N_.size(); ++i) {
    const Vec<dim> v = N_.at(i, b.velocity), acceleration = N_.at(i, acceleration_);
    for (int c = 0; c < dim; ++c) {
      const std::size_t k = dim * i + static_cast<std::size_t>(c);
      const double relative = a.own_forces[k] * inverse_mass_[0][k] - acceleration[c];
      acceleration_gap_[k] =
          relative + (chi_[k] + dt_ * (a.velocity[k] - v[c])) / (share * dt_ * dt_);
    }
  }
}

template <int dim>
void OverlapCoupling<dim>::compute(std::uint64_t step, const Motion& a, const Motion& b,
                                   std::span<double> force_a, std::span<double> force_b) {
  constraint<dim>(N_, a.position, b.position, offset_, chi_);
  if (settings_.lagrange) {
    // The multipliers close the gap that x^(n+1) would have without them, so chi cannot drift.
    predict_gap(step, a, b);
    system_->solve(acceleration_gap_, lambda_);
    multiplier_forces<dim>(N_, lambda_, force_a, force_b);
  } else {
    penalty_forces<dim>(N_, chi_, side_[0].stiffness, force_a, force_b);
  }
}

template <int dim>
void OverlapCoupling<dim>::enter_books(std::uint64_t step, const Motion& a, const Motion& b,
                                       std::span<const double> force_a,
                                       std::span<const double> force_b) {
  const Resultant<dim> on_a = resultant<dim>(a.position, force_a);
  const Resultant<dim> on_b = resultant<dim>(b.position, force_b);
  const double size = on_a.force_size + on_b.force_size;
  const double moment_size = on_a.moment_size + on_b.moment_size;
  book_.finite = std::isfinite(size);
  if (size > 0.0)
    book_.momentum_residual =
        std::max(book_.momentum_residual, (on_a.force + on_b.force).norm() / size);
  if (moment_size > 0.0)
    book_.angular_momentum_residual =
        std::max(book_.angular_momentum_residual, (on_a.moment + on_b.moment).norm() / moment_size);
  book_.constraint_violation = std::max(book_.constraint_violation, largest_violation<dim>(chi_));
  if (!settings_.lagrange)
    book_.stored_energy = penalty_energy<dim>(chi_, side_[0].stiffness);

  // Work from t^(n-1) to t^n by the trapezoidal rule that the central differences conserve.
  const std::span<const double> force[2] = {force_a, force_b};
  const std::span<const double> velocity[2] = {a.velocity, b.velocity};
  for (int s = 0; s < 2; ++s) {
    if (step > 0)
      book_.work[s] +=
          0.5 * dt_ * (power(last_force_[s], velocity[s]) + power(force[s], velocity[s]));
    std::ranges::copy(force[s], last_force_[s].begin());
  }
}

} // namespace

std::unique_ptr<Coupling> make_overlap(const OverlapSettings& settings,
                                       const Declaration& particles, const Declaration& mesh) {
  if (particles.dimension == 2)
    return std::make_unique<OverlapCoupling<2>>(settings, particles, mesh);
  return std::make_unique<OverlapCoupling<3>>(settings, particles, mesh);
}

} // namespace kerf::coupler
