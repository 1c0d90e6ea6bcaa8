// Rigid clusters of particles: free motion against Euler's equations, and what they exchange.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::LatticeType;

/// One cluster of all particles.
template <int dim> dem::ClusterSettings<dim> of_ids(std::vector<std::uint32_t> ids) {
  dem::ClusterSettings<dim> cluster;
  cluster.name = "body";
  cluster.ids = std::move(ids);
  return cluster;
}

/// A body of five spheres without symmetry, which turns about no principal axis.
dem::Settings<3> irregular_body() {
  dem::Settings<3> settings;
  settings.positions = {{0.0, 0.0, 0.0},
                        {spacing, 0.0, 0.0},
                        {2.0 * spacing, 0.1 * spacing, 0.0},
                        {0.0, 1.1 * spacing, 0.0},
                        {0.3 * spacing, 0.2 * spacing, 0.9 * spacing}};
  settings.radii = {0.5 * spacing, 0.5 * spacing, 0.4 * spacing, 0.6 * spacing, 0.3 * spacing};
  settings.material = rock(3);
  settings.clusters = {of_ids<3>({0, 1, 2, 3, 4})};
  settings.clusters[0].motion.axis = {1.0, 2.0, 0.5};
  settings.clusters[0].motion.rotation_rate = kerf::TimeTable(100.0); // rad/s
  return settings;
}

/// Inertia of the members where they are, about their centre; from nothing but their places.
Eigen::Matrix3d inertia_of_places(const dem::Particles<3>& p) {
  double mass = 0.0;
  Vec<3> centre = Vec<3>::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) {
    mass += p.mass[i];
    centre += p.mass[i] * p.position(i);
  }
  centre /= mass;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec<3> r = p.position(i) - centre;
    inertia += (p.mass[i] * r.squaredNorm() + p.inertia[i]) * Eigen::Matrix3d::Identity() -
               p.mass[i] * r * r.transpose();
  }
  return inertia;
}

// Reference: the midpoint rule keeps every quadratic invariant (Simo & Wong 1991). Tolerance: the
// rounding of 50 000 steps, in which the body turns by a quarter of a degree each.
TEST(Cluster, without_loads_keeps_energy_and_angular_momentum) {
  dem::Engine<3> engine(irregular_body());
  engine.start(5e-5);
  const dem::Cluster<3>& body = engine.clusters().all()[0];
  const Vec<3> L = body.angular_momentum;
  const double energy = 0.5 * L.dot(inertia_of_places(engine.particles()).inverse() * L);
  const Vec<3> at_start = engine.particles().position(4);
  double farthest = 0.0;
  for (int n = 0; n < 50000; ++n) {
    cases::step(engine);
    farthest = std::max(farthest, (engine.particles().position(4) - at_start).norm());
  }
  const Eigen::Matrix3d inertia = inertia_of_places(engine.particles());
  EXPECT_EQ(body.angular_momentum, L);
  EXPECT_NEAR(0.5 * L.dot(inertia.inverse() * L), energy, 1e-10 * energy);
  verify({"energy of a free cluster after 50 000 steps",
          "that of the start, doi:10.1002/nme.1620310103", 1e-10,
          "kept by the midpoint rule; rounding"},
         engine.energies().kinetic / energy - 1.0);
  EXPECT_NEAR(inertia.determinant(),
              inertia_of_places(dem::Engine<3>(irregular_body()).particles()).determinant(),
              1e-10 * inertia.determinant()); // it is still rigid
  EXPECT_GT(farthest, spacing);
  EXPECT_LT(engine.momentum().norm(), 1e-12 * body.mass * 100.0 * spacing);
}

/// Turns the body of a settings for a time and gives a direction that goes with it: from the centre
/// to a member.
Vec<3> direction_after(const dem::Settings<3>& settings, double time, int steps,
                       std::size_t member) {
  dem::Engine<3> engine(settings);
  engine.start(time / steps);
  for (int n = 0; n < steps; ++n)
    cases::step(engine);
  return (engine.particles().position(member) - engine.clusters().all()[0].centre()).normalized();
}

// Reference: the axis of a symmetric top goes round the angular momentum at the rate L / I, I being
// the moment of inertia across the axis. The error of the midpoint rule falls as dt².
TEST(Cluster, of_a_symmetric_top_precesses_as_in_closed_form) {
  dem::Settings<3> settings;
  settings.positions = {{0.0, 0.0, -spacing}, {0.0, 0.0, 0.0}, {0.0, 0.0, spacing}};
  settings.radii = {0.5 * spacing, 0.5 * spacing, 0.5 * spacing};
  settings.material = rock(3);
  settings.clusters = {of_ids<3>({0, 1, 2})};
  settings.clusters[0].motion.axis = {1.0, 0.0, 2.0};
  settings.clusters[0].motion.rotation_rate = kerf::TimeTable(50.0);

  dem::Engine<3> engine(settings);
  engine.start(1.0);
  const dem::Cluster<3>& top = engine.clusters().all()[0];
  const double m = engine.particles().mass[0], r = 0.5 * spacing;
  const double across = 3.0 * 0.4 * m * r * r + 2.0 * m * spacing * spacing;
  EXPECT_NEAR(top.inertia(0, 0), across, 1e-12 * across);
  EXPECT_NEAR(top.inertia(2, 2), 3.0 * 0.4 * m * r * r, 1e-12 * across);
  const Vec<3> L = top.angular_momentum;
  const double time = 0.2;
  const Vec<3> expected =
      Eigen::AngleAxisd(L.norm() / across * time, L.normalized()) * Vec<3>(0.0, 0.0, 1.0);
  const double coarse = (direction_after(settings, time, 2000, 2) - expected).norm();
  const double fine = (direction_after(settings, time, 4000, 2) - expected).norm();
  verify({"axis of a symmetric top, rad", "precession at the rate L / I", 1e-4,
          "(angle of a step)² / 12 over the turn"},
         fine);
  verify({"order of that error in the step", "second, midpoint rule", 0.02, "log2 of 4 ± 0.05"},
         std::log2(coarse / fine) - 2.0);
}

// Reference: Euler's equations and the motion of the frame by Runge and Kutta's method, far finer.
TEST(Cluster, without_symmetry_follows_eulers_equations_with_second_order) {
  const dem::Settings<3> settings = irregular_body();
  dem::Engine<3> engine(settings);
  engine.start(1.0);
  const dem::Cluster<3>& body = engine.clusters().all()[0];
  const Eigen::Matrix3d J = body.inertia, inverse = J.inverse();
  const Vec<3> L = body.angular_momentum;
  const double time = 0.1;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity(); // dR/dt = (J^-1 R^T L) as seen in the body
  const auto rate = [&](const Eigen::Matrix3d& at) -> Eigen::Matrix3d {
    const Vec<3> w = inverse * (at.transpose() * L);
    Eigen::Matrix3d cross;
    cross << 0.0, -w[2], w[1], w[2], 0.0, -w[0], -w[1], w[0], 0.0;
    return at * cross;
  };
  const int fine_steps = 20000;
  const double h = time / fine_steps;
  for (int n = 0; n < fine_steps; ++n) {
    const Eigen::Matrix3d a = rate(R), b = rate(R + 0.5 * h * a), c = rate(R + 0.5 * h * b),
                          d = rate(R + h * c);
    R += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  const Vec<3> expected = R * body.arms[2].normalized();
  const double coarse = (direction_after(settings, time, 1000, 2) - expected).norm();
  const double fine = (direction_after(settings, time, 2000, 2) - expected).norm();
  verify({"direction of a tumbling body, rad", "Euler's equations by Runge and Kutta's method",
          3e-4, "(angle of a step)² over the turn"},
         fine);
  verify({"order of that error in the step, body without symmetry", "second, midpoint rule", 0.04,
          "log2 of 4 ± 0.1"},
         std::log2(coarse / fine) - 2.0);
}

// Reference: u = 1/2 g t² exactly in central differences, whatever the rotation; the weight of a
// given mass. In 2D the angle is exact, too.
TEST(Cluster, falls_with_its_weight_and_turns_on) {
  auto settings = cases::lattice_model<2>(LatticeType::triangular, {2, 2}, rock(2));
  settings.gravity = {0.5, -9.81};
  settings.clusters = {of_ids<2>({0, 1, 2, 3})};
  settings.clusters[0].mass = 12.0;
  settings.clusters[0].inertia = Rot<2>(3e-3);
  settings.clusters[0].motion.rotation_rate = kerf::TimeTable(20.0);
  settings.clusters[0].motion.velocity[0] = kerf::TimeTable(0.1);
  settings.initial = {{.box = {}, .velocity = {0.0, 0.2}, .pulse = {}}};
  dem::Engine<2> engine(settings);
  const double dt = 1e-4, t = 200 * dt;
  engine.start(dt);
  for (int n = 0; n < 200; ++n)
    cases::step(engine);
  const dem::Cluster<2>& body = engine.clusters().all()[0];
  const Vec<2> expected = t * Vec<2>(0.1, 0.2) + 0.5 * t * t * settings.gravity;
  EXPECT_LT((body.displacement - expected).norm(), 1e-12);
  EXPECT_NEAR(body.load.force[1], -12.0 * 9.81, 1e-12);
  const double before = t - dt;
  const Vec<2> fallen = before * Vec<2>(0.1, 0.2) + 0.5 * before * before * settings.gravity;
  EXPECT_NEAR(engine.energies().external_work, 12.0 * settings.gravity.dot(fallen), 1e-10);
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec<2> place = body.start + expected + Eigen::Rotation2Dd(20.0 * t) * body.arms[k];
    EXPECT_LT((engine.particles().position(k) - place).norm(), 1e-12);
  }
}

/// Two bodies that fly at each other off the middle, and a loose particle between them.
template <int dim> dem::Settings<dim> collision(double& duration) {
  dem::Settings<dim> settings;
  settings.material = rock(dim, 0.0);
  settings.bonds = false;
  const auto place = [](double x, double y, double z) {
    Vec<dim> v = Vec<dim>::Zero();
    v[0] = x * spacing;
    v[1] = y * spacing;
    if (dim == 3)
      v[dim - 1] = z * spacing;
    return v;
  };
  settings.positions = {place(0.0, 0.0, 0.0),  place(0.8, 0.1, 0.2),  place(0.1, 0.9, 0.0),
                        place(0.0, -0.7, 0.3), place(3.2, 0.45, 0.1), place(3.3, -0.4, 0.0),
                        place(4.0, 0.0, 0.2),  place(2.0, 0.2, 0.1)};
  settings.radii.assign(8, 0.5 * spacing);
  settings.clusters = {of_ids<dim>({0, 1, 2, 3}), of_ids<dim>({4, 5, 6})};
  settings.clusters[0].motion.velocity[0] = kerf::TimeTable(2.0);
  settings.clusters[0].motion.rotation_rate = kerf::TimeTable(300.0);
  settings.clusters[1].motion.velocity[0] = kerf::TimeTable(-1.0);
  duration = 1.0e-3;
  return settings;
}

/// The largest error of the energy on the way, over the energy.
template <int dim> double energy_error(int refine) {
  double duration = 0.0;
  const auto settings = collision<dim>(duration);
  dem::Engine<dim> engine(settings);
  const auto& p = engine.particles();
  const double dt = 2e-7 / refine;
  engine.start(dt);
  Vec<dim> momentum;
  Rot<dim> angular;
  const auto sum = [&] { // with v^(n+1/2)
    momentum.setZero();
    angular.setZero();
    for (const auto& c : engine.clusters().all()) {
      momentum += c.mass * c.velocity;
      angular += moment<dim>(c.centre(), Vec<dim>(c.mass * c.velocity)) + c.angular_momentum;
    }
    momentum += p.mass[7] * p.velocity[7];
    angular += moment<dim>(p.position(7), Vec<dim>(p.mass[7] * p.velocity[7])) +
               p.inertia[7] * p.angular_velocity[7];
  };
  sum();
  const Vec<dim> first_momentum = momentum;
  const Rot<dim> first_angular = angular;
  double first = 0.0, worst = 0.0, most_elastic = 0.0;
  const Rot<dim> spin_before = engine.clusters().all()[1].angular_momentum;
  for (int n = 0; n < duration / dt; ++n) {
    cases::step(engine);
    const dem::Energies e = engine.energies();
    if (n == 0)
      first = e.kinetic + e.elastic;
    worst = std::max(worst, std::abs(e.kinetic + e.elastic - first) / first);
    most_elastic = std::max(most_elastic, e.elastic);
  }
  sum();
  verify({"momentum of clusters that collide", "that of the start", 1e-10, "rounding"},
         (momentum - first_momentum).norm() / first_momentum.norm());
  verify({"angular momentum of clusters that collide", "that of the start", 1e-10, "rounding"},
         (angular - first_angular).norm() / first_angular.norm());
  EXPECT_GT(most_elastic, 0.05 * first); // they did collide
  EXPECT_GT((engine.clusters().all()[1].angular_momentum - spin_before).norm(),
            0.01 * first_angular.norm());
  return worst;
}

// Contacts exchange momentum and angular momentum and make none; the energy is that of the
// contacts, which close and open between steps: its error falls with the step.
template <int dim> void expect_collisions_to_conserve() {
  const double coarse = energy_error<dim>(2), fine = energy_error<dim>(8);
  EXPECT_LT(coarse, 2e-2);
  EXPECT_LT(fine, 0.3 * coarse);
}
TEST(Cluster, that_collides_conserves_momentum_and_angular_momentum_2d) {
  expect_collisions_to_conserve<2>();
}
TEST(Cluster, that_collides_conserves_momentum_and_angular_momentum_3d) {
  expect_collisions_to_conserve<3>();
}

// Particles are worked on in blocks of 1024. A body with members in three of them, which are far
// apart in the list, flies into a floor of bonded discs as it does when its members stand together.
// Reference: the same body with other indices; sums have another order, nothing else.
TEST(Cluster, with_members_in_several_blocks_moves_like_one_within_a_block) {
  const auto fly = [](std::span<const std::uint32_t> places) {
    auto settings = cases::lattice_model<2>(LatticeType::square, {60, 40}, rock(2));
    std::vector<Vec<2>> body = {{20.2, 40.1}, {21.1, 40.03}, {22.3, 40.4}, {21.0, 40.9}};
    // Members stand at the places in the list where they were told to.
    for (std::size_t k = 0; k < body.size(); ++k)
      settings.positions.insert(settings.positions.begin() + places[k], spacing * body[k]);
    settings.radii.assign(settings.positions.size(), 0.5 * spacing);
    settings.clusters = {of_ids<2>({places.begin(), places.end()})};
    settings.clusters[0].motion.velocity = {kerf::TimeTable(1.0), kerf::TimeTable(-5.0)};
    settings.gap_tolerance = 1e-6;
    dem::Engine<2> engine(settings);
    engine.start(0.2 * 2.0 / std::sqrt(engine.step_limit().omega2));
    for (int n = 0; n < 1500; ++n)
      cases::step(engine);
    const dem::Cluster<2>& c = engine.clusters().all()[0];
    Eigen::Matrix<double, 5, 1> state;
    state << c.centre(), c.velocity, c.rate;
    return state;
  };
  const std::uint32_t together[] = {0, 1, 2, 3}, apart[] = {5, 1030, 1500, 2403};
  const auto near = fly(together), far = fly(apart);
  EXPECT_GT(std::abs(near[3] + 5.0), 0.5); // it did hit the floor
  EXPECT_GT(std::abs(near[4]), 1.0);
  verify({"motion of a cluster with members in three blocks after an impact",
          "that of the same body within one block", 1e-8, "rounding, grown by 1500 steps"},
         (far - near).cwiseQuotient(near).cwiseAbs().maxCoeff());
}

TEST(Cluster, has_no_contacts_inside) {
  auto settings = cases::lattice_model<3>(LatticeType::cubic, {3, 3, 3}, rock(3));
  for (Vec<3>& x : settings.positions)
    x *= 0.4; // members overlap far more than others may
  std::vector<std::uint32_t> all(27);
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_THROW(dem::Engine<3>{settings}, std::invalid_argument);
  settings.clusters = {of_ids<3>(all)};
  dem::Engine<3> engine(settings);
  engine.start(1e-7);
  for (int n = 0; n < 10; ++n)
    cases::step(engine);
  EXPECT_EQ(engine.contacts().size(), 0u);
  EXPECT_EQ(engine.energies().elastic, 0.0);
  EXPECT_EQ(engine.particles().displacement[5], Vec<3>(Vec<3>::Zero()));
}

/// Largest eigenvalue of M^-1 K where the members of cluster 0 move as one.
template <int dim> double largest_with_cluster(const dem::Engine<dim>& engine) {
  constexpr int dofs = dim + rotations<dim>;
  const auto& p = engine.particles();
  const dem::Cluster<dim>& c = engine.clusters().all()[0];
  Eigen::MatrixXd K = cases::scaled_stiffness(engine);
  const Eigen::Index size = K.rows();
  for (Eigen::Index r = 0; r < size; ++r) {
    const auto root = [&](Eigen::Index row) {
      const auto i = static_cast<std::size_t>(row / dofs);
      return std::sqrt(row % dofs < dim ? p.mass[i] : p.inertia[i]);
    };
    for (Eigen::Index s = 0; s < size; ++s)
      K(r, s) *= root(r) * root(s);
  }
  std::vector<std::uint32_t> loose;
  for (std::uint32_t i = 0; i < p.size(); ++i)
    if (!p.is_member(i))
      loose.push_back(i);
  const auto reduced = static_cast<Eigen::Index>(loose.size() + 1) * dofs;
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(size, reduced),
                  M = Eigen::MatrixXd::Zero(reduced, reduced);
  for (std::size_t k = 0; k < loose.size(); ++k)
    for (int a = 0; a < dofs; ++a) {
      const auto column = static_cast<Eigen::Index>(k + 1) * dofs + a;
      T(static_cast<Eigen::Index>(loose[k]) * dofs + a, column) = 1.0;
      M(column, column) = a < dim ? p.mass[loose[k]] : p.inertia[loose[k]];
    }
  for (std::size_t k = 0; k < c.members.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(c.members[k]) * dofs;
    T.block(row, 0, dofs, dofs).setIdentity();
    for (int a = 0; a < rotations<dim>; ++a)
      T.template block<dim, 1>(row, dim + a) = spin<dim>(Rot<dim>::Unit(a), c.arms[k]);
  }
  M.template topLeftCorner<dim, dim>() = c.mass * Eigen::Matrix<double, dim, dim>::Identity();
  M.template block<rotations<dim>, rotations<dim>>(dim, dim) = c.inertia;
  const Eigen::MatrixXd reduced_K = T.transpose() * (0.5 * (K + K.transpose())) * T;
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(reduced_K, M,
                                                                   Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

// The bound of the critical step is never below the true frequency, and not far above it; also
// where the cluster is so light that it has the highest frequency itself.
template <int dim> void expect_safe_step() {
  for (const double ratio : {0.0, 0.2, 0.8})
    for (const double mass_factor : {1.0, 1e-3}) {
      auto settings = cases::irregular_model<dim>(dim == 2 ? 5 : 4, rock(dim, ratio), 7);
      const Vec<dim> middle = Vec<dim>::Constant(1.6 * spacing);
      settings.clusters.resize(1);
      settings.clusters[0].name = "middle";
      settings.clusters[0].box = Box<dim>{middle - Vec<dim>::Constant(1.3 * spacing),
                                          middle + Vec<dim>::Constant(1.2 * spacing)};
      if (mass_factor != 1.0)
        settings.clusters[0].mass =
            mass_factor * dem::Engine<dim>(settings).clusters().all()[0].mass;
      dem::Engine<dim> engine(settings);
      ASSERT_GE(engine.clusters().all()[0].members.size(), 4u);
      const double exact = largest_with_cluster(engine), bound = engine.step_limit().omega2;
      EXPECT_GE(bound, exact) << ratio;
      EXPECT_LT(bound, (mass_factor == 1.0 ? 4.0 : 8.0) * exact) << ratio;
      EXPECT_EQ(engine.step_limit().limited_by == "cluster 0", mass_factor != 1.0);
    }
}
TEST(Cluster, counts_in_the_critical_step_2d) {
  expect_safe_step<2>();
}
TEST(Cluster, counts_in_the_critical_step_3d) {
  expect_safe_step<3>();
}

// Reference: rotation about an axis through a point that is not the centre, exact in every step;
// work on a bond that is stretched to u, k u² / 2.
TEST(Cluster, moves_as_it_is_told) {
  auto settings = cases::lattice_model<3>(LatticeType::cubic, {2, 2, 1}, rock(3));
  settings.clusters = {of_ids<3>({0, 1, 2, 3})};
  dem::ClusterSettings<3>& told = settings.clusters[0];
  told.is_free = false;
  told.has_reference = true;
  told.motion.reference = {3e-3, -1e-3, 2e-3};
  told.motion.axis = {0.0, 1.0, 1.0};
  told.motion.rotation_rate = kerf::TimeTable({0.0, 1e-2}, {0.0, 200.0});
  told.motion.velocity[0] = kerf::TimeTable({0.0, 1e-2}, {0.3, -0.1});
  dem::Engine<3> engine(settings);
  const double dt = 1e-5;
  engine.start(dt);
  for (int n = 0; n < 1000; ++n)
    cases::step(engine);
  const double t = 1000 * dt, angle = 200.0 / 1e-2 * t * t / 2.0;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Vec<3>(0.0, 1.0, 1.0).normalized()).matrix();
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec<3> place = told.motion.reference + Vec<3>(0.1 * t, 0.0, 0.0) +
                         R * (settings.positions[i] - told.motion.reference);
    EXPECT_LT((engine.particles().position(i) - place).norm(), 1e-12);
  }
  // What drives it has done the work that its motion has; to first order in dt here.
  EXPECT_NEAR(engine.energies().kinetic,
              engine.energies().external_work + 0.5 * engine.clusters().all()[0].mass * 0.3 * 0.3,
              0.02 * engine.energies().kinetic);
}

TEST(Cluster, that_pulls_a_bond_does_its_elastic_work) {
  auto settings = cases::lattice_model<2>(LatticeType::chain, {4, 1}, rock(2));
  settings.boundary = {cases::prescribe_at<2>({3.0 * spacing, 0.0}, dem::Motion::fixed)};
  settings.clusters = {of_ids<2>({0, 1, 2})};
  settings.clusters[0].is_free = false;
  settings.clusters[0].motion.velocity[0] = kerf::TimeTable(-0.02);
  dem::Engine<2> engine(settings);
  const double dt = 1e-7, k = settings.material.normal_stiffness;
  engine.start(dt);
  for (int n = 0; n < 100; ++n) {
    cases::step(engine);
    const double u = 0.02 * n * dt;
    EXPECT_NEAR(engine.clusters().all()[0].load.force[0], k * u, 1e-7 * k * 2e-7);
    EXPECT_NEAR(engine.reaction(0).force[0], k * u, 1e-7 * k * 2e-7);
    EXPECT_NEAR(engine.energies().external_work, 0.5 * k * u * u, 1e-7 * k * 4e-14);
    EXPECT_NEAR(engine.clusters().all()[0].load_work.work(), -0.5 * k * u * u, 1e-7 * k * 4e-14);
  }
}

// Reference: at rest a floor carries the weight. The books miss what contacts do in the steps in
// which they close and open.
TEST(Cluster, comes_to_rest_on_a_floor_with_its_weight) {
  auto settings = cases::lattice_model<2>(LatticeType::triangular, {2, 2}, rock(2));
  settings.clusters = {of_ids<2>({0, 1, 2, 3})};
  settings.gravity = {0.0, -9.81};
  settings.damping = {.kind = dem::DampingKind::componentwise, .translation = 0.7, .rotation = 0.7};
  dem::ToolMotion<2> rests;
  settings.tools.push_back(
      {"floor",
       dem::ToolShape<2>(dem::Plane<2>{{0.0, -0.5 * spacing}, {0.0, 1.0}}),
       rests,
       {.normal_stiffness = 1e8, .tangential_stiffness = 2e7, .friction = 0.5}});
  dem::Engine<2> engine(settings);
  engine.start(0.05 * 2.0 / std::sqrt(engine.step_limit().omega2));
  for (int n = 0; n < 30000; ++n)
    cases::step(engine);
  const double weight = engine.clusters().all()[0].mass * 9.81;
  EXPECT_NEAR(engine.tools()[0].load().force[1], -weight, 1e-6 * weight);
  EXPECT_LT(engine.clusters().all()[0].load.force.norm(), 1e-6 * weight);
  const dem::Energies e = engine.energies();
  EXPECT_NEAR(e.kinetic + e.elastic, e.external_work - e.damping_dissipation,
              1e-2 * e.external_work);
}

TEST(Cluster, that_cannot_be_is_refused) {
  const auto base = [] { return cases::lattice_model<2>(LatticeType::square, {3, 3}, rock(2)); };
  const auto refused = [](const dem::Settings<2>& settings) {
    try {
      dem::Engine<2>{settings};
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  auto s = base();
  s.clusters = {of_ids<2>({0, 1}), of_ids<2>({1, 2})};
  EXPECT_NE(refused(s).find("particle 1 is in body, too"), std::string::npos) << refused(s);
  s = base();
  s.clusters = {of_ids<2>({0, 99})};
  EXPECT_NE(refused(s).find("there is no particle 99"), std::string::npos);
  s = base();
  s.clusters = {of_ids<2>({0, 1})};
  s.boundary = {cases::prescribe_at<2>({0.0, 0.0}, dem::Motion::fixed)};
  EXPECT_NE(refused(s).find("is in a cluster and in a boundary, too"), std::string::npos);
  s = base();
  s.clusters = {of_ids<2>({0, 1})};
  s.clusters[0].inertia = Rot<2>(-1.0);
  EXPECT_NE(refused(s).find("must be positive"), std::string::npos);
  s = base();
  s.clusters = {of_ids<2>({})};
  EXPECT_NE(refused(s).find("has no particles"), std::string::npos);
}

} // namespace
} // namespace kerf
