// The energy book of free, driven, damped, sliding and breaking bodies.
#include "tests/cases/dem_models.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using dem::LatticeType;

struct Drift {
  double mean = 0.0; // of the last tenth less that of the first tenth, over the start
  double peak = 0.0; // farthest from the start
};

/// What the books leave unexplained.
double balance(const dem::Energies& e) {
  return e.kinetic + e.elastic - e.external_work - e.interface_work + e.damping_dissipation +
         e.friction_dissipation + e.fracture_dissipation;
}

/// A free body that is shaken to strains of about `strain`, for `periods` of its highest frequency.
template <int dim>
Drift drift(dem::Settings<dim> settings, double strain, double share_of_limit, double periods) {
  const double omega = std::sqrt(dem::Engine<dim>(settings).step_limit().omega2);
  cases::shake(settings, strain * spacing * omega, 7);
  dem::Engine<dim> engine(settings);
  const double dt = share_of_limit * 2.0 / omega;
  const int steps = static_cast<int>(periods * 2.0 * std::numbers::pi / (omega * dt));
  engine.start(dt);
  double start = 0.0, first = 0.0, last = 0.0;
  Drift drift;
  for (int n = 0; n < steps; ++n) {
    cases::step(engine);
    const double energy = balance(engine.energies());
    start = n == 0 ? energy : start;
    drift.peak = std::max(drift.peak, std::abs(energy / start - 1.0));
    (n < steps / 10 ? first : last) += n < steps / 10 || n >= steps - steps / 10 ? energy : 0.0;
  }
  drift.mean = (last - first) / (steps / 10) / start;
  std::printf("strain %.0e, step %.2f of the limit: drift %.1e, peak %.1e\n", strain,
              share_of_limit, drift.mean, drift.peak);
  return drift;
}

// Reference: for straight motion the bond is linear, and then kinetic + elastic energy with
// v^(n-1/2) . M v^(n+1/2) is an invariant of central differences. Tolerance: rounding of 2000
// steps, 1e-12.
TEST(Energy, of_a_chain_is_kept_to_rounding) {
  auto settings = cases::lattice_model<2>(LatticeType::chain, {64, 1}, rock(2));
  dem::InitialCondition<2> condition;
  condition.pulse = dem::Pulse{.amplitude = 1e-3 * spacing,
                               .center = 32.0 * spacing,
                               .length = 20.0 * spacing,
                               .wave_speed = 2000.0,
                               .spacing = spacing};
  settings.initial = {condition};
  dem::Engine<2> engine(settings);
  engine.start(0.8 * 2.0 / std::sqrt(engine.step_limit().omega2));
  cases::step(engine);
  const double start = balance(engine.energies());
  double peak = 0.0;
  for (int n = 0; n < 20000; ++n) {
    cases::step(engine);
    peak = std::max(peak, std::abs(balance(engine.energies()) / start - 1.0));
  }
  std::printf("chain, 20000 steps: peak %.1e\n", peak);
  verify({"energy of a chain over 20000 steps", "invariant of central differences", 1e-12,
          "rounding of 20000 steps"},
         peak);
}

/// Verifies that the energy of a free body does not drift.
template <int dim>
void drifts_little(const std::string& body, const dem::Settings<dim>& settings,
                   double share_of_limit, double periods) {
  verify({"drift of the energy of " + body, "the law is reversible", 1e-6, "strain of 1e-6"},
         drift<dim>(settings, 1e-6, share_of_limit, periods).mean);
}

// A lattice is nonlinear in its rotations; the law is reversible, so what is left oscillates. For
// strains of 1e-6 its part in the energy is of that order.
TEST(Energy, of_a_free_triangular_lattice_drifts_by_less_than_a_millionth) {
  drifts_little<2>("a free triangular lattice",
                   cases::lattice_model<2>(LatticeType::triangular, {8, 8}, rock(2, 0.82)), 0.8,
                   3000);
}
TEST(Energy, of_a_free_face_centred_lattice_drifts_by_less_than_a_millionth) {
  drifts_little<3>("a free face-centred lattice",
                   cases::lattice_model<3>(LatticeType::fcc, {2, 2, 2}, rock(3, 0.82)), 0.4, 1000);
}

TEST(Energy, of_a_free_body_whose_bonds_bend_and_twist_drifts_by_less_than_a_millionth) {
  auto disc = rock(2, 0.5), sphere = rock(3, 0.5);
  disc.bond_radius_ratio = sphere.bond_radius_ratio = 1.0;
  drifts_little<2>("irregular discs with moments", cases::irregular_model<2>(8, disc, 1), 0.5,
                   1000);
  drifts_little<3>("irregular spheres with moments", cases::irregular_model<3>(4, sphere, 1), 0.4,
                   500);
}

// The same bounds over a million steps: what drifted by 1e-12 a step would show.
TEST(Energy, of_a_bonded_lattice_drifts_by_less_than_a_millionth_in_a_million_steps) {
  const auto model = cases::lattice_model<2>(LatticeType::triangular, {5, 5}, rock(2, 0.82));
  const double share = 0.8, steps = 1e6;
  drifts_little<2>("a triangular lattice over 1e6 steps", model, share,
                   steps * 2.0 * share / (2.0 * std::numbers::pi));
}

// Reference: a symmetric rule of second order: half the step leaves a quarter of the peak. At
// strains of 1e-3 the peaks stand far above rounding. Tolerance: the motion is chaotic in detail,
// so the peaks of two runs differ by some tens of percent besides.
template <int dim>
void peaks_as_dt_squared(const std::string& lattice, const dem::Settings<dim>& model) {
  const double coarse = drift<dim>(model, 1e-3, 0.2, 60).peak;
  const double fine = drift<dim>(model, 1e-3, 0.05, 60).peak;
  verify({"order in dt of the peaks of the energy, " + lattice + " lattice", "two: symmetric rule",
          0.35, "chaotic motion: peaks differ by some tens of percent"},
         std::log(coarse / fine) / std::log(4.0) - 2.0);
}
TEST(Energy, of_a_free_triangular_lattice_peaks_as_the_square_of_the_step) {
  peaks_as_dt_squared<2>("triangular",
                         cases::lattice_model<2>(LatticeType::triangular, {8, 8}, rock(2, 0.82)));
}
TEST(Energy, of_a_free_face_centred_lattice_peaks_as_the_square_of_the_step) {
  peaks_as_dt_squared<3>("face-centred",
                         cases::lattice_model<3>(LatticeType::fcc, {2, 2, 2}, rock(3, 0.82)));
}

// Rojek (2008) eqs 18-19 take out what the book of damping holds; the ends are pulled and pushed.
// Tolerance: nonlinear part of strains of 1e-5, as above.
TEST(Energy, of_a_driven_and_damped_lattice_is_balanced_by_its_books) {
  for (const auto kind : {dem::DampingKind::nonviscous, dem::DampingKind::componentwise}) {
    auto settings = cases::lattice_model<2>(LatticeType::triangular, {12, 6}, rock(2));
    settings.damping = {.kind = kind, .translation = 0.3, .rotation = 0.2};
    auto left = cases::prescribe_at<2>({0.0, 0.0}, dem::Motion::hann);
    left.box.lower[1] = -spacing;
    left.box.upper[1] = 10.0 * spacing;
    left.amplitude = {1e-5 * spacing, 0.5e-5 * spacing};
    left.duration = 3e-6;
    settings.boundary = {left};
    dem::Engine<2> engine(settings);
    engine.start(0.5 * 2.0 / std::sqrt(engine.step_limit().omega2));
    cases::step(engine);
    const double start = balance(engine.energies());
    double largest = 0.0, worst = 0.0;
    for (int n = 0; n < 400; ++n) {
      cases::step(engine);
      largest = std::max(largest, engine.energies().external_work);
      worst = std::max(worst, std::abs(balance(engine.energies()) - start));
    }
    EXPECT_GT(engine.energies().damping_dissipation, 0.1 * largest);
    verify({"energy that the books of a driven and damped lattice miss", "Rojek (2008) eqs 18-19",
            1e-6, "strain of 1e-5, nonlinear"},
           worst / largest);
  }
}

// A bond along x is pulled until it breaks; then its particles fly free. The normal force is linear
// in the displacement, so the book of fracture closes to rounding.
TEST(Energy, of_a_bond_that_breaks_in_tension_is_found_in_the_book_of_fracture) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2));
  settings.material.tensile_strength = 5e3;
  settings.boundary = {
      cases::prescribe_at<2>(settings.positions[0], dem::Motion::fixed),
      cases::prescribe_at<2>(settings.positions[1], dem::Motion::velocity, {0.1, 0.0})};
  dem::Engine<2> engine(settings);
  engine.start(1e-7);
  for (int n = 0; n < 100; ++n) {
    cases::step(engine);
    const auto e = engine.energies();
    verify({"energy that the books of a bond that breaks miss, J", "work of its pull", 5e-15,
            "rounding: 1e-12 of strength times displacement"},
           balance(e) - e.kinetic);
  }
  EXPECT_EQ(engine.bonds(), 0u);
  // R_n² / 2 k_n, and at most the work of the one step in which it broke, R_n v dt.
  const double stored = 0.5 * 5e3 * 5e3 / 1e10;
  verify({"energy released by a bond that breaks", "R_n² / 2 k_n", 0.04,
          "work of the step in which it breaks"},
         engine.energies().fracture_dissipation / stored - 1.0);
}

} // namespace
} // namespace kerf
