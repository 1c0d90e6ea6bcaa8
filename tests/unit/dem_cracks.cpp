// Breaks as events, and the pieces that they leave.
#include "tests/cases/dem_models.hpp"

#include "dem_core/fragments.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;

/// Two discs, 3 : 1 in radius; the second is moved along or across the bond.
dem::Engine<2> moved_pair(const Vec<2>& velocity, double R_n, double R_t) {
  auto settings = cases::pair_model<2>({1.0, 0.0}, rock(2));
  settings.radii = {0.75 * spacing, 0.25 * spacing};
  settings.material.tensile_strength = R_n;
  settings.material.shear_strength = R_t;
  settings.boundary = {
      cases::prescribe_at<2>(settings.positions[0], dem::Motion::fixed),
      cases::prescribe_at<2>(settings.positions[1], dem::Motion::velocity, velocity)};
  for (auto& prescription : settings.boundary)
    prescription.components |= 4; // rotation
  dem::Engine<2> engine(settings);
  engine.start(1e-8);
  return engine;
}

// u_n = v t: R_n / k_n = 5e-7 m is passed between steps 50 and 51 of 1e-8 m each, so F_n = 5.1e3 N
// is what the bond would have had. Released: the mean of that and nothing times the growth, from
// F_n = 5e3 N in the step before: (5e3 + 0) / 2 * (5.1e3 - 0) / k_n.
TEST(Crack, in_tension_tells_when_where_and_what_it_released) {
  const double k_n = 1e10, R_n = 5.0001e3;
  auto engine = moved_pair({1.0, 0.0}, R_n, 1e30);
  for (int n = 0; n < 60; ++n)
    cases::step(engine);
  ASSERT_EQ(engine.cracks().size(), 1u);
  const dem::Crack<2>& crack = engine.cracks()[0];
  EXPECT_EQ(crack.step, 51u);
  EXPECT_DOUBLE_EQ(crack.time, 51e-8);
  EXPECT_EQ(crack.first, 0u);
  EXPECT_EQ(crack.second, 1u);
  EXPECT_EQ(crack.mode, dem::BreakMode::tension);
  EXPECT_EQ(crack.strength, R_n);
  EXPECT_NEAR(crack.energy, 0.5 * 5e3 * 5.1e3 / k_n, 1e-6 * crack.energy);
  EXPECT_LT((crack.place - Vec<2>(0.75 * (spacing + 51e-8), 0.0)).norm(), 1e-15);
  EXPECT_LT((crack.normal - Vec<2>(1.0, 0.0)).norm(), 1e-12);
}

TEST(Crack, in_shear_has_the_mode_and_the_strength_of_shear) {
  auto engine = moved_pair({0.0, 1.0}, 1e30, 1e3);
  for (int n = 0; n < 60; ++n)
    cases::step(engine);
  ASSERT_EQ(engine.cracks().size(), 1u);
  EXPECT_EQ(engine.cracks()[0].mode, dem::BreakMode::shear);
  EXPECT_EQ(engine.cracks()[0].strength, 1e3);
  EXPECT_EQ(engine.cracks()[0].step, 51u); // R_t / k_t = 5e-7 m
}

TEST(Cracks, are_as_many_as_bonds_broke_and_released_what_fracture_dissipated) {
  auto settings = cases::irregular_model<3>(6, rock(3, 0.5), 12);
  settings.material.friction = 0.5;
  settings.material.tensile_strength = settings.material.normal_stiffness * 1e-3 * spacing;
  settings.material.shear_strength = settings.material.tensile_strength;
  const double omega = std::sqrt(dem::Engine<3>(settings).step_limit().omega2);
  cases::shake(settings, 5e-4 * spacing * omega, 5);
  dem::Engine<3> engine(settings);
  engine.start(0.2 / omega);
  for (int n = 0; n < 500; ++n)
    cases::step(engine);
  const auto cracks = engine.cracks();
  EXPECT_GT(cracks.size(), 10u);
  EXPECT_EQ(cracks.size(), engine.bonds_at_start() - engine.bonds());
  double energy = 0.0;
  for (const dem::Crack<3>& crack : cracks)
    energy += crack.energy;
  EXPECT_NEAR(energy, engine.energies().fracture_dissipation, 1e-12 * energy);
  EXPECT_TRUE(std::is_sorted(cracks.begin(), cracks.end(),
                             [](const auto& a, const auto& b) { return a.time < b.time; }));
}

/// A chain of seven of which some bonds k to k + 1 are cut.
dem::Fragments chain_without(std::vector<std::uint32_t> cut, std::vector<std::uint32_t> ids = {}) {
  auto settings = cases::lattice_model<2>(dem::LatticeType::chain, {7, 1}, rock(2));
  settings.ids = std::move(ids);
  const dem::Engine<2> engine(settings);
  auto contacts = engine.contacts();
  for (const std::uint32_t k : cut)
    contacts.bonded[k] = 0;
  return dem::find_fragments(contacts, engine.particles());
}
using Numbers = std::vector<std::uint32_t>;

TEST(Fragments, of_a_whole_body_are_one) {
  const dem::Fragments whole = chain_without({});
  EXPECT_EQ(whole.count(), 1u);
  EXPECT_EQ(whole.largest_share(), 1.0);
  EXPECT_EQ(whole.of, Numbers(7, 0));
}

TEST(Fragments, are_numbered_by_size_and_then_by_their_smallest_id) {
  const dem::Fragments pieces = chain_without({1, 2, 3}); // 2 + 1 + 1 + 3
  EXPECT_EQ(pieces.of, (Numbers{1, 1, 2, 3, 0, 0, 0}));
  EXPECT_EQ(pieces.count(), 4u);
  EXPECT_NEAR(pieces.largest_share(), 3.0 / 7.0, 1e-15);
  EXPECT_EQ(chain_without({1, 2, 3}, {6, 5, 4, 3, 2, 1, 0}).of, (Numbers{1, 1, 3, 2, 0, 0, 0}));
}

TEST(Fragments, of_dust_are_its_particles) {
  EXPECT_EQ(chain_without({0, 1, 2, 3, 4, 5}).of, (Numbers{0, 1, 2, 3, 4, 5, 6}));
}

} // namespace
} // namespace kerf
