// Several materials in one body: who is of which, what pairs say, and laws side by side.
#include "tests/cases/mixed_body.hpp"

#include "dem_core/spatial_order.hpp"

#include <gtest/gtest.h>
#include <omp.h>

namespace kerf {
namespace {

using cases::glass;
using cases::rock;
using cases::spacing;

/// Two spheres of two materials that overlap by 1e-6 m, and what moves the second one by hand.
class Pair {
public:
  explicit Pair(const std::vector<dem::MaterialPair>& pairs, bool bonds = false) {
    dem::Settings<3> settings = cases::pair_model<3>(Vec<3>::UnitX(), rough());
    settings.positions[1][0] -= 1e-6;
    settings.other_materials = {smooth()};
    settings.material_of = {0, 1};
    settings.pairs = pairs;
    settings.bonds = bonds;
    const dem::Engine<3> engine(settings);
    particles_ = engine.particles();
    contacts_ = engine.contacts();
  }
  static dem::Material rough() {
    dem::Material material = rock(3);
    material.friction = 0.8;
    material.tensile_strength = 5.0;
    return material;
  }
  static dem::Material smooth() {
    dem::Material material = rock(3);
    material.friction = 0.3;
    material.tensile_strength = 7.0;
    material.shear_strength = 2.0;
    return material;
  }
  void move(const Vec<3>& by) {
    const std::vector<dem::Aligned<Vec<3>>> translation = {Vec<3>::Zero(), by};
    const std::vector<dem::Aligned<Rot<3>>> rotation(2);
    particles_.displacement[1] += by;
    dem::compute_contact_forces(contacts_, particles_, {translation, rotation, 1.0},
                                dem::ShearIncrement::midpoint, loads_);
  }
  /// Of a contact that slides.
  double friction() {
    move({0.0, 5e-6, 0.0});
    return contacts_.shear_force[0].norm() / -contacts_.normal_force[0];
  }
  dem::Contacts<3>& contacts() { return contacts_; }

private:
  dem::Particles<3> particles_;
  dem::Contacts<3> contacts_;
  dem::Loads<3> loads_;
};

TEST(MaterialPairs, have_the_smaller_friction_and_strengths_unless_they_say_otherwise) {
  EXPECT_NEAR(Pair({}).friction(), 0.3, 1e-12);
  dem::MaterialPair said{0, 1, Pair::rough(), Pair::smooth()};
  said.of_first.friction = said.of_second.friction = 0.5;
  EXPECT_NEAR(Pair({said}).friction(), 0.5, 1e-12);
  dem::MaterialPair turned{1, 0, said.of_second, said.of_first};
  EXPECT_NEAR(Pair({turned}).friction(), 0.5, 1e-12);

  Pair bonded({}, true);
  ASSERT_TRUE(bonded.contacts().bonded[0]);
  EXPECT_EQ(bonded.contacts().tensile_strength[0], 5.0);
  EXPECT_EQ(bonded.contacts().shear_strength[0], 2.0);
  said.bonds = false;
  EXPECT_FALSE(Pair({said}, true).contacts().bonded[0]);
}

TEST(MaterialPairs, are_refused_when_they_cannot_be) {
  const std::vector<dem::Material> others = {rock(3), glass()};
  const dem::MaterialPair a_b{0, 1, rock(3), rock(3)};
  dem::MaterialPair with_glass{1, 2, rock(3), glass()};
  const auto make = [&](std::vector<dem::MaterialPair> pairs) {
    return dem::Materials(rock(3), others, pairs);
  };
  dem::MaterialPair of_glass{2, 0, glass(), glass()}, more = with_glass;
  more.of_first = glass();
  EXPECT_NO_THROW(make({a_b, of_glass, more}));
  EXPECT_THROW(make({a_b, of_glass}), std::invalid_argument);            // two laws
  EXPECT_THROW(make({of_glass, with_glass}), std::invalid_argument);     // still two laws
  EXPECT_THROW(make({of_glass, more, a_b, a_b}), std::invalid_argument); // twice
  EXPECT_THROW(make({of_glass, more, {1, 0, rock(3), rock(3)}, a_b}), std::invalid_argument);
  EXPECT_THROW(make({of_glass, more, {0, 3, rock(3), rock(3)}}), std::invalid_argument);
  more.of_second.poisson_ratio = 0.6;
  EXPECT_THROW(make({of_glass, more}), std::invalid_argument);
}

// One material under two names is one material, to the last bit.
TEST(Materials, that_are_alike_make_no_difference) {
  const auto run = [](bool two_names) {
    auto material = rock(3);
    material.tensile_strength = material.shear_strength = 1.0;
    material.friction = 0.4;
    auto settings = cases::irregular_model<3>(6, material, 2);
    if (two_names) {
      settings.other_materials = {material};
      for (std::size_t i = 0; i < settings.positions.size(); ++i)
        settings.material_of.push_back(i % 3 == 0);
    }
    cases::shake(settings, 1.0, 3);
    dem::Engine<3> engine(settings);
    engine.start(1e-7);
    for (int n = 0; n < 300; ++n)
      cases::step(engine);
    EXPECT_GT(engine.cracks().size(), 10u);
    std::vector<double> u;
    for (const auto& displacement : engine.particles().displacement)
      u.insert(u.end(), displacement.begin(), displacement.end());
    return u;
  };
  EXPECT_EQ(run(false), run(true));
}

TEST(Materials, give_every_particle_its_density_mass_and_weight) {
  auto settings = cases::lattice_model<3>(dem::LatticeType::cubic, {3, 3, 3}, rock(3));
  for (Vec<3>& x : settings.positions)
    x *= 2.0; // nobody touches
  dem::Material lead = rock(3);
  lead.density = 11300.0;
  settings.other_materials = {lead};
  for (const Vec<3>& x : settings.positions)
    settings.material_of.push_back(x[0] > 3.0 * spacing);
  settings.gravity = {0.0, 0.0, -10.0};
  const double volume = dem::volume_of_radius<3>(0.5 * spacing);
  const double total = volume * (18 * 2600.0 + 9 * 11300.0);

  dem::put_in_spatial_order(settings);
  dem::Engine<3> engine(settings);
  double mass = 0.0;
  for (std::size_t i = 0; i < engine.size(); ++i) {
    const auto& p = engine.particles();
    const double rho = p.reference[i][0] > 3.0 * spacing ? 11300.0 : 2600.0;
    EXPECT_EQ(p.mass[i], rho * volume);
    EXPECT_EQ(p.inertia[i], 0.4 * p.mass[i] * 0.25 * spacing * spacing);
    mass += p.mass[i];
  }
  EXPECT_NEAR(mass, total, 1e-14 * total);

  engine.start(1e-5);
  engine.compute_own_forces();
  const std::vector<std::uint32_t> first = {0};
  std::vector<double> force(3);
  engine.own_forces(first, force);
  EXPECT_EQ(force[2], engine.particles().mass[0] * -10.0);
  engine.integrate();
  for (int n = 1; n < 100; ++n)
    cases::step(engine);
  EXPECT_NEAR(engine.momentum()[2], total * -10.0 * 99e-5, 1e-10 * total); // of t_n, n = 99

  // Blended as one material is, and a wished step makes the lighter ones heavier.
  dem::Engine<3> blended(settings);
  blended.set_weights(std::vector<double>(blended.size(), 0.5));
  EXPECT_EQ(blended.particles().mass[0], 0.5 * engine.particles().mass[0]);
}

TEST(Materials, have_the_critical_step_of_the_mixed_stiffness) {
  auto settings = cases::rock_and_grains({3, 3, 4}, dem::Material::unbreakable, 0.0);
  for (Vec<3>& x : settings.positions)
    x *= 0.99; // grains touch, too
  const dem::Engine<3> engine(settings);
  EXPECT_GE(engine.step_limit().omega2, cases::largest_eigenvalue(engine));
  EXPECT_LE(engine.step_limit().omega2, 2.0 * cases::largest_eigenvalue(engine));
}

dem::Settings<3> crushed() {
  auto settings = cases::rock_and_grains({11, 11, 12}, 0.3, 2.0);
  settings.gravity = {0.0, 0.0, -9.81};
  settings.material.restitution = 0.9;
  settings.other_materials[0].rolling_friction = 0.05;
  return settings;
}

TEST(Materials, side_by_side_give_the_same_bits_for_any_number_of_threads) {
  const int before = omp_get_max_threads();
  const auto run = [](int threads) {
    omp_set_num_threads(threads);
    dem::Engine<3> engine(crushed());
    engine.start(1e-7);
    for (int n = 0; n < 250; ++n)
      cases::step(engine);
    EXPECT_GT(engine.contacts().blocks(), 1u);
    EXPECT_GT(engine.cracks().size(), 10u);
    return engine.state();
  };
  const State one = run(1), two = run(2);
  omp_set_num_threads(before);
  EXPECT_EQ(one, two);
}

TEST(Materials, side_by_side_go_on_to_the_same_bits_from_a_state) {
  auto settings = cases::rock_and_grains({5, 5, 6}, 0.3, 2.0);
  dem::Engine<3> whole(settings), other(settings);
  whole.start(1e-7);
  other.start(1e-7);
  for (int n = 0; n < 400; ++n)
    cases::step(whole);
  EXPECT_GT(whole.cracks().size(), 5u);
  EXPECT_GT(whole.renewals(), 0u);
  other.restore(whole.state());
  EXPECT_EQ(other.state(), whole.state());
  for (int n = 0; n < 400; ++n) {
    cases::step(whole);
    cases::step(other);
  }
  EXPECT_EQ(other.state(), whole.state());
  EXPECT_EQ(other.energies().elastic, whole.energies().elastic);

  auto swapped = settings;
  std::swap(swapped.material_of.front(), swapped.material_of.back());
  EXPECT_THROW(dem::Engine<3>(swapped).check_model(whole.state()), std::invalid_argument);
}

TEST(Materials, have_a_new_friction_in_all_pairs) {
  auto settings = cases::rock_and_grains({4, 4, 4}, 0.3, 1.0);
  dem::Engine<3> engine(settings);
  engine.start(1e-7);
  cases::step(engine);
  dem::Change<3> change;
  change.friction = 0.7;
  engine.change(change);
  const auto& c = engine.contacts();
  for (std::size_t k = 0; k < c.size(); ++k)
    EXPECT_EQ(c.friction[k], 0.7);
  change.friction = -0.1;
  EXPECT_THROW(engine.change(change), std::invalid_argument);
}

/// Grains of Hertz and Mindlin whose bonds are springs.
dem::Material cemented(double strength) {
  dem::Material material = glass();
  material.normal_stiffness = 1e6;
  material.tangential_stiffness = 5e5;
  material.tensile_strength = strength;
  return material;
}

// A bond that broke stays the spring that it was, free of stress at its own distance; particles
// that were never bonded press one another as spheres do.
TEST(HertzianGrains, have_linear_bonds_also_after_they_broke) {
  const double strength = 1.0;
  auto settings = cases::pair_model<3>(Vec<3>::UnitX(), cemented(strength));
  settings.positions[1][0] -= 2e-6;
  const dem::Engine<3> engine(settings);
  ASSERT_EQ(engine.bonds(), 1u);
  auto particles = engine.particles();
  auto contacts = engine.contacts();
  dem::Loads<3> loads;
  const std::vector<dem::Aligned<Rot<3>>> rotation(2);
  const auto stretch = [&](double to) {
    const std::vector<dem::Aligned<Vec<3>>> by = {
        Vec<3>::Zero(), to * Vec<3>::UnitX() - Vec<3>(particles.displacement[1])};
    particles.displacement[1] += by[1];
    dem::compute_contact_forces(contacts, particles, {by, rotation, 1.0},
                                dem::ShearIncrement::midpoint, loads);
    return contacts.normal_force[0];
  };
  EXPECT_NEAR(stretch(0.5e-6), 0.5, 1e-9);
  EXPECT_EQ(stretch(1.5e-6), 0.0);
  EXPECT_FALSE(contacts.bonded[0]);
  EXPECT_NEAR(stretch(-1e-6), -1.0, 1e-9);
  EXPECT_FALSE(contacts.is_hertzian(0));

  settings.bonds = false;
  dem::Engine<3> loose(settings);
  loose.start(1e-9);
  loose.compute_own_forces();
  const double E = 2e9 / (2.0 * (1.0 - 0.25 * 0.25));
  EXPECT_NEAR(loose.contacts().normal_force[0],
              -4.0 / 3.0 * E * std::sqrt(0.25 * spacing) * std::pow(2e-6, 1.5), 1e-9);
}

// Reference: the energy of both springs, 2/5 F delta and F²/2k; the difference is in the books.
TEST(HertzianGrains, that_are_bonded_under_pressure_keep_their_force_and_energy) {
  auto settings = cases::pair_model<3>(Vec<3>::UnitX(), cemented(dem::Material::unbreakable));
  settings.bonds = false;
  dem::InitialCondition<3> condition;
  condition.box = Box<3>{settings.positions[1], settings.positions[1]};
  condition.velocity = {-0.05, 0.0, 0.0};
  settings.initial = {condition};
  dem::Engine<3> engine(settings);
  engine.start(2e-10);
  while (engine.contacts().normal_force[0] > -2e-3)
    cases::step(engine);
  const auto total = [&] {
    const dem::Energies e = engine.energies();
    return e.kinetic + e.elastic + e.fracture_dissipation;
  };
  const double force = engine.contacts().normal_force[0], energy = total();
  dem::Change<3> change;
  change.bond_gap = 1e-3;
  engine.change(change);
  EXPECT_EQ(engine.bonds(), 1u);
  cases::step(engine);
  EXPECT_NEAR(engine.contacts().normal_force[0], force, 1e-3 * std::abs(force)); // a step of motion
  double largest = 0.0; // N
  for (int n = 0; n < 20000; ++n) {
    cases::step(engine);
    largest = std::max(largest, engine.contacts().normal_force[0]);
  }
  EXPECT_GT(largest, 1e-3); // it pulls
  EXPECT_NEAR(total(), energy, 1e-6 * energy);
}

TEST(HertzianGrains, without_springs_are_never_bonded) {
  auto settings = cases::pair_model<3>(Vec<3>::UnitX(), glass());
  dem::Engine<3> engine(settings);
  EXPECT_EQ(engine.bonds(), 0u);
  engine.start(1e-7);
  dem::Change<3> change;
  change.bond_gap = 1e-2;
  EXPECT_THROW(engine.change(change), std::invalid_argument);
}

} // namespace
} // namespace kerf
