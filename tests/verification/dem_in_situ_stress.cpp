// Bodies that begin under stress: that it is the wanted one, that they rest, and what an opening
// does.
#include "dem_core/probe.hpp"
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::LatticeType;

template <int dim> constexpr std::uint8_t everything = (1u << (dim + 1)) - 1u;

template <int dim> Box<dim> bounds(const dem::Settings<dim>& settings) {
  Box<dim> box{settings.positions.front(), settings.positions.front()};
  for (const Vec<dim>& x : settings.positions) {
    box.lower = box.lower.cwiseMin(x);
    box.upper = box.upper.cwiseMax(x);
  }
  return box;
}

/// Holds what is nearer than a depth to a side of the box around all centres.
template <int dim>
void hold_side(dem::Settings<dim>& settings, int axis, bool is_upper, double depth,
               std::uint8_t components) {
  dem::Prescription<dim> side;
  side.box = bounds(settings);
  if (is_upper)
    side.box.lower[axis] = side.box.upper[axis] - depth;
  else
    side.box.upper[axis] = side.box.lower[axis] + depth;
  side.components = components;
  settings.boundary.push_back(side);
}

template <int dim> void hold_surface(dem::Settings<dim>& settings, double depth) {
  for (int a = 0; a < dim; ++a)
    for (const bool is_upper : {false, true})
      hold_side(settings, a, is_upper, depth, everything<dim>);
}

template <int dim> dem::Symmetric<dim> some_stress() {
  if constexpr (dim == 2)
    return {-5e6, -12e6, 2e6};
  else
    return {-5e6, -12e6, -8e6, 1e6, -2e6, 1.5e6};
}

template <int dim> void press(dem::Settings<dim>& settings, const dem::Symmetric<dim>& stress) {
  settings.in_situ_stress.emplace().uniform = stress;
}

template <int dim> dem::Engine<dim> started(const dem::Settings<dim>& settings) {
  dem::Engine<dim> engine(settings);
  engine.start(0.8 * 2.0 / std::sqrt(engine.step_limit().omega2));
  return engine;
}

/// Largest force that is left on a free component, over the mean contact force.
template <int dim> double largest_resultant(dem::Engine<dim>& engine) {
  engine.compute_own_forces();
  std::vector<std::uint32_t> all(engine.size());
  for (std::uint32_t i = 0; i < all.size(); ++i)
    all[i] = i;
  std::vector<double> force(engine.size() * dim);
  engine.own_forces(all, force);
  double largest = 0.0, sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < engine.size(); ++i)
    for (int a = 0; a < dim; ++a)
      if (!engine.boundary().prescribes(i, a))
        largest = std::max(largest, std::abs(force[i * dim + static_cast<std::size_t>(a)]));
  const dem::Contacts<dim>& c = engine.contacts();
  for (std::size_t k = 0; k < c.size(); ++k)
    if (c.bonded[k]) {
      sum += std::hypot(c.normal_force[k], c.shear_force[k].norm());
      count += 1.0;
    }
  return largest * count / sum;
}

/// Largest speed of 1000 steps over the one that a free surface would get from the stress,
/// sigma / (rho c) with c = sqrt(k / m) d.
template <int dim> double largest_speed(dem::Engine<dim>& engine, double stress) {
  double largest = 0.0;
  for (int n = 0; n < 1000; ++n) {
    cases::step(engine);
    for (const auto& v : engine.particles().velocity)
      largest = std::max(largest, v.norm());
  }
  const double k = engine.contacts().normal_stiffness[0], m = engine.particles().mass[0];
  const double c = std::sqrt(k / m) * spacing;
  return largest / (stress / (engine.particles().density[0] * c));
}

const std::string balance = "equilibrium of every particle at the start, in-situ stress",
                  rest = "nothing moves: speed over sigma / (rho c)";

void verify_balance(const std::string& body, double error) {
  verify({body + ": largest resultant of a free particle over the mean contact force", balance,
          1e-9,
          "a stress-free length has 16 digits, of which the strain of the stress takes 3 to 4"},
         error);
}
void verify_rest(const std::string& body, double error) {
  verify({body + ": largest speed in 1000 steps without damping", rest, 1e-6,
          "rounding of the forces, summed by the oscillation it makes"},
         error);
}
template <int dim>
void verify_mean(const std::string& what, const dem::Symmetric<dim>& found,
                 const dem::Symmetric<dim>& wanted, double tolerance, const std::string& reason) {
  verify({what, "the stress that was prescribed", tolerance, reason},
         (found - wanted).norm() / wanted.norm());
}

// Without order: forces of single bonds differ much, all particles are in equilibrium. A probe in
// the middle sees fewer than ten particles along an edge, and cuts contacts.
template <int dim> void expect_rest(int edge, const std::string& name) {
  auto settings = cases::irregular_model<dim>(edge, rock(dim, 0.4), 21);
  hold_surface<dim>(settings, 1.3 * spacing);
  const auto wanted = some_stress<dim>();
  press<dim>(settings, wanted);
  auto engine = started(settings);
  verify_balance(name, largest_resultant(engine));
  verify_mean<dim>(name + ": mean stress of the cells inside", engine.in_situ_stress()->found,
                   wanted, 1e-9, "linear solution, to round-off");
  const Box<dim> all = bounds(settings);
  const Vec<dim> cut = 0.2 * (all.upper - all.lower);
  verify_mean<dim>(name + ": stress that a probe reads in the middle",
                   dem::read_probe<dim>({all.lower + cut, all.upper - cut}, engine.period(),
                                        engine.contacts(), engine.particles())
                       .stress,
                   wanted, 0.12, "stress of single bonds over a box a few particles wide");
  verify_rest(name, largest_speed(engine, wanted.norm()));
  EXPECT_EQ(engine.bonds(), engine.bonds_at_start());
}
TEST(InSituStress, of_a_body_without_order_is_in_equilibrium_2d) {
  expect_rest<2>(20, "irregular discs");
}
TEST(InSituStress, of_a_body_without_order_is_in_equilibrium_3d) {
  expect_rest<3>(8, "irregular spheres");
}

template <int dim>
void expect_rest_in_a_lattice(LatticeType type, int edge, const std::string& name) {
  std::array<int, dim> count;
  count.fill(edge);
  auto settings = cases::lattice_model<dim>(type, count, rock(dim, 0.4));
  hold_surface<dim>(settings, 0.6 * spacing);
  const auto wanted = some_stress<dim>();
  press<dim>(settings, wanted);
  auto engine = started(settings);
  verify_balance(name, largest_resultant(engine));
  verify_rest(name, largest_speed(engine, wanted.norm()));
  // All cells of a lattice have the same stress.
  const auto stress = dem::particle_stress(engine.contacts(), engine.particles());
  const Box<dim> all = bounds(settings);
  const double solid = dim == 2 ? std::numbers::pi / (2.0 * std::sqrt(3.0))
                                : std::numbers::pi / (3.0 * std::sqrt(2.0));
  double worst = 0.0;
  for (std::size_t i = 0; i < engine.size(); ++i) {
    const Vec<dim>& x = settings.positions[i];
    if (((x - all.lower).array() > 2.1 * spacing).all() &&
        ((all.upper - x).array() > 2.1 * spacing).all())
      worst = std::max(worst, (solid * stress[i] - wanted).norm() / wanted.norm());
  }
  EXPECT_GT(worst, 0.0);
  verify({name + ": stress of every particle inside", "the stress that was prescribed", 1e-6,
          "the same strain everywhere; what is left after 1000 steps"},
         worst);
}
TEST(InSituStress, is_the_same_at_all_particles_of_a_lattice_2d) {
  expect_rest_in_a_lattice<2>(LatticeType::triangular, 14, "triangular lattice");
}
TEST(InSituStress, is_the_same_at_all_particles_of_a_lattice_3d) {
  expect_rest_in_a_lattice<3>(LatticeType::fcc, 6, "fcc lattice");
}

template <int dim> void expect_wanted_in_a_period(int edge, const std::string& name) {
  std::array<int, dim> count;
  count.fill(edge);
  auto settings = cases::lattice_model<dim>(dim == 2 ? LatticeType::square : LatticeType::cubic,
                                            count, rock(dim, 0.4));
  std::mt19937 random(5);
  for (Vec<dim>& x : settings.positions)
    for (int a = 0; a < dim; ++a)
      x[a] += (static_cast<double>(random()) / 4294967295.0 - 0.5) * 0.2 * spacing;
  settings.gap_tolerance = 0.6; // across the diagonals, too
  settings.period.length = Vec<dim>::Constant(edge * spacing);
  const auto wanted = some_stress<dim>();
  press<dim>(settings, wanted);
  auto engine = started(settings);
  verify_balance(name, largest_resultant(engine));
  const Vec<dim> slack = Vec<dim>::Constant(1e-9 * spacing), from = -0.37 * settings.period.length;
  verify_mean<dim>(name + ": stress that a probe reads in a whole period",
                   dem::read_probe<dim>({from + slack, from + settings.period.length - slack},
                                        engine.period(), engine.contacts(), engine.particles())
                       .stress,
                   wanted, 1e-6, "linear solution; the probe is 1e-9 of an edge too small");
  verify_rest(name, largest_speed(engine, wanted.norm()));
}
TEST(InSituStress, is_the_mean_over_a_period_2d) {
  expect_wanted_in_a_period<2>(8, "periodic discs");
}
TEST(InSituStress, is_the_mean_over_a_period_3d) {
  expect_wanted_in_a_period<3>(5, "periodic spheres");
}

// sigma_v = rho g depth below a free surface and K0 of it across, between smooth sides, which are
// held along their normal. Bulk density of the lattice: rho pi / (2 sqrt 3). Rows are depth apart,
// so that a row carries what is above the middle of the row.
TEST(InSituStress, grows_with_the_depth_below_a_free_surface) {
  constexpr double K0 = 0.6, g = 9.81e3; // as if the body were 1000 times higher
  auto settings = cases::lattice_model<2>(LatticeType::triangular, {30, 31}, rock(2, 0.4));
  const double row = 0.5 * std::sqrt(3.0) * spacing, top = bounds(settings).upper[1] + 0.5 * row;
  const double density = rock(2).density * std::numbers::pi / (2.0 * std::sqrt(3.0));
  settings.gravity = {0.0, -g};
  hold_side(settings, 0, false, 0.6 * spacing, 1u);
  hold_side(settings, 0, true, 0.6 * spacing, 1u);
  hold_side(settings, 1, false, 0.5 * row, 2u);
  auto& stress = settings.in_situ_stress.emplace();
  stress.K0 = K0;
  stress.surface = top;
  auto engine = started(settings);
  verify_balance("K0 state in a lattice", largest_resultant(engine));
  EXPECT_NEAR(engine.in_situ_stress()->bulk_density, density, 1e-9 * density);
  for (const int from : {6, 14, 22}) {
    const Vec<2> lower(4.25 * spacing, (from - 0.25) * row); // between all places of contacts
    const Vec<2> upper = lower + Vec<2>(20.0 * spacing, 4.0 * row);
    const double depth = top - 0.5 * (lower[1] + upper[1]), sigma_v = density * g * depth;
    const auto found =
        dem::read_probe<2>({lower, upper}, engine.period(), engine.contacts(), engine.particles());
    verify_mean<2>("K0 state in a lattice: stress that probes read at three depths", found.stress,
                   {-K0 * sigma_v, -sigma_v, 0.0}, 0.03,
                   "contacts count where they are: a quarter of a row in a depth of 8 rows");
  }
  verify_rest("K0 state in a lattice", largest_speed(engine, density * g * top));
}

/// Discs without order between four planes that reach into them.
dem::Settings<2> between_planes(double depth) {
  auto settings = cases::irregular_model<2>(20, rock(2, 0.4), 4);
  const Box<2> all = bounds(settings);
  for (int a = 0; a < 2; ++a)
    for (const double side : {1.0, -1.0}) {
      const Vec<2> normal = side * Vec<2>::Unit(a);
      double least = all.upper.norm(); // where the body begins
      for (std::size_t i = 0; i < settings.radii.size(); ++i)
        least = std::min(least, normal.dot(settings.positions[i]) - settings.radii[i]);
      dem::ToolSettings<2> tool{
          .name = "side",
          .shape = dem::ToolShape<2>(dem::Plane<2>{(least + depth) * normal, normal}),
          .motion = {},
          .material = {}};
      tool.motion.reference = (least + depth) * normal;
      tool.material.normal_stiffness = 1e10;
      settings.tools.push_back(tool);
    }
  press<2>(settings, {-5e6, -12e6, 0.0});
  return settings;
}

// Equilibrium of the whole body: the stress of the contacts, over the area between the planes, is
// what their forces give.
TEST(InSituStress, is_carried_by_tools_around_the_body) {
  auto settings = between_planes(0.4 * spacing);
  auto engine = started(settings);
  verify_balance("discs between planes", largest_resultant(engine));
  cases::step(engine);
  const auto place = [&](std::size_t k) { return engine.tools()[k].pose().start; };
  const Vec<2> size(place(1)[0] - place(0)[0], place(3)[1] - place(2)[1]);
  EXPECT_GT(size.minCoeff(), 15.0 * spacing);
  for (int a = 0; a < 2; ++a)
    for (const int side : {0, 1}) {
      const double force = engine.tools()[static_cast<std::size_t>(2 * a + side)].load().force[a];
      const double wanted =
          (side == 0 ? -1.0 : 1.0) * -settings.in_situ_stress->uniform[a] * size[1 - a];
      verify({"discs between planes: force on a plane over stress times area",
              "the stress that was prescribed", 0.05,
              "the mean is taken over the cells inside, the planes feel the edge, too"},
             force / wanted - 1.0);
    }
  verify_rest("discs between planes", largest_speed(engine, 13e6));
  EXPECT_GT(engine.in_situ_stress()->wall_contacts, 30u);
}

// The opening of a round hole whose rim was held: a plane ring with the outer edge b fixed goes in
// by u = p a (b² - a²) / (2 (lambda + G) a² + 2 G b²) (Lamé). C11 = sqrt(3)/4 (3 k_n + k_t), C12 =
// sqrt(3)/4 (k_n - k_t): isotropic.
TEST(InSituStress, closes_a_hole_whose_rim_is_let_go) {
  const double a = 8.0 * spacing, b = 34.0 * spacing, p = 10e6, k_t = 0.4e10, k_n = 1e10;
  auto settings = cases::lattice_model<2>(LatticeType::triangular, {72, 84}, rock(2, 0.4));
  const Box<2> all = bounds(settings);
  const Vec<2> centre = 0.5 * (all.lower + all.upper);
  std::erase_if(settings.positions, [&](const Vec<2>& x) {
    return (x - centre).norm() < a || (x - centre).norm() > b + spacing;
  });
  settings.radii.resize(settings.positions.size());
  const auto hold = [&](double from, double to) {
    std::vector<dem::Prescription<2>> held;
    for (const Vec<2>& x : settings.positions)
      if ((x - centre).norm() >= from && (x - centre).norm() < to) {
        held.push_back(cases::prescribe_at<2>(x, dem::Motion::fixed));
        held.back().components = everything<2>;
      }
    return held;
  };
  settings.boundary = hold(b, 2.0 * b);
  const auto rim = hold(0.0, a + spacing);
  settings.boundary.insert(settings.boundary.end(), rim.begin(), rim.end());
  settings.damping = {dem::DampingKind::nonviscous, 0.5, 0.5};
  press<2>(settings, {-p, -p, 0.0});
  auto engine = started(settings);
  verify_balance("plate with a held hole", largest_resultant(engine));
  for (int n = 0; n < 100; ++n)
    cases::step(engine);
  EXPECT_LT(engine.unbalanced_force(), 1e-9);

  dem::Change<2> release;
  release.boundary = hold(b, 2.0 * b);
  engine.change(release);
  for (int n = 0; n < 3000; ++n)
    cases::step(engine);
  verify({"round hole let go: mean resultant over the mean contact force in the end", "equilibrium",
          1e-4, "30 passages of a wave with a damping of 0.5"},
         engine.unbalanced_force());
  EXPECT_EQ(engine.bonds(), engine.bonds_at_start());

  const double G = 0.25 * std::sqrt(3.0) * (k_n + k_t);
  const double lambda = 0.25 * std::sqrt(3.0) * (k_n - k_t);
  double closure = 0.0, expected = 0.0, count = 0.0;
  for (std::size_t i = 0; i < engine.size(); ++i) {
    const Vec<2> x = settings.positions[i] - centre;
    const double r = x.norm();
    if (r > 1.5 * a)
      continue;
    closure -= engine.particles().displacement[i].dot(x) / r;
    expected += p * a * a * (b * b / r - r) / (2.0 * (lambda + G) * a * a + 2.0 * G * b * b);
    count += 1.0;
  }
  EXPECT_GT(count, 100.0);
  verify({"round hole let go: how far the rock around it moves in", "ring under pressure, Lamé",
          0.1, "the rim of a hole with a radius of 8 discs is known to half a disc"},
         closure / expected - 1.0);
}

TEST(InSituStress, that_cannot_be_is_refused) {
  const auto refused = [](const dem::Settings<2>& settings) {
    try {
      dem::Engine<2>{settings};
    } catch (const dem::ImpossibleStress& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto expect_in = [](const std::string& part, const std::string& text) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  auto settings = cases::lattice_model<2>(LatticeType::triangular, {10, 10}, rock(2));
  press<2>(settings, some_stress<2>());
  expect_in("hold the particles at its surface", refused(settings));
  hold_surface<2>(settings, 0.6 * spacing);
  EXPECT_EQ(refused(settings), "");
  auto weak = settings;
  weak.material.shear_strength = 1.0;
  expect_in("would have a shear force of", refused(weak));
  expect_in("its strength is 1 N", refused(weak));
  weak = settings;
  weak.ids.resize(weak.positions.size(), 77);
  weak.material.tensile_strength = 1.0;
  weak.in_situ_stress->uniform *= -1.0;
  expect_in("the bond of particles 77 and 77 would have a normal force of", refused(weak));
  auto heavy = settings;
  heavy.period.length = {10.0 * spacing, 5.0 * std::sqrt(3.0) * spacing};
  heavy.boundary.clear();
  EXPECT_EQ(refused(heavy), "");
  heavy.gravity = {0.0, -9.81};
  expect_in("no equilibrium", refused(heavy)); // the body would fall for ever
  auto loose = settings;
  loose.bonds = false;
  expect_in("no bonds", refused(loose));
  loose = settings;
  loose.clusters.emplace_back().ids = {55, 56};
  expect_in("clusters", refused(loose));
  loose = between_planes(0.4 * spacing);
  loose.in_situ_stress->uniform *= 1e3; // the tools give way by more than they overlap
  expect_in("let the tool reach deeper", refused(loose));
}

} // namespace
} // namespace kerf
