// One contact: breakage, what stays after it, and friction.
#include "tests/cases/dem_models.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;

constexpr double k_n = 1e10, k_t = 2e9; // of rock(2), N/m

/// One contact along x whose second particle is moved by hand.
class Contact {
public:
  explicit Contact(const dem::Material& material, double gap = 0.0) {
    auto settings = cases::pair_model<2>({1.0, 0.0}, material);
    settings.positions[1][0] += gap;
    settings.gap_tolerance = 1e-2;
    dem::Engine<2> engine(settings);
    particles_ = engine.particles();
    contacts_ = engine.contacts();
  }
  void move(const Vec<2>& by) {
    const std::vector<dem::Aligned<Vec<2>>> translation = {Vec<2>::Zero(), by};
    const std::vector<dem::Aligned<Rot<2>>> rotation(2);
    particles_.displacement[1] += by;
    dem::compute_contact_forces(contacts_, particles_, {translation, rotation, 1.0},
                                dem::ShearIncrement::midpoint, loads_);
  }
  void set_weight(double weight) { contacts_.weight.set_all(weight); }
  bool bonded() const { return contacts_.bonded[0]; }
  double normal() const { return contacts_.normal_force[0]; }
  double shear() const { return contacts_.shear_force[0].norm(); }
  double friction_loss() const { return contacts_.losses[0].friction; }
  double force() const { return loads_.own[0].force.norm(); }

private:
  dem::Particles<2> particles_;
  dem::Contacts<2> contacts_;
  dem::Loads<2> loads_;
};

dem::Material brittle(double R_n, double R_t, double friction = 0.0) {
  auto material = rock(2);
  material.tensile_strength = R_n;
  material.shear_strength = R_t;
  material.friction = friction;
  return material;
}

constexpr double inf = std::numeric_limits<double>::infinity();

// Rojek (2008) eq. 14: holds up to R_n, lost beyond. 1e-9 of R_n on both sides; the opening is
// computed to 1e-16 of itself.
TEST(Bond, holds_up_to_its_tensile_strength_and_breaks_just_beyond) {
  const double R_n = 5e3, limit = R_n / k_n; // N, m
  Contact contact(brittle(R_n, inf));
  contact.move({limit * (1.0 - 1e-9), 0.0});
  EXPECT_TRUE(contact.bonded());
  EXPECT_NEAR(contact.normal(), R_n, 2e-9 * R_n);
  contact.move({limit * 2e-9, 0.0});
  EXPECT_FALSE(contact.bonded());
  EXPECT_EQ(contact.normal(), 0.0);
  EXPECT_EQ(contact.shear(), 0.0);
  EXPECT_EQ(contact.force(), 0.0);
}

// Eq. 15, likewise; the branch turns by 1e-3 on the way, which is why the limit is met to 1e-6
// only.
TEST(Bond, holds_up_to_its_shear_strength_and_loses_both_parts_just_beyond) {
  const double R_t = 2e3, limit = R_t / k_t;
  Contact contact(brittle(inf, R_t));
  contact.move({1e-9, 0.0}); // some tension, 10 N
  contact.move({0.0, limit * (1.0 - 1e-5)});
  EXPECT_TRUE(contact.bonded());
  EXPECT_NEAR(contact.shear(), R_t, 2e-5 * R_t);
  EXPECT_GT(contact.normal(), 9.0);
  contact.move({0.0, limit * 2e-5});
  EXPECT_FALSE(contact.bonded());
  EXPECT_EQ(contact.normal(), 0.0);
  EXPECT_EQ(contact.shear(), 0.0);
}

TEST(Bond, withstands_compression_of_any_size) {
  Contact contact(brittle(1.0, inf));
  contact.move({-0.1 * spacing, 0.0});
  EXPECT_TRUE(contact.bonded());
  EXPECT_NEAR(contact.normal(), -0.1 * spacing * k_n, 1e-9 * spacing * k_n);
}

// The strength is compared with the force without weight; the force that acts has it.
TEST(Bond, breaks_at_the_same_stretch_whatever_its_weight) {
  const double R_n = 5e3, limit = R_n / k_n;
  Contact contact(brittle(R_n, inf));
  contact.set_weight(0.05);
  contact.move({limit * 0.999, 0.0});
  EXPECT_TRUE(contact.bonded());
  EXPECT_NEAR(contact.force(), 0.05 * 0.999 * R_n, 1e-9 * R_n);
  contact.move({limit * 0.002, 0.0});
  EXPECT_FALSE(contact.bonded());
}

// Compression only, from the distance that the bond had at the start (here with a gap), not from
// the sum of the radii.
TEST(BrokenBond, carries_compression_only_and_keeps_its_stress_free_distance) {
  Contact contact(brittle(5e3, inf), 5e-3 * spacing);
  contact.move({1e-6, 0.0});
  ASSERT_FALSE(contact.bonded());
  contact.move({-0.5e-6, 0.0});
  EXPECT_EQ(contact.normal(), 0.0);
  contact.move({-0.7e-6, 0.0}); // still 4.8e-6 m from touching the other surface
  EXPECT_NEAR(contact.normal(), -0.2e-6 * k_n, 1e-12 * k_n * 1e-6);
}

// Coulomb: |F_T| = mu |F_n| while it slides, k_t u_t while it sticks.
// What is lost in a step is the mean force times the slip without its elastic part. Tolerance: the
// branch turns by up to 5e-3, which changes the slip by the square of that.
TEST(BrokenBond, slides_with_coulomb_friction) {
  const double mu = 0.4;
  Contact contact(brittle(5e3, inf, mu));
  contact.move({1e-6, 0.0});
  ASSERT_FALSE(contact.bonded());
  contact.move({-2e-6, 0.0});
  const double F_n = -contact.normal();
  EXPECT_NEAR(F_n, 1e-6 * k_n, 1e-9 * F_n);
  contact.move({0.0, 1e-7});
  EXPECT_NEAR(contact.shear(), 1e-7 * k_t, 1e-4 * contact.shear());
  EXPECT_EQ(contact.friction_loss(), 0.0);
  contact.move({0.0, 5e-6});
  EXPECT_NEAR(contact.shear(), mu * std::abs(contact.normal()), 1e-12 * F_n);
  const double before = contact.friction_loss(), shear = contact.shear();
  contact.move({0.0, 1e-7});
  const double expected =
      0.5 * (shear + contact.shear()) * (1e-7 - (contact.shear() - shear) / k_t);
  EXPECT_NEAR(contact.friction_loss() - before, expected, 1e-4 * expected);
}

TEST(BrokenBond, forgets_its_shear_when_it_opens) {
  Contact contact(brittle(5e3, inf, 0.4));
  contact.move({1e-6, 0.0});
  contact.move({-2e-6, 0.0});
  contact.move({0.0, 1e-7});
  EXPECT_GT(contact.shear(), 0.0);
  contact.move({2e-6, 0.0});
  EXPECT_EQ(contact.shear(), 0.0);
  contact.move({-2e-6, 0.0}); // along a branch that has turned by 1e-4: slips 2e-10 m
  EXPECT_NEAR(contact.shear(), 2e-10 * k_t, 1e-3 * 2e-10 * k_t);
}

// w_c = (r_j w_i + r_i w_j) / (r_i + r_j)
TEST(Blending, interpolates_weights_to_the_point_of_contact) {
  dem::Settings<3> settings = cases::pair_model<3>({1.0, 0.0, 0.0}, rock(3));
  settings.radii = {0.75e-3, 0.25e-3};
  dem::Engine<3> engine(settings);
  const double full = engine.particles().mass[0], inertia = engine.particles().inertia[0];
  const double weight[] = {0.8, 0.4};
  engine.set_weights(weight);
  EXPECT_DOUBLE_EQ(engine.contacts().weight[0], 0.25 * 0.8 + 0.75 * 0.4);
  EXPECT_DOUBLE_EQ(engine.particles().mass[0], 0.8 * full);
  EXPECT_DOUBLE_EQ(engine.particles().inertia[0], 0.8 * inertia);
  // Mass of a sphere 4/3 pi r³ rho, moment of inertia 2/5 m r².
  EXPECT_NEAR(full, 4.0 / 3.0 * std::numbers::pi * std::pow(0.75e-3, 3) * 2600.0, 1e-15 * full);
  EXPECT_NEAR(inertia, 0.4 * full * 0.75e-3 * 0.75e-3, 1e-15 * inertia);
}

// 1 - alpha is linear and may leave [0.05, 1] at a centre while the point of contact lies inside:
// the bounds hold where the weight is used, at the contact and for the mass.
TEST(Blending, bounds_the_share_at_the_contact_and_of_the_mass_each_for_itself) {
  dem::Engine<2> engine(cases::pair_model<2>({1.0, 0.0}, rock(2)));
  const double full = engine.particles().mass[0];
  const double beyond[] = {1.2, 0.6}, nothing[] = {0.0, 0.02};
  engine.set_weights(beyond);
  EXPECT_DOUBLE_EQ(engine.contacts().weight[0], 0.9);
  EXPECT_DOUBLE_EQ(engine.particles().mass[0], full);
  engine.set_weights(nothing);
  EXPECT_DOUBLE_EQ(engine.contacts().weight[0], 0.05);
  EXPECT_DOUBLE_EQ(engine.particles().mass[0], 0.05 * full);
}

} // namespace
} // namespace kerf
