// Loads, dashpots, walls and prescribed tables: their resultants, and the books that close with
// them.
#include "tests/cases/fem_bodies.hpp"

#include "fem_core/input_error.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kerf::fem {
namespace {

using cases::rock;

double safe_step(const auto& engine) {
  return 0.8 * 2.0 / std::sqrt(engine.step_limit().omega2);
}

template <int dim> Vec<dim> total(Engine<dim>& engine) {
  engine.start(1e-9);
  engine.compute_own_forces();
  std::vector<double> f(engine.mesh().num_nodes() * dim);
  engine.own_forces(cases::all_nodes(engine), f);
  Vec<dim> sum = Vec<dim>::Zero();
  for (std::size_t a = 0; a < engine.mesh().num_nodes(); ++a)
    sum += Eigen::Map<const Vec<dim>>(&f[a * dim]);
  return sum;
}

/// A block of 3 x 4 (x 5) mm under a load.
template <int dim> Engine<dim> loaded(Shape shape, const LoadSetting<dim>& load) {
  Settings<dim> settings{.materials = cases::of<dim>(rock)};
  settings.loads = {load};
  return Engine<dim>(cases::distorted_box<dim>(shape), settings);
}

template <int dim>
const std::vector<Shape> shapes =
    dim == 2 ? std::vector{Shape::tri3, Shape::quad4} : std::vector{Shape::tet4, Shape::hex8};

template <class Dim> struct FemLoads : testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FemLoads, Dimensions);

// Resultants: the force as given, traction times area, minus pressure times area along the normal.
TYPED_TEST(FemLoads, have_the_resultants_of_their_definition) {
  constexpr int dim = TypeParam::value;
  const Vec<dim> size = Vec<dim>::LinSpaced(dim, 3.0, 5.0) * 1e-3;
  const double right = size.tail(dim - 1).prod(); // area of the right side
  Vec<dim> value;
  std::array<TimeTable, dim> table;
  for (int i = 0; i < dim; ++i)
    table[static_cast<std::size_t>(i)] = TimeTable(value[i] = 7.0 - 3.0 * i);
  for (const Shape shape : shapes<dim>) {
    auto force = loaded<dim>(shape, {.tag = "right", .kind = LoadKind::force, .value = table});
    EXPECT_LE((total(force) - value).norm(), 1e-14 * value.norm());
    auto nodes = loaded<dim>(shape, {.tag = "all", .kind = LoadKind::force, .value = table});
    EXPECT_LE((total(nodes) - value).norm(), 1e-13 * value.norm());
    auto traction =
        loaded<dim>(shape, {.tag = "right", .kind = LoadKind::traction, .value = table});
    EXPECT_LE((total(traction) - right * value).norm(), 1e-14 * right * value.norm());
    auto pressure =
        loaded<dim>(shape, {.tag = "right", .kind = LoadKind::pressure, .value = table});
    EXPECT_LE((total(pressure) + right * value[0] * Vec<dim>::Unit(0)).norm(),
              1e-14 * right * value[0]);
  }
}

// A closed surface under pressure feels no resultant, however its faces are warped: the integral of
// n dA over a closed surface is zero.
TYPED_TEST(FemLoads, of_pressure_all_round_cancel_on_a_deformed_body) {
  constexpr int dim = TypeParam::value;
  for (const Shape shape : shapes<dim>) {
    Settings<dim> settings{.materials = cases::of<dim>(rock)};
    Mesh<dim> mesh = cases::distorted_box<dim>(shape);
    for (const auto& [tag, faces] : mesh.boundary)
      settings.loads.push_back({.tag = tag, .kind = LoadKind::pressure, .value = {1e6}});
    Engine<dim> engine(mesh, settings);
    engine.start(1e-9);
    const Eigen::VectorXd u =
        Eigen::VectorXd::Random(static_cast<Eigen::Index>(mesh.positions.size())) * 2e-4;
    engine.set_motion(std::vector<double>(u.begin(), u.end()),
                      std::vector<double>(mesh.positions.size()));
    engine.compute_own_forces();
    std::vector<double> f(mesh.positions.size());
    engine.own_forces(cases::all_nodes(engine), f);
    Vec<dim> sum = Vec<dim>::Zero();
    double most = 0.0;
    for (std::size_t a = 0; a < mesh.num_nodes(); ++a) {
      sum += Eigen::Map<const Vec<dim>>(&f[a * dim]);
      most = std::max(most, Eigen::Map<const Vec<dim>>(&f[a * dim]).norm());
    }
    EXPECT_LE(sum.norm(), 1e-12 * most); // internal forces cancel too
  }
}

// Pressure on the outer side of a ring: p times 2 pi r times the height, by Guldin's rule.
TEST(FemLoads, of_pressure_on_a_ring_act_on_its_whole_circumference) {
  Mesh<2> mesh = make_box(BoxMesh<2>{.origin = {5e-3, 0.0}, .size = {3e-3, 4e-3}, .count = {3, 4}});
  Settings<2> settings{.materials = cases::of<2>(rock), .plane = Plane::axisymmetric};
  settings.loads = {{.tag = "right", .kind = LoadKind::pressure, .value = {1e6}}};
  Engine<2> engine(mesh, settings);
  const double exact = -1e6 * 2.0 * std::numbers::pi * 8e-3 * 4e-3;
  EXPECT_NEAR(total(engine)[0], exact, 1e-13 * std::abs(exact));
}

/// Largest deviation of the balance over a run, over the largest work.
template <int dim> double imbalance(Engine<dim>& engine, int steps) {
  engine.start(safe_step(engine));
  engine.integrate();
  const double start = engine.energies().balance();
  double most = 0.0, error = 0.0;
  for (int n = 1; n < steps; ++n) {
    engine.integrate();
    const Energies e = engine.energies();
    most = std::max({most, std::abs(e.external_work), e.kinetic});
    error = std::max(error, std::abs(e.balance() - start));
  }
  EXPECT_GT(most, 0.0);
  return error / most;
}

// Every force is booked with the velocities that it works on, so the balance of a linear body
// closes to the rounding of some hundred steps, with damping, dashpots, walls and friction too.
TEST(FemBooks, close_with_loads_gravity_damping_dashpots_and_walls) {
  const BoxMesh<2> bar{.size = {20e-3, 3e-3}, .count = {20, 3}};
  Settings<2> settings{.materials = cases::of<2>(rock)};
  settings.gravity = {3e5, -9e5};
  settings.mass_damping = 1e4;
  settings.local_damping = 0.1;
  settings.loads = {{.tag = "top",
                     .kind = LoadKind::traction,
                     .value = {TimeTable({0.0, 1e-5}, {0.0, 1e6}), TimeTable(-2e6)}}};
  settings.absorbing = {{.tag = "right"}};
  settings.walls = {{.tag = "bottom", .point = {0.0, 0.0}, .normal = {0.0, 1.0}, .friction = 0.3}};
  settings.boundary = {{.tag = "left",
                        .box = {},
                        .components = {true, false},
                        .motion = Motion::velocity_table,
                        .table = {TimeTable({0.0, 2e-5}, {0.0, 1.0}), TimeTable()}}};
  Engine<2> engine(make_box(bar), settings);
  EXPECT_LE(imbalance(engine, 300), 1e-11);
  EXPECT_GT(engine.energies().damped, 0.0);
  EXPECT_GT(engine.wall_force(0)[1], 0.0);
}

// A motion table is met exactly: the integral of a velocity that rises linearly is v t / 2.
TEST(FemBoundary, follows_tables_of_displacement_and_of_velocity_exactly) {
  const BoxMesh<2> bar{.size = {20e-3, 3e-3}, .count = {20, 3}};
  Settings<2> settings{.materials = cases::of<2>(rock)};
  settings.boundary = {{.tag = "left",
                        .box = {},
                        .components = {true, false},
                        .motion = Motion::velocity_table,
                        .table = {TimeTable({0.0, 1.0}, {0.0, 2e5}), TimeTable()}},
                       {.tag = "left",
                        .box = {},
                        .components = {false, true},
                        .motion = Motion::displacement_table,
                        .table = {TimeTable(), TimeTable({0.0, 1e-6, 3e-6}, {0.0, 1e-6, 0.0})}}};
  Engine<2> engine(make_box(bar), settings);
  const double dt = safe_step(engine);
  engine.start(dt);
  for (int n = 1; n <= 12; ++n) {
    engine.integrate();
    const double t = n * dt, y = t < 1e-6 ? t : std::max(0.0, 1e-6 - 0.5 * (t - 1e-6));
    EXPECT_NEAR(engine.displacement()[0], 1e5 * t * t, 1e-14 * 1e-6);
    EXPECT_NEAR(engine.displacement()[1], y, 1e-14 * 1e-6);
  }
}

TEST(FemBoundary, holds_the_normal_of_a_plane_of_symmetry) {
  const BoxMesh<3> box{.size = {3e-3, 3e-3, 3e-3}, .count = {2, 2, 2}};
  Settings<3> settings{.materials = cases::of<3>(rock)};
  settings.boundary = {{.tag = "bottom", .box = {}, .components = {}, .motion = Motion::symmetry}};
  Engine<3> engine(make_box(box), settings);
  std::vector<double> inverse(3);
  engine.inverse_mass(std::vector<std::uint32_t>{0}, inverse);
  EXPECT_GT(inverse[0], 0.0);
  EXPECT_EQ(inverse[1], 0.0);
  EXPECT_GT(inverse[2], 0.0);
}

// One-dimensional wave in a column of quads with sliding sides: the dashpot has the impedance of
// the column, so what comes back is what the mesh and the lumping reflect, (k h)² / 24 and less of
// a pulse of 20 elements; energy goes with its square.
TEST(FemAbsorbing, lets_a_normal_wave_out) {
  const double h = 1e-3, A = 1e-8;
  for (const int component : {0, 1}) {
    const double speed = std::sqrt((component == 0 ? 12e9 : 4e9) / 2500.0);
    Settings<2> settings{.materials = cases::of<2>(rock)};
    settings.initial = {cases::started<2>({.amplitude = A,
                                           .center = 60 * h,
                                           .length = 40 * h,
                                           .wave_speed = speed,
                                           .spacing = h,
                                           .component = component})};
    settings.absorbing = {{.tag = "right"}};
    Engine<2> engine(
        make_box(BoxMesh<2>{.size = {100 * h, 3 * h}, .count = {100, 3}}, {.length = {0.0, 3 * h}}),
        settings);
    engine.start(safe_step(engine));
    engine.integrate();
    const double start = engine.energies().kinetic + engine.energies().elastic;
    while (static_cast<double>(engine.step()) * safe_step(engine) < 90 * h / speed)
      engine.integrate();
    const Energies e = engine.energies();
    EXPECT_LE(e.kinetic + e.elastic, 1e-4 * start) << component;
    EXPECT_NEAR(e.damped, start, 1e-3 * start);
  }
}

// A wave injected at one absorbing end has the velocity that it was given, and leaves by the other.
// The tolerance is the dispersion over 60 elements of a pulse of 40.
TEST(FemAbsorbing, lets_a_given_wave_in) {
  const double h = 1e-3;
  std::vector<double> times, values;
  for (const int component : {0, 1}) {
    const double speed = std::sqrt((component == 0 ? 12e9 : 4e9) / 2500.0);
    const double duration = 40 * h / speed;
    times.clear();
    values.clear();
    for (int k = 0; k <= 200; ++k) {
      times.push_back(duration * k / 200);
      values.push_back(std::pow(std::sin(std::numbers::pi * k / 200), 2));
    }
    Settings<2> settings{.materials = cases::of<2>(rock)};
    settings.absorbing = {{.tag = "left",
                           .wave = IncomingWave<2>{.direction = {1.0, 0.0},
                                                   .polarization = Vec<2>::Unit(component),
                                                   .origin = {0.0, 0.0},
                                                   .velocity = TimeTable(times, values)}},
                          {.tag = "right"}};
    Engine<2> engine(
        make_box(BoxMesh<2>{.size = {100 * h, 3 * h}, .count = {100, 3}}, {.length = {0.0, 3 * h}}),
        settings);
    const double dt = safe_step(engine);
    engine.start(dt);
    double most = 0.0;
    const std::size_t middle = 50 * 2 + static_cast<std::size_t>(component);
    while (static_cast<double>(engine.step()) * dt < (50 * h + 60 * h) / speed) {
      engine.integrate();
      most = std::max(most, engine.velocity()[middle]);
    }
    EXPECT_NEAR(most, 1.0, 0.01) << component;
    while (static_cast<double>(engine.step()) * dt < (100 * h + 90 * h) / speed)
      engine.integrate();
    const Energies e = engine.energies();
    EXPECT_LE(e.kinetic + e.elastic, 1e-3 * e.external_work);
  }
}

// A block falls on a wall: no rebound of the nodes that meet it, and nobody is behind it.
TEST(FemWalls, hold_back_what_falls_on_them) {
  Settings<2> settings{.materials = cases::of<2>(rock)};
  settings.initial = {{.box = {}, .velocity = InitialVelocity<2>{{2.0, -5.0}}, .pulse = {}}};
  settings.walls = {{.tag = "all", .point = {0.0, -1e-4}, .normal = {0.0, 2.0}, .friction = 0.2}};
  Engine<2> engine(cases::distorted_box<2>(), settings);
  EXPECT_LE(imbalance(engine, 400), 1e-11);
  const Engine<2>& after = engine;
  const std::vector<double> u = after.displacement();
  for (std::size_t a = 0; a < after.mesh().num_nodes(); ++a)
    EXPECT_GE(after.mesh().position(a)[1] + u[2 * a + 1], -1e-4 - 1e-15);
  EXPECT_GT(engine.momentum()[1], 0.0); // it springs back as a whole, and friction slowed it
  EXPECT_LT(engine.momentum()[0], 2.0 * 2500.0 * 3e-3 * 5e-3);
}

TEST(FemLoads, refuse_what_cannot_be_meant) {
  const auto key = [](const LoadSetting<2>& load) -> std::string {
    try {
      loaded<2>(Shape::quad4, load);
    } catch (const InputError& error) {
      return error.key();
    }
    return "nothing was thrown";
  };
  EXPECT_EQ(key({.tag = "rihgt"}), "loads[0].tag");
  EXPECT_EQ(key({.tag = ""}), "loads[0].tag");
  EXPECT_EQ(key({.tag = "all", .kind = LoadKind::pressure}), "loads[0].tag");
  EXPECT_EQ(key({.tag = "", .box = Box<2>{.lower = {1.0, 1.0}, .upper = {2.0, 2.0}}}),
            "loads[0].box");
}

} // namespace
} // namespace kerf::fem
