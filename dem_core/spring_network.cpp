#include "dem_core/spring_network.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::dem {

template <int dim>
SpringNetwork<dim>::SpringNetwork(std::vector<Spring<dim>> springs,
                                  std::vector<std::uint8_t> is_held)
    : springs_(std::move(springs)), is_held_(std::move(is_held)),
      inverse_diagonal_(Values::Zero(static_cast<Eigen::Index>(is_held_.size()))) {
  for (const Spring<dim>& spring : springs_)
    for (int a = 0; a < unknowns; ++a) {
      const auto add = [&](std::uint32_t particle, double share) {
        const Vec<dim> move =
            a < dim
                ? Vec<dim>(Vec<dim>::Unit(a))
                : Vec<dim>(share * spin<dim>(Rot<dim>::Unit(a < dim ? 0 : a - dim), spring.branch));
        inverse_diagonal_[particle * unknowns + a] += move.dot(spring.force(move));
      };
      add(spring.first, spring.share);
      if (spring.second != Spring<dim>::ground)
        add(spring.second, 1.0 - spring.share);
    }
  for (double& value : inverse_diagonal_)
    value = value > 0.0 ? 1.0 / value : 0.0; // nothing resists
  free_only(inverse_diagonal_);
}

template <int dim> void SpringNetwork<dim>::free_only(Values& values) const {
  for (std::size_t k = 0; k < is_held_.size(); ++k)
    if (is_held_[k] != 0)
      values[static_cast<Eigen::Index>(k)] = 0.0;
}

template <int dim>
void SpringNetwork<dim>::add_to_particles(const Spring<dim>& spring, const Vec<dim>& force,
                                          Values& resultant) const {
  const Rot<dim> couple = moment<dim>(spring.branch, force);
  auto on_first = resultant.template segment<unknowns>(spring.first * unknowns);
  on_first.template head<dim>() += force;
  on_first.template tail<rotations<dim>>() += spring.share * couple;
  if (spring.second == Spring<dim>::ground)
    return;
  auto on_second = resultant.template segment<unknowns>(spring.second * unknowns);
  on_second.template head<dim>() -= force;
  on_second.template tail<rotations<dim>>() += (1.0 - spring.share) * couple;
}

template <int dim>
Vec<dim> SpringNetwork<dim>::opening(const Spring<dim>& spring, const Values& x) const {
  const auto first = x.template segment<unknowns>(spring.first * unknowns);
  Vec<dim> moved = -first.template head<dim>();
  Rot<dim> turned = spring.share * first.template tail<rotations<dim>>();
  if (spring.second != Spring<dim>::ground) {
    const auto second = x.template segment<unknowns>(spring.second * unknowns);
    moved += second.template head<dim>();
    turned += (1.0 - spring.share) * second.template tail<rotations<dim>>();
  }
  return moved - spin<dim>(turned, spring.branch);
}

template <int dim>
auto SpringNetwork<dim>::resultant(std::span<const Vec<dim>> force,
                                   std::span<const Load<dim>> load) const -> Values {
  Values sum(static_cast<Eigen::Index>(is_held_.size()));
  for (std::size_t i = 0; i < load.size(); ++i)
    sum.segment<unknowns>(static_cast<Eigen::Index>(i) * unknowns) << load[i].force, load[i].moment;
  for (std::size_t k = 0; k < springs_.size(); ++k)
    add_to_particles(springs_[k], force[k], sum);
  free_only(sum);
  return sum;
}

/// Conjugate gradients with the diagonal as preconditioner. Where nothing holds the body, rounding
/// makes a load that has no answer, and the residual grows again: then the best so far counts. They
/// take some times as many rounds as there are particles along the body; more means that there is
/// no equilibrium.
template <int dim> auto SpringNetwork<dim>::solve(const Values& load) const -> Values {
  constexpr double tolerance = 1e-12, much = 1e4;
  Values x = Values::Zero(load.size()), r = load, Kp;
  Values z = inverse_diagonal_.cwiseProduct(r), p = z;
  double rz = r.dot(z);
  const double enough = tolerance * tolerance * rz;
  Values best = x;
  double least = rz; // of best
  const double most = 1000.0 + 200.0 * std::pow(static_cast<double>(load.size()), 1.0 / dim);
  for (double n = 0.0; n < most && rz > enough; n += 1.0) {
    Kp = Values::Zero(load.size());
    for (const Spring<dim>& spring : springs_)
      add_to_particles(spring, -spring.force(opening(spring, p)), Kp);
    free_only(Kp);
    const double pKp = p.dot(Kp);
    if (!(pKp > 0.0))
      break; // no stiffness: what is left over is nobody's
    const double step = rz / pKp;
    x += step * p;
    r -= step * Kp;
    z = inverse_diagonal_.cwiseProduct(r);
    const double before = rz;
    rz = r.dot(z);
    p = z + (rz / before) * p;
    if (rz < 0.01 * least || rz <= enough) {
      best = x;
      least = rz;
    } else if (rz > much * least) {
      break;
    }
  }
  return best;
}

template <int dim>
double SpringNetwork<dim>::equilibrate(std::span<Vec<dim>> force,
                                       std::span<const Load<dim>> load) const {
  constexpr double enough = 1e-12; // rounds take away what rounding has left, while that helps
  double branch = 0.0;
  for (const Spring<dim>& spring : springs_)
    branch += spring.branch.norm() / static_cast<double>(springs_.size());
  double mean = 0.0; // N
  std::vector<Vec<dim>> last;
  for (double left, before = -1.0;; before = left) {
    const Values r = resultant(force, load);
    double now = 0.0, largest = 0.0;
    for (const Vec<dim>& f : force)
      now += f.norm() / static_cast<double>(force.size());
    mean = std::max(mean, now); // nothing may be left of the forces
    for (Eigen::Index row = 0; row < r.size(); row += unknowns)
      largest = std::max({largest, r.template segment<dim>(row).norm(),
                          r.template segment<rotations<dim>>(row + dim).norm() / branch});
    left = largest > 0.0 ? largest / mean : 0.0;
    if (before >= 0.0 && !(left < before)) { // rounding is all there is
      std::ranges::copy(last, force.begin());
      return before;
    }
    if (!(left > enough))
      return left;
    last.assign(force.begin(), force.end());
    const Values x = solve(r);
    for (std::size_t k = 0; k < springs_.size(); ++k)
      force[k] += springs_[k].force(opening(springs_[k], x));
  }
}

template class SpringNetwork<2>;
template class SpringNetwork<3>;

} // namespace kerf::dem
