#include "dem_core/clusters.hpp"

#include "common/ordered_sum.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace kerf::dem {

namespace {

template <int dim>
std::vector<std::uint32_t> select(const ClusterSettings<dim>& settings,
                                  const Particles<dim>& particles,
                                  const std::map<std::uint32_t, std::uint32_t>& index_of) {
  std::vector<std::uint32_t> members;
  for (const std::uint32_t id : settings.ids) {
    const auto found = index_of.find(id);
    if (found == index_of.end())
      throw std::invalid_argument(fmt::format("there is no particle {}", id));
    members.push_back(found->second);
  }
  for (std::uint32_t i = 0; settings.box && i < particles.size(); ++i)
    if (settings.box->contains(particles.reference[i]))
      members.push_back(i);
  if (members.empty())
    throw std::invalid_argument("it has no particles");
  std::sort(members.begin(), members.end());
  if (std::adjacent_find(members.begin(), members.end()) != members.end())
    throw std::invalid_argument("it names a particle twice");
  return members;
}

/// Moment of inertia of a point of mass one.
template <int dim> Inertia<dim> inertia_at(const Vec<dim>& r) {
  if constexpr (dim == 2)
    return Inertia<2>(r.squaredNorm());
  else
    return r.squaredNorm() * Inertia<3>::Identity() - r * r.transpose();
}

/// Mass, centre and inertia of the members, or as given.
template <int dim>
void weigh(const ClusterSettings<dim>& settings, const Particles<dim>& p, Cluster<dim>& c) {
  c.mass = 0.0;
  Vec<dim> moment = Vec<dim>::Zero(); // from the first member: its digits are not lost, kg m
  const Vec<dim> origin = p.reference[c.members.front()];
  for (const std::uint32_t i : c.members) {
    c.mass += p.mass[i];
    moment += p.mass[i] * (p.reference[i] - origin);
  }
  c.start = settings.centre.value_or(origin + moment / c.mass);
  c.inertia.setZero();
  for (const std::uint32_t i : c.members) {
    const Vec<dim> arm = p.reference[i] - c.start;
    c.arms.push_back(arm);
    c.extent = std::max(c.extent, arm.norm() + p.radius[i]);
    c.inertia += p.mass[i] * inertia_at<dim>(arm) + p.inertia[i] * Inertia<dim>::Identity();
  }
  c.inertia *= settings.mass.value_or(c.mass) / c.mass;
  c.mass = c.weighed_mass = settings.mass.value_or(c.mass);
  c.inertia = settings.inertia.value_or(c.inertia);
  if (!(c.mass > 0.0) || !std::isfinite(c.mass))
    throw std::invalid_argument(fmt::format("its mass {} kg must be positive", c.mass));
  if (!c.start.allFinite() || !c.inertia.allFinite())
    throw std::invalid_argument("its centre and moments of inertia must be finite");
  const auto principal =
      Eigen::SelfAdjointEigenSolver<Inertia<dim>>(c.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  c.least_inertia = principal.minCoeff();
  if (!(c.least_inertia > 0.0))
    throw std::invalid_argument(
        fmt::format("its least moment of inertia, {} kg m², must be positive", c.least_inertia));
  if (dim == 3 && principal.maxCoeff() > (1.0 + 1e-9) * (principal.sum() - principal.maxCoeff()))
    throw std::invalid_argument(
        fmt::format("no body has the principal moments of inertia {} kg m²: the largest is more "
                    "than the sum of the others",
                    fmt::join(principal.begin(), principal.end(), ", ")));
}

template <int dim>
Cluster<dim> make_cluster(const ClusterSettings<dim>& settings, const Particles<dim>& particles,
                          const std::map<std::uint32_t, std::uint32_t>& index_of) {
  Cluster<dim> c;
  c.members = select(settings, particles, index_of);
  weigh(settings, particles, c);
  c.is_free = settings.is_free;
  ToolMotion<dim> motion = settings.motion;
  if (!settings.has_reference)
    motion.reference = c.start;
  const ToolMover<dim> mover(motion);
  c.initial = mover.initial_velocity();
  c.reference = motion.reference;
  if (!c.is_free)
    c.mover = mover;
  return c;
}

template <int dim> ClusterLoad<dim> sum_loads(const Cluster<dim>& c, const Loads<dim>& loads) {
  return ordered_sum(c.members.size(), [&](std::size_t k) {
    const std::uint32_t i = c.members[k];
    Vec<dim> force = loads.own[i].force;
    if (!loads.interface_force.empty())
      force += loads.interface_force[i];
    ClusterLoad<dim> one{force, loads.own[i].moment};
    one.moment += moment<dim>(c.orientation.turned(c.arms[k]), force);
    return one;
  });
}

/// Of a cluster that moves as told: where its centre is at t, and how it is turned.
template <int dim> void follow(Cluster<dim>& c, double t) {
  const Vec<dim> arm = c.start - c.reference;
  c.orientation = Orientation<dim>::about(c.mover->axis(), c.mover->angle(t));
  c.displacement = c.mover->translation(t) + c.orientation.moved(arm);
}

} // namespace

template <int dim>
Clusters<dim>::Clusters(std::span<const ClusterSettings<dim>> settings, Particles<dim>& particles,
                        Boundary<dim>& boundary) {
  if (settings.empty())
    return;
  std::map<std::uint32_t, std::uint32_t> index_of;
  for (std::uint32_t i = 0; i < particles.size(); ++i)
    index_of[particles.ids[i]] = i;
  particles.cluster.assign(particles.size(), 0);
  for (std::size_t k = 0; k < settings.size(); ++k)
    try {
      clusters_.push_back(make_cluster(settings[k], particles, index_of));
      for (const std::uint32_t i : clusters_.back().members) {
        if (particles.cluster[i] != 0)
          throw std::invalid_argument(fmt::format("particle {} is in {}, too", particles.ids[i],
                                                  settings[particles.cluster[i] - 1].name));
        particles.cluster[i] = static_cast<std::uint32_t>(k + 1);
      }
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", settings[k].name, error.what()));
    }
  carry_members(particles, boundary);
}

template <int dim>
void Clusters<dim>::carry_members(const Particles<dim>& particles, Boundary<dim>& boundary) const {
  for (const Cluster<dim>& c : clusters_)
    for (const std::uint32_t i : c.members)
      if (boundary.of(i) != nullptr)
        throw std::invalid_argument(
            fmt::format("particle {} is in a cluster and in a boundary, too", particles.ids[i]));
  for (const Cluster<dim>& c : clusters_)
    boundary.carry(c.members, particles.size());
}

template <int dim> void Clusters<dim>::scale_mass(std::span<const double> factor) {
  for (std::size_t k = 0; k < size(); ++k) {
    Cluster<dim>& c = clusters_[k];
    const double change = factor[k] * c.weighed_mass / c.mass;
    c.mass *= change;
    c.inertia *= change;
    c.least_inertia *= change;
  }
}

template <int dim> void Clusters<dim>::start(Particles<dim>& p) {
  for (Cluster<dim>& c : clusters_) {
    double mass = 0.0; // of the members, kg
    Vec<dim> momentum = Vec<dim>::Zero();
    Rot<dim> angular = Rot<dim>::Zero();
    for (std::size_t k = 0; c.is_free && k < c.members.size(); ++k) {
      const std::uint32_t i = c.members[k];
      mass += p.mass[i];
      momentum += p.mass[i] * p.velocity[i];
    }
    const Vec<dim> mean = mass > 0.0 ? Vec<dim>(momentum / mass) : Vec<dim>(Vec<dim>::Zero());
    for (std::size_t k = 0; c.is_free && k < c.members.size(); ++k) {
      const std::uint32_t i = c.members[k];
      angular += p.mass[i] * moment<dim>(c.arms[k], Vec<dim>(p.velocity[i] - mean)) +
                 p.inertia[i] * p.angular_velocity[i];
    }
    c.angular_momentum = angular + Rot<dim>(c.inertia * c.initial.rotation);
    c.rate = c.inertia.inverse() * c.angular_momentum;
    c.velocity = mean + c.initial.translation;
    if (!c.is_free)
      c.velocity += spin<dim>(c.rate, c.start - c.reference);
    for (std::size_t k = 0; k < c.members.size(); ++k) {
      p.velocity[c.members[k]] = c.velocity + spin<dim>(c.rate, c.arms[k]);
      p.angular_velocity[c.members[k]] = c.rate;
    }
  }
}

template <int dim>
void Clusters<dim>::advance(const Loads<dim>& loads, const Damping& damping,
                            const Vec<dim>& gravity, std::uint64_t step, double dt,
                            Boundary<dim>& boundary) {
  const bool is_first = step == 0;
  const double then = static_cast<double>(step + 1) * dt;
  for (Cluster<dim>& c : clusters_) {
    c.load = sum_loads(c, loads);
    c.load.force += c.weighed_mass * gravity;
    c.displacement_before = c.displacement;
    c.orientation_before = c.orientation;
    c.velocity_before = c.velocity;
    Orientation<dim> turn;
    if (c.is_free) {
      if (damping.translation != 0.0 || damping.rotation != 0.0)
        c.damping = {damping_force(damping.kind, damping.translation, c.load.force, c.velocity),
                     damping_force(damping.kind, damping.rotation, c.load.moment, c.rate)};
      const Vec<dim> kick = dt / c.mass * (c.load.force + c.damping.force);
      const Rot<dim> twist = dt * (c.load.moment + c.damping.moment);
      if (is_first) { // from t_0 to t_(-1/2)
        c.velocity_before -= 0.5 * kick;
        c.angular_momentum -= 0.5 * twist;
      }
      const auto rate_of = [&](const Rot<dim>& momentum) { // at t_n
        return to_space<dim>(c.orientation,
                             Rot<dim>(c.inertia.inverse() * to_body<dim>(c.orientation, momentum)));
      };
      c.rate_before = rate_of(c.angular_momentum);
      c.angular_momentum += twist;
      c.rate_after = rate_of(c.angular_momentum);
      c.velocity = c.velocity_before + kick;
      const auto free = free_turn<dim>(c.inertia, c.orientation, c.angular_momentum, dt);
      turn = free.turn;
      c.rate = free.mean_rate;
      c.orientation = c.orientation.then(turn);
      c.displacement += dt * c.velocity;
    } else {
      c.rate_before = c.rate;
      const double angle = c.mover->angle(then) - c.mover->angle(static_cast<double>(step) * dt);
      turn = Orientation<dim>::about(c.mover->axis(), angle);
      c.rate = angle / dt * c.mover->axis();
      follow(c, then);
      c.velocity = (c.displacement - c.displacement_before) / dt;
      c.rate_after = c.rate;
      if (is_first) {
        c.velocity_before = c.velocity;
        c.rate_before = c.rate;
      }
    }

    const auto powers = [&](const ClusterLoad<dim>& load, RunningWork& work) {
      work.add(load.force.dot(c.velocity_before) + load.moment.dot(c.rate_before),
               load.force.dot(c.velocity) + load.moment.dot(c.rate_after), dt, is_first);
    };
    powers(c.load, c.load_work);
    powers(c.damping, c.damping_work);
    if (!c.is_free)
      powers({c.mass / dt * (c.velocity - c.velocity_before) - c.load.force,
              c.momentum_of(c.orientation_before, (c.rate_after - c.rate_before) / dt) -
                  c.load.moment},
             c.drive_work);

    const auto count = static_cast<std::int64_t>(c.members.size());
#pragma omp parallel for schedule(static) if (count > particles_per_block)
    for (std::int64_t k = 0; k < count; ++k) {
      PrescribedMotion<dim>& motion = *boundary.of(c.members[k]);
      const Vec<dim> arm = c.orientation_before.turned(c.arms[k]);
      motion.velocity = c.velocity + turn.moved(arm) / dt;
      motion.angular_velocity = c.rate;
    }
  }
}

template <int dim> void Clusters<dim>::place(Particles<dim>& particles) const {
  for (const Cluster<dim>& c : clusters_) {
    const auto count = static_cast<std::int64_t>(c.members.size());
#pragma omp parallel for schedule(static) if (count > particles_per_block)
    for (std::int64_t k = 0; k < count; ++k)
      particles.displacement[c.members[k]] = c.displacement + c.orientation.moved(c.arms[k]);
  }
}

template <int dim> double Clusters<dim>::kinetic_energy() const {
  double energy = 0.0;
  for (const Cluster<dim>& c : clusters_)
    energy += 0.5 * c.mass * c.velocity_before.dot(c.velocity) +
              0.5 * c.rate_before.dot(c.momentum_of(c.orientation_before, c.rate_after));
  return energy;
}

template <int dim> Vec<dim> Clusters<dim>::momentum() const {
  Vec<dim> sum = Vec<dim>::Zero();
  for (const Cluster<dim>& c : clusters_)
    sum += 0.5 * c.mass * (c.velocity_before + c.velocity);
  return sum;
}

template <int dim> double Clusters<dim>::drive_work() const {
  double work = 0.0;
  for (const Cluster<dim>& c : clusters_)
    work += c.drive_work.work();
  return work;
}

template <int dim> double Clusters<dim>::damping_work() const {
  double work = 0.0;
  for (const Cluster<dim>& c : clusters_)
    work += c.damping_work.work();
  return work;
}

template <int dim> double Clusters<dim>::weight_work(const Vec<dim>& gravity, double share) const {
  double work = 0.0;
  for (const Cluster<dim>& c : clusters_)
    work += c.weighed_mass *
            gravity.dot((1.0 - share) * c.displacement_before + share * c.displacement);
  return work;
}

template class Clusters<2>;
template class Clusters<3>;

} // namespace kerf::dem
