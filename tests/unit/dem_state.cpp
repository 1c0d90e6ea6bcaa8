// An engine that takes the state of another one makes the same steps, to the last bit.
#include "dem_core/engine.hpp"
#include "tests/cases/dem_models.hpp"

#include <gtest/gtest.h>

namespace kerf {
namespace {

/// A block that breaks between a moving wall and a floor, with weight, damping and a servo.
template <int dim> dem::Settings<dim> crushed_block(dem::NormalLaw law = dem::NormalLaw::linear) {
  std::array<int, dim> count;
  count.fill(dim == 2 ? 12 : 6);
  dem::Material material = cases::rock(dim);
  material.tensile_strength = material.shear_strength = dim == 2 ? 2e3 : 2.0;
  material.friction = 0.5;
  if (dim == 3) {
    material.bond_radius_ratio = 0.7;
    material.restitution = 0.8;
  }
  if (law == dem::NormalLaw::hertz_mindlin) {
    material = {};
    material.density = 2600.0;
    material.law = law;
    material.young_modulus = 1e9;
    material.poisson_ratio = 0.2;
    material.friction = 0.4;
    material.rolling_friction = 0.1;
  }
  auto settings = cases::lattice_model<dim>(
      dim == 2 ? dem::LatticeType::triangular : dem::LatticeType::cubic, count, material);
  settings.bonds = law == dem::NormalLaw::linear;
  settings.damping = {dem::DampingKind::nonviscous, 0.1, 0.1};
  settings.gravity[dim - 1] = -9.81;
  Vec<dim> up = Vec<dim>::Unit(dim - 1);
  const dem::WallMaterial wall{material.normal_stiffness > 0.0 ? material.normal_stiffness : 1e6,
                               1e5, 0.3};
  dem::ToolMotion<dim> floor, top;
  settings.tools.push_back(
      {"floor", dem::ToolShape<dim>(dem::Plane<dim>{-0.5 * cases::spacing * up, up}), floor, wall});
  const double rise = (dim == 2 ? std::sqrt(0.75) : 1.0) * cases::spacing; // from row to row
  const Vec<dim> start = ((count[0] - 1) * rise + 0.5 * cases::spacing) * up;
  top.reference = start;
  top.velocity[dim - 1] = kerf::TimeTable(-3.0);
  settings.tools.push_back({"top", dem::ToolShape<dim>(dem::Plane<dim>{start, -up}), top, wall});
  dem::Prescription<dim> hold;
  hold.box = {Vec<dim>::Constant(-1e-4), Vec<dim>::Constant(1e-4)};
  hold.components = 1;
  hold.motion = dem::Motion::hann;
  hold.amplitude = 1e-5 * Vec<dim>::Unit(0);
  hold.duration = 1e-4;
  settings.boundary.push_back(hold);
  return settings;
}

template <int dim> void a_restored_engine_goes_on(const dem::Settings<dim>& settings) {
  dem::Engine<dim> whole(settings);
  const double time_step = 0.5 * 2.0 / std::sqrt(whole.step_limit().omega2);
  whole.start(time_step);
  std::size_t touching = 0; // the most particles that did
  for (int n = 0; n < 900; ++n) {
    if (n % 150 == 149) { // at several moments, with and without contacts of the tools
      const State state = whole.state();
      dem::Engine<dim> other(settings);
      other.start(time_step);
      other.restore(state);
      EXPECT_EQ(other.state(), state) << n;
      EXPECT_EQ(other.step(), whole.step());
      for (int k = 0; k < 100; ++k)
        cases::step(other);
      for (int k = 0; k < 100; ++k)
        cases::step(whole);
      n += 100;
      ASSERT_EQ(other.state(), whole.state()) << n;
      EXPECT_EQ(other.energies().elastic, whole.energies().elastic);
      EXPECT_EQ(other.energies().external_work, whole.energies().external_work);
      EXPECT_EQ(other.unbalanced_force(), whole.unbalanced_force());
    }
    cases::step(whole);
    touching = std::max(touching, whole.wall_contacts()[1].size());
  }
  EXPECT_EQ(whole.cracks().size() > 10, settings.bonds);
  EXPECT_GT(touching, 5u);
  EXPECT_GT(whole.renewals(), 0u);
}

TEST(DemState, carries_on_discs_that_break) {
  a_restored_engine_goes_on(crushed_block<2>());
}
TEST(DemState, carries_on_spheres_with_bonds_that_bend_and_dashpots) {
  a_restored_engine_goes_on(crushed_block<3>());
}
TEST(DemState, carries_on_grains_of_hertz_and_mindlin) {
  a_restored_engine_goes_on(crushed_block<3>(dem::NormalLaw::hertz_mindlin));
}

TEST(DemState, is_refused_by_another_model) {
  const auto settings = crushed_block<2>();
  dem::Engine<2> engine(settings);
  engine.start(1e-8);
  auto other_settings = settings;
  other_settings.radii[3] *= 0.99;
  dem::Engine<2> other(other_settings);
  other.start(1e-8);
  EXPECT_THROW(other.check_model(engine.state()), std::invalid_argument);
  EXPECT_THROW(other.restore(engine.state()), std::invalid_argument);
}

} // namespace
} // namespace kerf
