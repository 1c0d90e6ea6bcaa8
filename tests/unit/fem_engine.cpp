// The engine as a participant sees it: boundaries, books, weights, threads.
#include "tests/cases/fem_bodies.hpp"

#include "fem_core/input_error.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <numbers>
#include <numeric>

namespace kerf::fem {
namespace {

using cases::rock;

const BoxMesh<2> bar{.size = {20e-3, 3e-3}, .count = {20, 3}};

double safe_step(const auto& engine) {
  return 0.8 * 2.0 / std::sqrt(engine.step_limit().omega2);
}

/// A bar whose left end is pushed by a Hann pulse; the right end is held.
Settings<2> pushed() {
  return {.materials = cases::of<2>(rock),
          .boundary = {{.tag = "left",
                        .box = {},
                        .components = {true, true},
                        .motion = Motion::hann,
                        .amplitude = {1e-6, 5e-7},
                        .duration = 4e-6},
                       {.tag = "right", .box = {}, .components = {true, true}}},
          .initial = {}};
}

// A prescribed node is where the formula says, whatever the number of steps: no sum of velocities.
TEST(FemBoundary, follows_a_hann_motion_exactly_and_its_velocity_is_the_difference) {
  Engine<2> engine(make_box(bar), pushed());
  const double dt = safe_step(engine);
  engine.start(dt);
  const std::vector<std::uint32_t> nodes = {0, 21, 42, 63};
  std::vector<double> x(8), v(8), next(8), ignored(8);
  const auto hann = [](double t) {
    return t < 4e-6 ? 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * t / 4e-6)) : 0.0;
  };
  for (int n = 0; n < 60; ++n) {
    engine.motion(nodes, x, v);
    cases::step(engine);
    engine.motion(nodes, next, ignored);
    for (std::size_t a = 0; a < 4; ++a) {
      EXPECT_NEAR(x[2 * a], 1e-6 * hann(n * dt), 1e-17); // rounding of X + u, X = 0
      EXPECT_NEAR(x[2 * a + 1], engine.mesh().positions[2 * nodes[a] + 1] + 5e-7 * hann(n * dt),
                  1e-18 + 1e-15 * 3e-3);
      // motion() gives what moves it: x^(n+1) = x^n + v^(n+1/2) dt
      EXPECT_NEAR(next[2 * a], x[2 * a] + v[2 * a] * dt, 1e-17);
    }
  }
  EXPECT_EQ(engine.displacement()[0], 0.0);
  EXPECT_GT(60 * dt, 4e-6);
}

TEST(FemBoundary, moves_with_a_constant_velocity_and_reports_no_inverse_mass) {
  Settings<2> settings = pushed();
  settings.boundary[0].motion = Motion::velocity;
  settings.boundary[0].components = {true, false};
  settings.boundary[0].velocity = {0.5, 0.0};
  Engine<2> engine(make_box(bar), settings);
  const double dt = safe_step(engine);
  engine.start(dt);
  for (int n = 0; n < 100; ++n)
    cases::step(engine);
  EXPECT_DOUBLE_EQ(engine.displacement()[0], 0.5 * 100 * dt);
  const std::vector<std::uint32_t> nodes = {0, 1, 20};
  std::vector<double> inverse(6);
  engine.inverse_mass(nodes, inverse);
  EXPECT_EQ(inverse[0], 0.0);
  EXPECT_DOUBLE_EQ(inverse[1], 4.0 / (2500.0 * 1e-6)); // a quarter of one element
  EXPECT_DOUBLE_EQ(inverse[2], 2.0 / (2500.0 * 1e-6));
  EXPECT_EQ(inverse[4], 0.0);
  EXPECT_EQ(inverse[5], 0.0);
}

TEST(FemBoundary, selects_by_box_and_lets_the_later_setting_count) {
  Settings<2> settings{.materials = cases::of<2>(rock), .boundary = {}, .initial = {}};
  settings.boundary.push_back({.tag = "",
                               .box = Box<2>{.lower = {0.0, 0.0}, .upper = {0.0, 3e-3}},
                               .components = {true, true}});
  settings.boundary.push_back({.tag = "left",
                               .box = {},
                               .components = {false, true},
                               .motion = Motion::velocity,
                               .velocity = {9.0, 1.0}});
  Engine<2> engine(make_box(bar), settings);
  engine.start(1e-8);
  std::vector<double> x(2), v(2);
  engine.motion(std::vector<std::uint32_t>{21}, x, v);
  EXPECT_EQ(v[0], 0.0);
  EXPECT_EQ(v[1], 1.0);
}

TEST(FemBoundary, refuses_settings_that_cannot_be_meant_and_names_the_key) {
  const auto key = [](const BoundarySetting<2>& setting) -> std::string {
    try {
      Engine<2>(make_box(bar),
                {.materials = cases::of<2>(rock), .boundary = {setting}, .initial = {}});
    } catch (const InputError& error) {
      return error.key();
    }
    return "nothing was thrown";
  };
  const Box<2> elsewhere{.lower = {1.0, 1.0}, .upper = {2.0, 2.0}};
  EXPECT_EQ(key({.tag = "lft", .box = {}, .components = {true, true}}), "boundary[0].tag");
  EXPECT_EQ(key({.tag = "", .box = {}, .components = {true, true}}), "boundary[0].tag");
  EXPECT_EQ(key({.tag = "left", .box = elsewhere, .components = {true, true}}), "boundary[0].tag");
  EXPECT_EQ(key({.tag = "", .box = elsewhere, .components = {true, true}}), "boundary[0].box");
  EXPECT_EQ(key({.tag = "left", .box = {}, .components = {}}), "boundary[0].components");
  EXPECT_EQ(key({.tag = "left", .box = {}, .components = {true, true}, .motion = Motion::hann}),
            "boundary[0].duration");
}

// Linear, so kinetic + elastic - work is constant in exact arithmetic of the scheme; the rounding
// of some hundred steps stays far below 1e-12 of the largest energy.
TEST(FemBooks, have_external_work_equal_to_the_energy_that_the_body_gains) {
  Engine<2> engine(make_box(bar), pushed());
  engine.start(safe_step(engine));
  double most = 0.0, error = 0.0;
  for (int n = 0; n < 1000; ++n) {
    cases::step(engine);
    const Energies e = engine.energies();
    most = std::max(most, e.kinetic + e.elastic);
    error = std::max(error, std::abs(e.kinetic + e.elastic - e.external_work));
    EXPECT_EQ(e.interface_work, 0.0);
  }
  EXPECT_GT(most, 1e-6); // J/m; it did move
  EXPECT_LE(error, 1e-12 * most);
  RecordProperty("relative_error", std::to_string(error / most));
}

TEST(FemBooks, have_interface_work_equal_to_the_energy_that_the_body_gains) {
  Engine<2> engine(make_box(bar), pushed());
  engine.start(safe_step(engine));
  const std::vector<std::uint32_t> nodes = {0, 5, 26, 50}; // node 0 is prescribed: a reaction
  double most = 0.0, error = 0.0;
  for (int n = 0; n < 1000; ++n) {
    engine.compute_own_forces();
    if (n < 500) {
      const double f = 1e3 * std::sin(0.1 * n); // N/m
      engine.add_interface_forces(nodes, std::vector<double>{f, f, -f, f, f, f, 0.0, f});
    }
    engine.integrate();
    const Energies e = engine.energies();
    most = std::max(most, e.kinetic + e.elastic);
    error = std::max(error, std::abs(e.kinetic + e.elastic - e.external_work - e.interface_work));
  }
  EXPECT_GT(std::abs(engine.energies().interface_work), 1e-3 * most);
  EXPECT_LE(error, 1e-12 * most);
}

// Newton's second law for the whole body: momentum is the impulse of the forces, with the
// trapezoidal half of the step at t_n. Tolerance: rounding of 200 steps.
TEST(FemBooks, have_momentum_equal_to_the_impulse_of_the_forces) {
  Engine<2> engine(make_box(bar), {.materials = cases::of<2>(rock), .boundary = {}, .initial = {}});
  const double dt = safe_step(engine);
  engine.start(dt);
  const std::vector<std::uint32_t> nodes = {3, 30};
  for (int n = 0; n < 200; ++n) {
    engine.compute_own_forces();
    engine.add_interface_forces(nodes, std::vector<double>{10.0, 0.0, 0.0, -4.0}); // N/m
    engine.integrate();
    const double impulse = n * dt; // s, of a unit force that began at t = 0
    EXPECT_NEAR(engine.momentum()[0], 10.0 * impulse, 1e-12 * 10.0 * 200 * dt);
    EXPECT_NEAR(engine.momentum()[1], -4.0 * impulse, 1e-12 * 10.0 * 200 * dt);
  }
}

// (own + interface) / m is the acceleration: v^(1/2) = v^0 + a dt/2, then v^(n+1/2) = v^(n-1/2) + a
// dt.
TEST(FemEngine, integrates_own_and_interface_forces_times_the_inverse_mass) {
  Engine<2> engine(make_box(bar), pushed());
  const double dt = safe_step(engine);
  engine.start(dt);
  std::vector<std::uint32_t> nodes(engine.mesh().num_nodes());
  std::iota(nodes.begin(), nodes.end(), 0u);
  const std::size_t size = nodes.size() * 2;
  std::vector<double> x(size), v(size), own(size), inverse(size), next(size), f(size),
      ignored(size);
  engine.inverse_mass(nodes, inverse);
  for (int n = 0; n < 50; ++n) {
    engine.motion(nodes, x, v);
    engine.compute_own_forces();
    engine.own_forces(nodes, own);
    for (std::size_t k = 0; k < size; ++k)
      f[k] = 100.0 * std::sin(static_cast<double>(k) + n);
    engine.add_interface_forces(nodes, f);
    engine.integrate();
    engine.motion(nodes, ignored, next);
    for (std::size_t k = 0; k < size; ++k)
      if (inverse[k] > 0.0) {
        const double gain = (own[k] + f[k]) * inverse[k] * dt * (n == 0 ? 0.5 : 1.0);
        EXPECT_NEAR(next[k], v[k] + gain, 1e-15 * (1.0 + std::abs(next[k])));
      }
  }
}

// What is left of a body whose left half has alpha = 0 is the right half: same elements in the same
// order, so the same numbers up to the rounding of their coordinates.
TEST(FemWeights, leave_the_part_with_alpha_and_keep_the_rest_in_its_place) {
  const Mesh<2> whole = make_box(bar);
  const Mesh<2> half =
      make_box(BoxMesh<2>{.origin = {10e-3, 0.0}, .size = {10e-3, 3e-3}, .count = {10, 3}});
  const Settings<2> settings{
      .materials = cases::of<2>(rock),
      .boundary = {{.tag = "right", .box = {}, .components = {true, false}}},
      .initial = {
          {.box = {},
           .velocity = InitialVelocity<2>{{0.1, 0.2}},
           .pulse = InitialPulse{
               .amplitude = 1e-6, .center = 14e-3, .length = 16e-3, .wave_speed = 2000.0}}}};
  Engine<2> of_whole(whole, settings), of_half(half, settings);
  of_whole.set_weights(cases::ramp(whole, 10e-3, 4e-3));
  of_half.set_weights(cases::ramp(half, 10e-3, 4e-3));
  EXPECT_NEAR(of_whole.step_limit().omega2, of_half.step_limit().omega2,
              1e-10 * of_half.step_limit().omega2);
  const double dt = safe_step(of_half);
  of_whole.start(dt);
  of_half.start(dt);
  for (int n = 0; n < 200; ++n) {
    cases::step(of_whole);
    cases::step(of_half);
  }
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 21; ++i)
      for (std::size_t c = 0; c < 2; ++c) {
        const double u = of_whole.displacement()[(j * 21 + i) * 2 + c];
        if (i < 10)
          EXPECT_EQ(u, 0.0);
        else
          EXPECT_NEAR(u, of_half.displacement()[(j * 11 + i - 10) * 2 + c], 1e-17);
      }
  EXPECT_NEAR(of_whole.energies().kinetic, of_half.energies().kinetic,
              1e-11 * of_half.energies().kinetic);

  std::vector<double> inverse(4), omega2(2);
  const std::vector<std::uint32_t> nodes = {0, 12};
  of_whole.inverse_mass(nodes, inverse);
  of_whole.omega2(nodes, omega2);
  EXPECT_EQ(inverse[0], 0.0);
  EXPECT_GT(inverse[2], 0.0);
  EXPECT_EQ(omega2[0], 0.0);
  EXPECT_GT(omega2[1], 0.0);
}

// By superposition the field in a periodic body is the sum over all images of the field in an
// endless one. The long mesh is endless here: a force reaches one more element each step, 16 at
// most.
TEST(FemEngine, carries_a_wave_across_the_end_of_a_period_as_through_a_longer_mesh) {
  const InitialPulse pulse{
      .amplitude = 1e-6, .center = 15e-3, .length = 8e-3, .wave_speed = 2190.0, .spacing = 1e-3};
  const Settings<2> settings{.materials = cases::of<2>(rock),
                             .boundary = {},
                             .initial = {{.box = {}, .velocity = {}, .pulse = pulse}}};
  const BoxMesh<2> once{.size = {20e-3, 3e-3}, .count = {20, 3}};
  const BoxMesh<2> thrice{.origin = {-20e-3, 0.0}, .size = {60e-3, 3e-3}, .count = {60, 3}};
  Engine<2> periodic(make_box(once, {.length = {20e-3, 3e-3}}), settings);
  Engine<2> lengthy(make_box(thrice, {.length = {0.0, 3e-3}}), settings);
  const double dt = 8e-3 / 2190.0 / 16; // in 16 steps by 8 elements: from 15 to 23 mm
  EXPECT_LT(dt, 2.0 / std::sqrt(periodic.step_limit().omega2));
  periodic.start(dt);
  lengthy.start(dt);
  for (int n = 0; n < 16; ++n) {
    cases::step(periodic);
    cases::step(lengthy);
  }
  EXPECT_GT(periodic.displacement()[3 * 2], 0.9e-6); // the top of the pulse, at 23 - 20 = 3 mm
  for (std::size_t i = 0; i < 20; ++i) {
    const auto u = [&](std::size_t column) { return lengthy.displacement()[column * 2]; };
    EXPECT_NEAR(periodic.displacement()[i * 2], u(i) + u(i + 20) + u(i + 40), 1e-13 * 1e-6)
        << "column " << i;
  }
}

// Element forces are summed per node in the order of the elements, energies in fixed blocks.
TEST(FemEngine, gives_the_same_bits_with_one_thread_and_with_two) {
  const auto run = [](int threads) {
    const int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    Mesh<3> mesh = make_box(BoxMesh<3>{.size = {20e-3, 10e-3, 10e-3}, .count = {20, 10, 10}});
    Settings<3> settings{.materials = cases::of<3>(rock),
                         .boundary = {{.tag = "left",
                                       .box = {},
                                       .components = {true, true, true},
                                       .motion = Motion::hann,
                                       .amplitude = {1e-6, 2e-6, 3e-6},
                                       .duration = 2e-6}},
                         .initial = {}};
    Engine<3> engine(mesh, settings);
    engine.set_weights(cases::ramp(mesh, 5e-3, 5e-3));
    engine.start(safe_step(engine));
    for (int n = 0; n < 30; ++n)
      cases::step(engine);
    omp_set_num_threads(before);
    std::vector<double> all = engine.displacement();
    const std::vector<double> v = engine.velocity();
    all.insert(all.end(), v.begin(), v.end());
    const Energies e = engine.energies();
    all.insert(all.end(), {e.kinetic, e.elastic, e.external_work, engine.momentum()[1],
                           engine.step_limit().omega2});
    return all;
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(FemEngine, can_be_started_again) {
  Engine<2> engine(make_box(bar), pushed());
  const auto run = [&] {
    engine.start(safe_step(engine));
    for (int n = 0; n < 20; ++n)
      cases::step(engine);
    return std::pair(engine.velocity(), engine.energies().external_work);
  };
  const auto first = run();
  EXPECT_EQ(first, run());
}

TEST(FemEngine, names_the_first_node_whose_motion_is_not_finite) {
  Engine<2> engine(make_box(bar), pushed());
  engine.start(safe_step(engine));
  EXPECT_FALSE(engine.first_non_finite());
  engine.compute_own_forces();
  engine.add_interface_forces(std::vector<std::uint32_t>{30}, std::vector<double>{0.0, NAN});
  engine.integrate();
  EXPECT_EQ(engine.first_non_finite(), 30u);
}

} // namespace
} // namespace kerf::fem
