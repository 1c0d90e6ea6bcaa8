// Contacts of particles with tools: where they are, what they carry along, what they add up to.
#include "common/results.hpp"
#include "dem_core/program/tool_output.hpp"
#include "tests/cases/dem_models.hpp"
#include "tests/cases/surfaces.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <filesystem>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::Plane;
using dem::ToolMotion;
using dem::ToolShape;
using dem::WallMaterial;

const WallMaterial rough{
    .normal_stiffness = 1e7, .tangential_stiffness = 5e6, .friction = 0.4, .seated = false};

template <int dim>
dem::ToolSettings<dim> plane(const Vec<dim>& point, const Vec<dim>& normal,
                             const WallMaterial& material = rough,
                             const ToolMotion<dim>& motion = {}) {
  return {"plane", ToolShape<dim>(Plane<dim>{point, normal}), motion, material};
}

/// One particle of radius 1 mm at a place.
template <int dim> dem::Settings<dim> one_particle(const Vec<dim>& x) {
  dem::Settings<dim> settings;
  settings.positions = {x};
  settings.radii = {1e-3};
  settings.material = rock(dim);
  return settings;
}

template <int dim> std::vector<FacetContact<dim>> places(const dem::WallContacts<dim>& contacts) {
  std::vector<FacetContact<dim>> all;
  contacts.for_each([&](const auto&, const FacetContact<dim>& place) { all.push_back(place); });
  return all;
}

TEST(WallContacts, press_with_the_normal_stiffness_of_the_tool) {
  auto settings = one_particle<2>({0.3, 0.9e-3});
  settings.tools = {plane<2>({0.0, 0.0}, {0.0, 1.0})};
  dem::Engine<2> engine(settings);
  engine.start(1e-8);
  engine.compute_own_forces();
  double force[2];
  const std::uint32_t particle = 0;
  engine.own_forces({&particle, 1}, force);
  EXPECT_NEAR(force[1], 1e7 * 0.1e-3, 1e-8);
  EXPECT_NEAR(engine.tools()[0].load().force[1], -1e7 * 0.1e-3, 1e-8);
  EXPECT_EQ(engine.tools()[0].load().stiffness, 1e7);
}

TEST(WallContacts, that_are_seated_are_free_of_stress_at_the_start_and_pull_never) {
  auto settings = one_particle<2>({0.3, 0.9e-3});
  auto seated = rough;
  seated.seated = true;
  ToolMotion<2> motion;
  motion.velocity[1] = kerf::TimeTable({0.0, 1e-3, 2e-3}, {10.0, 10.0, -40.0});
  settings.tools = {plane<2>({0.0, 0.0}, {0.0, 1.0}, seated, motion)};
  settings.boundary = {cases::prescribe_at<2>(settings.positions[0], dem::Motion::fixed)};
  dem::Engine<2> engine(settings);
  engine.start(1e-6);
  EXPECT_EQ(engine.energies().elastic, 0.0);
  for (int n = 0; n < 1900; ++n) {
    cases::step(engine);
    // Pressed in: 10 m/s for a millisecond is 10 mm; a force for what is beyond the seat only.
    const double deeper = engine.tools()[0].pose().reference[1]; // m
    EXPECT_NEAR(engine.tools()[0].load().force[1], -1e7 * std::max(0.0, deeper), 1e-6);
  }
}

// Reference: whatever moves as one body with the tool does not slip, so its shear force turns with
// it. Tolerance: the particle comes on chords, the slip of a step is of the order of the angle
// cubed times the arm.
template <int dim> void shear_turns_with_the_tool() {
  auto settings = one_particle<dim>(Vec<dim>::UnitX() * 0.9e-3);
  auto particles = dem::make_particles<dim>(settings.positions, settings.radii, 2600.0);
  ToolMotion<dim> motion;
  motion.reference = Vec<dim>::UnitY() * 2e-3;
  motion.rotation_rate = 1.0;
  if constexpr (dim == 3)
    motion.axis = {1.0, -2.0, 2.0};
  dem::Tool<dim> tool(ToolShape<dim>(Plane<dim>{Vec<dim>::Zero(), Vec<dim>::UnitX()}), motion);
  dem::WallContacts<dim> contacts({1e7, 5e6, 10.0, false}, tool, particles, 1e-4, {});
  dem::Loads<dim> loads;
  loads.own.resize(1);

  const double dt = 1e-3;
  const Vec<dim> slip = Vec<dim>::UnitY() * 1e-6;
  std::vector<dem::Aligned<Vec<dim>>> moved = {slip};
  std::vector<dem::Aligned<Rot<dim>>> turned(1);
  particles.displacement[0] = slip;
  tool.begin_step(0, dt);
  contacts.begin_step(tool, particles, 0.0);
  contacts.compute(0, tool, particles, {moved, turned, 1.0}, 0.0, loads);
  tool.end_step();
  const Vec<dim> start = loads.own[0].force;
  const Vec<dim> body = particles.position(0);
  EXPECT_NEAR(start[1], -5e6 * 1e-6, 1e-12);

  for (int n = 1; n <= 1000; ++n) {
    tool.begin_step(n, dt);
    const Vec<dim> before = particles.displacement[0];
    particles.displacement[0] = tool.pose().to_space(body) - particles.reference[0];
    moved[0] = particles.displacement[0] - before;
    turned[0] = dt * tool.velocity().rotation;
    loads.own[0] = {};
    contacts.begin_step(tool, particles, dt);
    contacts.compute(0, tool, particles, {moved, turned, 1.0}, dt, loads);
    tool.end_step();
  }
  const double error = (loads.own[0].force - tool.pose().rotation * start).norm() / start.norm();
  std::printf("shear carried over one radian in %dD: off by %.1e\n", dim, error);
  const double slip_of_all = 1000 * dt * dt * dt * 4e-3; // m
  EXPECT_LT(error, 5e6 * slip_of_all / start.norm());
}
TEST(WallContacts, carry_their_shear_force_along_with_a_tool_that_turns_in_2D) {
  shear_turns_with_the_tool<2>();
}
TEST(WallContacts, carry_their_shear_force_along_with_a_tool_that_turns_in_3D) {
  shear_turns_with_the_tool<3>();
}

/// A shaken, breaking body between a turning box and a plane.
dem::Settings<3> milled_body(int edge) {
  auto settings = cases::irregular_model<3>(edge, rock(3, 0.5), 3);
  settings.material.friction = 0.3;
  settings.material.tensile_strength = 2.0;
  settings.material.shear_strength = 2.0;
  cases::shake(settings, 1.0, 4);
  const double width = edge * spacing;
  Surface<3> box = cases::box_surface({2.0 * width, 2.0 * width, width});
  for (Vec<3>& vertex : box.vertices)
    vertex += Vec<3>(-0.5 * width, -0.5 * width, width - 0.45 * spacing);
  ToolMotion<3> motion;
  motion.reference = {0.5 * width, 0.5 * width, width};
  motion.axis = {0.1, 0.0, 1.0};
  motion.rotation_rate = 1e3;
  motion.velocity[2] = -5.0;
  settings.tools = {plane<3>({0.0, 0.0, -0.45 * spacing}, {0.0, 0.05, 1.0}),
                    {"mill", ToolShape<3>(box), motion, rough}};
  return settings;
}

// Newton's third law. All other forces come in opposite pairs, too. Tolerance: rounding of the sum.
TEST(WallContacts, give_to_the_tools_the_opposite_of_what_they_give_to_the_particles) {
  dem::Engine<3> engine(milled_body(6));
  engine.start(5e-8);
  std::vector<std::uint32_t> all(engine.size());
  for (std::uint32_t i = 0; i < all.size(); ++i)
    all[i] = i;
  std::vector<double> force(3 * all.size());
  double largest = 0.0;
  for (int n = 0; n < 1000; ++n) {
    engine.compute_own_forces();
    engine.own_forces(all, force);
    Vec<3> sum = Vec<3>::Zero();
    double size = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      sum += Eigen::Map<const Vec<3>>(&force[3 * i]);
      size += Eigen::Map<const Vec<3>>(&force[3 * i]).norm();
    }
    for (const auto& tool : engine.tools())
      sum += tool.load().force;
    largest = std::max(largest, engine.tools()[1].load().force.norm());
    EXPECT_LE(sum.norm(), 1e-13 * size);
    engine.integrate();
  }
  std::printf("largest force on the mill: %.2f N\n", largest);
  EXPECT_GT(largest, 1.0);
}

TEST(WallContacts, give_the_same_bits_for_any_number_of_threads) {
  const auto end = [](int threads) {
    omp_set_num_threads(threads);
    dem::Engine<3> engine(milled_body(14)); // 2744 particles, three blocks
    engine.start(5e-8);
    for (int n = 0; n < 300; ++n)
      cases::step(engine);
    EXPECT_GT(engine.wall_contacts()[1].size(), 10u);
    return std::tuple(engine.particles().displacement, engine.tools()[1].load().force,
                      engine.tools()[1].load().moment, engine.energies().elastic,
                      engine.energies().friction_dissipation);
  };
  const int before = omp_get_max_threads();
  const auto one = end(1);
  EXPECT_EQ(one, end(2));
  EXPECT_EQ(one, end(3));
  omp_set_num_threads(before);
}

// The list of particles near a tool is made again in time, whatever moves: contacts are those of a
// search in every step.
TEST(WallContacts, are_those_that_a_new_search_finds) {
  dem::Engine<3> engine(milled_body(5));
  engine.start(2e-7);
  for (int n = 0; n < 600; ++n) {
    engine.compute_own_forces();
    if (n % 20 == 0)
      for (std::size_t k = 0; k < 2; ++k) {
        const dem::WallContacts<3> again(rough, engine.tools()[k], engine.particles(), 1e-4, {});
        const auto found = places(again), listed = places(engine.wall_contacts()[k]);
        ASSERT_EQ(found.size(), listed.size());
        for (std::size_t c = 0; c < found.size(); ++c) {
          EXPECT_EQ(found[c].feature, listed[c].feature);
          EXPECT_EQ(found[c].gap, listed[c].gap);
        }
      }
    engine.integrate();
  }
}

TEST(WallContacts, touch_the_image_that_is_nearest_to_the_tool) {
  auto settings = one_particle<2>({7.05, 0.0});
  settings.period.length = {1.0, 0.0};
  settings.tools = {
      {"block",
       ToolShape<2>(cases::polygon({{0.0, -1.0}, {0.0491, -1.0}, {0.0491, 1.0}, {0.0, 1.0}})),
       {},
       rough}};
  dem::Engine<2> engine(settings);
  engine.start(1e-8);
  engine.compute_own_forces();
  EXPECT_NEAR(engine.tools()[0].load().force[0], -1e7 * 0.1e-3, 1e-6);
}

// A disc goes around in a period that a floor of one segment, or a plane, spans. The floor carries
// it on both sides of the seam; the friction on a plane does not even notice it.
TEST(WallContacts, go_on_across_the_seam_of_a_period) {
  auto settings = one_particle<2>({0.4999, 0.9e-3});
  settings.period.length = {1.0, 0.0};
  settings.initial.resize(1);
  settings.initial[0].velocity = {1.0, 0.0};
  settings.boundary = {
      cases::prescribe_at<2>(settings.positions[0], dem::Motion::velocity, {1.0, 0.0})};
  settings.boundary[0].components = 2u; // stays at its height
  settings.boundary[0].velocity.setZero();
  const Surface<2> floor{{{-0.5, 0.0}, {0.5, 0.0}}, {{1, 0}}};
  for (const bool is_plane : {true, false}) {
    settings.tools = {plane<2>({0.0, 0.0}, {0.0, 1.0})};
    if (!is_plane)
      settings.tools[0].shape = ToolShape<2>(floor);
    settings.tools[0].material.friction = 1e3; // rolls
    dem::Engine<2> engine(settings);
    engine.start(1e-7);
    double largest = 0.0;
    for (int n = 0; n < 4000; ++n) {
      cases::step(engine);
      EXPECT_EQ(engine.wall_contacts()[0].size(), 1u);
      EXPECT_NEAR(engine.tools()[0].load().force[1], -1e7 * 0.1e-3, 1e-6);
      if (n > 10)
        largest = std::max(largest, std::abs(engine.tools()[0].load().force[0]));
    }
    EXPECT_GT(engine.particles().displacement[0][0], 1e-4);
    // The spring swings with sqrt(k_t / (3 m)) v of the start; a jump of an arm would be 1e3 times
    // it.
    EXPECT_LT(largest, 1.1 * std::sqrt(5e6 * engine.particles().mass[0] / 3.0));
  }
}

// A particle is pushed along a floor; its spring grows until it slides, the seam being in between.
// Reference: the same on another place of the floor, without a seam.
template <int dim>
void expect_the_same_friction_across_a_seam(const ToolShape<dim>& floor, const Vec<dim>& place,
                                            const Vec<dim>& at_the_seam) {
  const auto history = [&](Vec<dim> x) {
    x[dim - 1] = 0.9e-3;
    auto settings = one_particle<dim>(x);
    for (int a = 0; a < dim - 1; ++a)
      settings.period.length[a] = 1.0;
    Vec<dim> velocity = Vec<dim>::Ones();
    velocity[dim - 1] = 0.0;
    settings.boundary = {cases::prescribe_at<dim>(x, dem::Motion::velocity, velocity)};
    settings.boundary[0].components = (1u << (dim + 1)) - 1u;
    settings.tools = {{"floor", floor, {}, rough}};
    dem::Engine<dim> engine(settings);
    engine.start(1e-6);
    std::vector<double> force;
    for (int n = 0; n < 160; ++n) {
      cases::step(engine);
      for (const double component : engine.tools()[0].load().force)
        force.push_back(component);
    }
    return force;
  };
  const std::vector<double> seam = history(at_the_seam), reference = history(place);
  EXPECT_GT(reference[dim * 20], 10.0);                          // grows,
  EXPECT_NEAR(reference[dim * 159], reference[dim * 158], 1e-6); // slides
  for (std::size_t k = 0; k < reference.size(); ++k)
    EXPECT_NEAR(seam[k], reference[k], 1e-6) << k; // 1e-9 of the normal force: digits of x
}
TEST(WallContacts, keep_their_friction_across_the_seam_of_a_period_2d) {
  Surface<2> floor;
  for (std::uint32_t k = 0; k <= 7; ++k) {
    floor.vertices.emplace_back(k / 7.0 - 0.5, 0.0);
    if (k > 0)
      floor.facets.push_back({k, k - 1});
  }
  for (const auto& shape : {ToolShape<2>(floor), ToolShape<2>(Plane<2>{{0.0, 0.0}, {0.0, 1.0}})})
    expect_the_same_friction_across_a_seam<2>(shape, {0.03, 0.0}, {0.49996, 0.0});
}
TEST(WallContacts, keep_their_friction_across_the_seams_of_a_period_3d) {
  const auto sheet =
      cases::sheet(5, [](double u, double v) { return Vec<3>(u - 0.5, v - 0.5, 0.0); });
  for (const auto& shape :
       {ToolShape<3>(sheet), ToolShape<3>(Plane<3>{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}})})
    expect_the_same_friction_across_a_seam<3>(shape, {0.03, 0.06, 0.0}, {0.49996, 0.49998, 0.0});
}

// A sphere rolls and slides over 2 x 16² triangles, and over a plane. Both give the same but for
// the rounding of the feet of the normals.
TEST(WallContacts, with_a_flat_sheet_of_triangles_are_those_with_a_plane) {
  auto settings = one_particle<3>({-4e-3, -3e-3, 1e-3 - 1e-8});
  settings.gravity = {0.0, 0.0, -1e4};
  settings.initial.resize(1);
  settings.initial[0].velocity = {3.0, 2.0, 0.0};
  const auto end = [&](const ToolShape<3>& shape) {
    settings.tools = {{"floor", shape, {}, rough}};
    dem::Engine<3> engine(settings);
    engine.start(2e-7);
    std::size_t gaps = 0;
    for (int n = 0; n < 10'000; ++n) {
      cases::step(engine);
      gaps += engine.wall_contacts()[0].size() == 1 ? 0 : 1;
    }
    EXPECT_EQ(gaps, 0u);
    return std::pair(engine.particles().displacement[0], engine.particles().angular_velocity[0]);
  };
  const auto sheet = cases::sheet(
      16, [](double u, double v) { return Vec<3>(16e-3 * (u - 0.5), 16e-3 * (v - 0.5), 0.0); });
  const auto on_plane = end(ToolShape<3>(Plane<3>{Vec<3>::Zero(), Vec<3>::UnitZ()}));
  const auto on_sheet = end(ToolShape<3>(sheet));
  const double error = (on_sheet.first - on_plane.first).norm();
  std::printf("way %.3e m, off by %.1e m on the sheet\n", on_plane.first.norm(), error);
  EXPECT_GT(on_plane.first.norm(), 4e-3);
  EXPECT_LT(error, 1e-12);
  EXPECT_LT((on_sheet.second - on_plane.second).norm(), 1e-9 * on_plane.second.norm());
}

TEST(WallContacts, refuse_constants_that_cannot_be) {
  auto settings = one_particle<2>({0.0, 0.0});
  const auto sentence = [&](const WallMaterial& material) -> std::string {
    settings.tools = {plane<2>({0.0, 0.0}, {0.0, 1.0}, material)};
    try {
      dem::Engine<2> engine(settings);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(sentence({0.0, 1.0, 0.0, false}),
            "tool plane: normal_stiffness must be positive, not 0");
  EXPECT_EQ(sentence({1.0, -1.0, 0.0, false}),
            "tool plane: tangential_stiffness must not be negative, not -1");
  EXPECT_EQ(sentence({1.0, 1.0, -0.5, false}),
            "tool plane: friction must not be negative, not -0.5");
}

// The surface of a turned and moved tool, read back from a frame.
TEST(ToolOutput, shows_the_surface_where_the_tool_is) {
  const auto folder = std::filesystem::temp_directory_path() / "kerf_tool_output";
  dem::Engine<3> engine(milled_body(3));
  engine.start(1e-6);
  dem::ToolOutput<3> output(engine, folder, "rock");
  for (int n = 0; n < 20; ++n)
    cases::step(engine);
  engine.compute_own_forces();
  std::vector<Grid> grids;
  output.add_grids(grids);
  ASSERT_EQ(grids.size(), 1u); // a plane has no end
  FrameWriter(folder, "rock", 3).write(0, 0.0, grids);
  const Frame frame = read_frame(folder / "frames" / "rock_000000000.h5");
  const auto& position = frame.arrays.at("tool_mill/position").reals();
  const auto& tool = engine.tools()[1];
  ASSERT_EQ(position.size(), 24u);
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_LT((Vec<3>(&position[3 * k]) - tool.pose().to_space(tool.shape().surface()->vertices[k]))
                  .norm(),
              1e-17); // m, rounding
  EXPECT_EQ(frame.arrays.at("tool_mill/cells").columns, 3u);
  EXPECT_NEAR(tool.angle(), 1e3 * 20e-6, 1e-15);
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace kerf
