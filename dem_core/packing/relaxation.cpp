#include "dem_core/packing/relaxation.hpp"

#include "common/ordered_sum.hpp"
#include "dem_core/packing/cell_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace kerf::dem {

namespace {

/// Particles keep this distance, as a share of the sum of their radii, so that those that need not
/// overlap end up without a trace of it.
constexpr double clearance = 1e-4;

/// Neighbours of every particle i: entries offset[i] to offset[i + 1] of index.
struct NeighbourList {
  std::vector<std::size_t> offset;
  std::vector<std::uint32_t> index;
};

/// Fixed blocks of particles, each with its own list, so that threads never share one.
template <int dim>
NeighbourList find_neighbours(const CellList<dim>& cells, const ParticleSet<dim>& particles,
                              const Period<dim>& period, double skin) {
  constexpr std::size_t block = 1024;
  const auto& x = particles.positions;
  const auto& r = particles.radii;
  const std::size_t count = x.size();
  const auto blocks = static_cast<std::int64_t>((count + block - 1) / block);
  std::vector<std::vector<std::uint32_t>> found(static_cast<std::size_t>(blocks));
  NeighbourList list;
  list.offset.assign(count + 1, 0);
#pragma omp parallel for schedule(dynamic)
  for (std::int64_t b = 0; b < blocks; ++b) {
    auto& own = found[static_cast<std::size_t>(b)];
    const std::size_t first = static_cast<std::size_t>(b) * block;
    for (std::size_t i = first; i < std::min(count, first + block); ++i) {
      const std::size_t before = own.size();
      cells.for_each_near(x[i], [&](std::uint32_t j) {
        const double reach = r[i] + r[j] + skin;
        if (j != i && period.shortest(x[j] - x[i]).squaredNorm() < reach * reach)
          own.push_back(j);
      });
      list.offset[i + 1] = own.size() - before;
    }
  }
  std::partial_sum(list.offset.begin(), list.offset.end(), list.offset.begin());
  list.index.resize(list.offset.back());
#pragma omp parallel for schedule(static)
  for (std::int64_t b = 0; b < blocks; ++b) {
    const auto& own = found[static_cast<std::size_t>(b)];
    std::copy(own.begin(), own.end(),
              list.index.begin() +
                  static_cast<std::ptrdiff_t>(list.offset[static_cast<std::size_t>(b) * block]));
  }
  return list;
}

/// Sums over the particles that FIRE steers by.
struct Sums {
  double power = 0.0, force = 0.0, velocity = 0.0; // F v, F², v²
  Sums& operator+=(const Sums& other) {
    power += other.power;
    force += other.force;
    velocity += other.velocity;
    return *this;
  }
};

/// Overlaps of the pairs, each counted from both sides.
struct Overlaps {
  double squares = 0.0; // m²
  double largest = 0.0; // over the sum of the radii
  Overlaps& operator+=(const Overlaps& other) {
    squares += other.squares;
    largest = std::max(largest, other.largest);
    return *this;
  }
};

template <int dim> class Relaxation {
public:
  Relaxation(const Region<dim>& region, ParticleSet<dim>& particles)
      : region_(region), period_(region.period()), bounds_(region.bounds()), particles_(particles),
        force_(particles.positions.size(), Vec<dim>::Zero()), velocity_(force_),
        overlaps_(force_.size()), leans_on_wall_(force_.size(), 0) {
    const auto& r = particles.radii;
    const double mean = std::accumulate(r.begin(), r.end(), 0.0) / static_cast<double>(r.size());
    skin_ = 0.5 * mean;
    reach_ = 2.0 * (1.0 + clearance) * *std::max_element(r.begin(), r.end()) + skin_;
    for (std::size_t i = 0; i < force_.size(); ++i)
      push_inside(i);
  }

  std::size_t run(std::size_t most_steps) {
    std::size_t step = 0;
    for (; step < most_steps; ++step) {
      if (is_worn())
        renew_neighbours();
      compute_forces();
      if (step % steps_between_looks == 0 && is_relaxed())
        break;
      move(sum());
    }
    return step;
  }

private:
  std::size_t size() const { return force_.size(); }

  /// Calls body(i) for every particle, in parallel.
  template <class Body> void for_each(Body body) const {
    const auto count = static_cast<std::int64_t>(size());
#pragma omp parallel for schedule(static) if (count > 2000)
    for (std::int64_t i = 0; i < count; ++i)
      body(static_cast<std::size_t>(i));
  }

  bool is_worn() const {
    if (listed_.empty())
      return true;
    const auto count = static_cast<std::int64_t>(size());
    double farthest = 0.0;
#pragma omp parallel for schedule(static) reduction(max : farthest) if (count > 2000)
    for (std::int64_t i = 0; i < count; ++i)
      farthest = std::max(farthest, (particles_.positions[i] - listed_[i]).squaredNorm());
    return farthest > 0.25 * skin_ * skin_;
  }

  void renew_neighbours() {
    for_each([&](std::size_t i) { wrap(particles_.positions[i]); });
    CellList<dim> cells(bounds_, period_, reach_, size());
    const std::vector<std::uint32_t> order = cells.sort(particles_.positions);
    rearrange(particles_.positions, order);
    rearrange(particles_.radii, order);
    rearrange(velocity_, order);
    rearrange(leans_on_wall_, order);
    neighbours_ = find_neighbours(cells, particles_, period_, skin_ + clearance * reach_);
    listed_ = particles_.positions;
    listed_depth_.resize(size());
    for_each(
        [&](std::size_t i) { listed_depth_[i] = region_.wall(particles_.positions[i]).depth; });
  }

  void wrap(Vec<dim>& x) const {
    for (int a = 0; a < dim; ++a)
      if (period_.length[a] > 0.0)
        x[a] -= period_.length[a] * std::floor((x[a] - bounds_.lower[a]) / period_.length[a]);
  }

  template <class Value>
  void rearrange(std::vector<Value>& values, const std::vector<std::uint32_t>& order) const {
    std::vector<Value> sorted(values.size());
    for_each([&](std::size_t k) { sorted[k] = values[order[k]]; });
    values = std::move(sorted);
  }

  /// F_i = -dE/dx_i of E = sum overlap² / 2.
  void compute_forces() {
    const bool is_periodic = !period_.length.isZero();
    const auto& x = particles_.positions;
    const auto& r = particles_.radii;
    for_each([&](std::size_t i) {
      Vec<dim> F = Vec<dim>::Zero();
      Overlaps own;
      for (std::size_t e = neighbours_.offset[i]; e < neighbours_.offset[i + 1]; ++e) {
        const std::uint32_t j = neighbours_.index[e];
        const Vec<dim> branch = is_periodic ? period_.shortest(x[j] - x[i]) : Vec<dim>(x[j] - x[i]);
        const double touching = (1.0 + clearance) * (r[i] + r[j]), squared = branch.squaredNorm();
        if (squared >= touching * touching)
          continue;
        const double distance = std::sqrt(squared), overlap = touching - distance;
        if (distance > 0.0)
          F -= overlap / distance * branch;
        else // two that a corner holds in the same place; any way apart will do
          F[(i + j) % dim] += i < j ? overlap : -overlap;
        own += {overlap * overlap, overlap / (r[i] + r[j])};
      }
      force_[i] = F;
      overlaps_[i] = own;
    });
  }

  /// Without the particles whose force the wall may bear.
  Sums sum() const {
    return ordered_sum(size(), [&](std::size_t i) {
      if (leans_on_wall_[i])
        return Sums{};
      return Sums{force_[i].dot(velocity_[i]), force_[i].squaredNorm(), velocity_[i].squaredNorm()};
    });
  }

  /// Compares with the last time.
  bool is_relaxed() {
    const Overlaps all = ordered_sum(size(), [&](std::size_t i) { return overlaps_[i]; });
    const bool gains_nothing = all.squares > 0.99 * squared_overlaps_;
    squared_overlaps_ = all.squares;
    return all.largest <= clearance || gains_nothing;
  }

  /// A step of FIRE with unit masses; unit stiffness makes the time a number.
  void move(const Sums& sums) {
    if (sums.power > 0.0) {
      if (++downhill_steps_ > 5) {
        time_step_ = std::min(1.1 * time_step_, longest_time_step);
        mixing_ *= 0.99;
      }
    } else {
      downhill_steps_ = 0;
      time_step_ = std::max(0.5 * time_step_, shortest_time_step);
      mixing_ = first_mixing;
    }
    const double keep = sums.power > 0.0 ? 1.0 - mixing_ : 0.0;
    const double turn = sums.power > 0.0 && sums.force > 0.0
                            ? mixing_ * std::sqrt(sums.velocity / sums.force)
                            : 0.0;
    for_each([&](std::size_t i) {
      Vec<dim>& x = particles_.positions[i];
      const Vec<dim> before = x;
      velocity_[i] = keep * velocity_[i] + (turn + time_step_) * force_[i];
      // Nobody moves by more than half a radius: the random start overlaps much.
      const double step = time_step_ * velocity_[i].norm(), limit = 0.5 * particles_.radii[i];
      if (step > limit)
        velocity_[i] *= limit / step;
      x += time_step_ * velocity_[i];
      leans_on_wall_[i] = may_reach_wall(i) && push_inside(i);
      if (leans_on_wall_[i])
        velocity_[i] = (x - before) / time_step_;
    });
  }

  /// False when it cannot have come so far since it was listed.
  bool may_reach_wall(std::size_t i) const {
    const double moved = (particles_.positions[i] - listed_[i]).norm();
    return listed_depth_[i] - moved < particles_.radii[i];
  }

  /// Moves a particle back to where it does not reach through the wall; several times in a corner.
  /// @return whether it did
  bool push_inside(std::size_t i) {
    Vec<dim>& x = particles_.positions[i];
    const double radius = particles_.radii[i];
    for (int push = 0; push < 30; ++push) {
      const Wall<dim> wall = region_.wall(x);
      if (wall.depth >= radius)
        return push > 0;
      x += (radius - wall.depth) * wall.inward;
    }
    return true;
  }

  static constexpr double first_mixing = 0.1;
  static constexpr double longest_time_step = 0.35; // below 2 / omega of twelve neighbours
  static constexpr double shortest_time_step = 0.02;
  static constexpr std::size_t steps_between_looks = 100;

  const Region<dim>& region_;
  Period<dim> period_;
  Box<dim> bounds_;
  ParticleSet<dim>& particles_;
  std::vector<Vec<dim>> force_, velocity_;
  std::vector<Overlaps> overlaps_;
  std::vector<std::uint8_t> leans_on_wall_; // was pushed back by the last step

  double skin_ = 0.0, reach_ = 0.0; // m
  NeighbourList neighbours_;
  std::vector<Vec<dim>> listed_;     // positions when the neighbours were found, m
  std::vector<double> listed_depth_; // below the wall at that time, m

  double time_step_ = 0.1, mixing_ = first_mixing;
  int downhill_steps_ = 0;
  double squared_overlaps_ = std::numeric_limits<double>::infinity(); // when looked at last, m²
};

} // namespace

template <int dim>
std::size_t relax(const Region<dim>& region, ParticleSet<dim>& particles, std::size_t most_steps) {
  return Relaxation<dim>(region, particles).run(most_steps);
}

template std::size_t relax<2>(const Region<2>&, ParticleSet<2>&, std::size_t);
template std::size_t relax<3>(const Region<3>&, ParticleSet<3>&, std::size_t);

} // namespace kerf::dem
