// Collisions of two spheres, normal and oblique, against closed forms and the theory of impact.
#include "tests/cases/dem_models.hpp"
#include "tests/cases/oblique_impact.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kerf {
namespace {

using cases::rock;
using cases::spacing;
using std::numbers::pi;

constexpr double radius = 0.5 * spacing;

/// Two equal spheres that are about to touch along x; the second one moves.
template <int dim>
dem::Settings<dim> collision(const dem::Material& material, const Vec<dim>& velocity) {
  auto settings = cases::pair_model<dim>(Vec<dim>::UnitX(), material);
  settings.bonds = false;
  dem::InitialCondition<dim> condition;
  condition.box = Box<dim>{settings.positions[1], settings.positions[1]};
  condition.velocity = velocity;
  settings.initial = {condition};
  return settings;
}

/// A sphere that is about to touch one of a thousand times its radius, which is held.
dem::Settings<3> collision_with_a_plane(const dem::Material& material, double speed) {
  auto settings = collision<3>(material, {-speed, 0.0, 0.0});
  settings.radii[0] = 1000.0 * radius;
  settings.positions[0][0] = -999.0 * radius;
  settings.positions[1][0] = 2.0 * radius;
  settings.initial[0].box = Box<3>{settings.positions[1], settings.positions[1]};
  settings.boundary = {cases::prescribe_at<3>(settings.positions[0], dem::Motion::fixed)};
  return settings;
}

/// What a collision was like.
template <int dim> struct Impact {
  double duration = 0.0, overlap = 0.0, force = 0.0; // s, m, N
  Vec<dim> velocity;                                 // of the second less the first, after it
  Rot<dim> spin;                                     // of the second, after it
};
template <int dim> Impact<dim> collide(const dem::Settings<dim>& settings, double dt) {
  dem::Engine<dim> engine(settings);
  engine.start(dt);
  Impact<dim> impact;
  bool touched = false;
  for (int n = 0; n < 10000000; ++n) {
    cases::step(engine);
    const double force = -engine.contacts().normal_force[0];
    if (force > 0.0) {
      touched = true;
      impact.duration += dt;
      impact.force = std::max(impact.force, force);
      const auto& p = engine.particles();
      impact.overlap = std::max(impact.overlap, -(p.displacement[1][0] - p.displacement[0][0]));
    } else if (touched) {
      break;
    }
  }
  const auto& p = engine.particles();
  impact.velocity = p.velocity[1] - p.velocity[0];
  impact.spin = p.angular_velocity[1];
  return impact;
}

dem::Material glass() {
  dem::Material material;
  material.density = 2500.0;
  material.law = dem::NormalLaw::hertz_mindlin;
  material.young_modulus = 70e9;
  material.poisson_ratio = 0.23;
  return material;
}

double mass_of(const dem::Material& material) {
  return material.density * 4.0 / 3.0 * pi * std::pow(radius, 3);
}
double reduced_modulus(const dem::Material& material) { // E*
  return material.young_modulus / (2.0 * (1.0 - std::pow(material.poisson_ratio, 2)));
}

// Reference: H. Hertz (1881): the largest overlap is (15 m* v² / (16 sqrt(R*) E*))^(2/5), and the
// impact takes 2 delta / v times the integral of 1/sqrt(1 - x^(5/2)) from 0 to 1, which is 1.4716.
// Tolerance: the highest of 3000 steps an impact misses the peak by their square; the duration is
// known to a step at either end.
void collides_like_hertz(const std::string& body, const dem::Settings<3>& settings, double m_star,
                         double R_star, double v) {
  const double E = reduced_modulus(settings.material);
  const double integral = std::sqrt(pi) * std::tgamma(0.4) / (2.5 * std::tgamma(0.9));
  const double overlap = std::pow(15.0 * m_star * v * v / (16.0 * std::sqrt(R_star) * E), 0.4);
  const double force = 4.0 / 3.0 * E * std::sqrt(R_star) * std::pow(overlap, 1.5);
  const double duration = 2.0 * integral * overlap / v;
  const auto impact = collide<3>(settings, duration / 3000.0);
  const std::string source = "H. Hertz, J. reine angew. Math. 92 (1881) 156";
  const std::string steps = "square of 1/3000, the steps of an impact";
  verify({"largest overlap of " + body, source, 1e-5, steps}, impact.overlap / overlap - 1.0);
  verify({"largest force of " + body, source, 1e-5, steps}, impact.force / force - 1.0);
  verify({"duration of " + body, source, 1e-3, "a step at either end, of 3000"},
         impact.duration / duration - 1.0);
  verify({"rebound velocity of " + body, "energy", 1e-5, steps}, impact.velocity[0] / v - 1.0);
}
TEST(Hertz, impact_of_spheres_has_the_overlap_force_and_duration_of_the_closed_form) {
  const double m = mass_of(glass());
  for (const double v : {0.1, 5.0})
    collides_like_hertz("two spheres", collision<3>(glass(), {-v, 0.0, 0.0}), 0.5 * m, 0.5 * radius,
                        v);
}
// The closed form has the same R* = r 1000 / 1001, so that only the steps count; a plane would
// differ by 4e-4.
TEST(Hertz, impact_on_a_plane_has_the_overlap_force_and_duration_of_the_closed_form) {
  for (const double v : {0.1, 5.0})
    collides_like_hertz("a sphere and a held one of 1000 radii", collision_with_a_plane(glass(), v),
                        mass_of(glass()), radius * 1000.0 / 1001.0, v);
}

// Closed form: half a swing of a mass on the spring of a wall. Walls have linear springs only.
TEST(Walls, a_sphere_hits_a_plane_for_half_a_swing_of_its_spring) {
  dem::Settings<3> settings;
  settings.material = rock(3);
  settings.radii = {radius};
  settings.positions = {{0.0, 0.0, radius}};
  const double k = 1e6, v = 0.5, m = mass_of(settings.material);
  settings.tools = {{"floor",
                     dem::ToolShape<3>(dem::Plane<3>{Vec<3>::Zero(), Vec<3>::UnitZ()}),
                     {},
                     dem::WallMaterial{k, 0.0, 0.0, false}}};
  settings.initial.resize(1);
  settings.initial[0].velocity[2] = -v;
  dem::Engine<3> engine(settings);
  const double omega = std::sqrt(k / m), dt = pi / omega / 3000.0;
  engine.start(dt);
  double overlap = 0.0, force = 0.0;
  int steps = 0;
  do {
    cases::step(engine);
    ++steps;
    overlap = std::max(overlap, -engine.particles().displacement[0][2]);
    force = std::max(force, -engine.tools()[0].load().force[2]);
  } while (engine.particles().displacement[0][2] < 0.0);
  const std::string source = "half a swing of m on k";
  const std::string reason = "square of 1/3000, the steps of an impact";
  verify({"largest overlap of a sphere on a wall", source, 1e-5, reason},
         overlap * omega / v - 1.0);
  verify({"largest force of a sphere on a wall", source, 1e-5, reason},
         force / (v * std::sqrt(k * m)) - 1.0);
  verify({"duration of the impact on a wall", source, 1e-3, "a step at either end, of 3000"},
         steps * dt * omega / pi - 1.0);
}

// Reference: a spring and dashpot end with e times the velocity they began with; for spheres of
// Hertz T. Antypov & J.A. Elliott (2011), whatever the velocity. Tolerance: the velocity of the
// dashpot is half a step old, and the last step leaves the contact; both fall with the step.
TEST(Dashpots, give_the_coefficient_of_restitution_at_any_velocity) {
  const std::string reason = "first order in the step: the dashpot's velocity is half a step old";
  for (const double e : {0.9, 0.5}) {
    dem::Material linear = rock(3);
    linear.restitution = e;
    const double time = pi * std::sqrt(0.5 * mass_of(linear) / linear.normal_stiffness);
    for (const double v : {0.01, 1.0}) {
      const auto impact = collide<3>(collision<3>(linear, {-v, 0.0, 0.0}), time / 2000.0);
      verify({"restitution of a linear spring and dashpot", "closed form of the damped swing", 3e-3,
              reason},
             impact.velocity[0] / v - e);
    }
    dem::Material hertz = glass();
    hertz.restitution = e;
    for (const double v : {0.1, 5.0}) {
      const auto impact = collide<3>(collision<3>(hertz, {-v, 0.0, 0.0}), 1e-9);
      verify({"restitution of Hertz spheres with dashpots",
              "Antypov & Elliott (2011), doi:10.1209/0295-5075/94/50004", 6e-3, reason},
             impact.velocity[0] / v - e);
    }
  }
}

// Reference: N. Maw, J.R. Barber & J.N. Fawcett, Wear 38 (1976) 101,
// doi:10.1016/0043-1648(76)90201-2 in its linear form: a contact that sticks swings in shear at
// omega_t² = k_t / m* (1 + m r² / I) while it swings once at omega_n² = k_n / m*, so its tangential
// velocity at the end is cos(pi omega_t / omega_n) of that at the start. Tolerance: 1000 steps an
// impact; the contact turns by 1e-4.
template <int dim> void sticks(double inertia_factor) {
  dem::Material material = rock(dim, 0.3);
  material.friction = 1e6;
  const double v = 1e-3;
  Vec<dim> velocity = Vec<dim>::Zero();
  velocity[0] = -v;
  velocity[1] = 0.5 * v;
  const auto settings = collision<dim>(material, velocity);
  const double m = dem::Engine<dim>(settings).particles().mass[0];
  const double omega_n = std::sqrt(material.normal_stiffness / (0.5 * m));
  const double omega_t =
      std::sqrt(material.tangential_stiffness / (0.5 * m) * (1.0 + 1.0 / inertia_factor));
  const auto impact = collide<dim>(settings, pi / omega_n / 1000.0);
  // Both spheres turn alike: the surfaces move by r (omega_i + omega_j) against their centres.
  const double after = impact.velocity[1] - 2.0 * radius * impact.spin[rotations<dim> - 1];
  verify({"rebound of the contact point of linear springs that stick",
          "swings at omega_t during half a swing at omega_n", 5e-3, "1000 steps an impact"},
         after / v - 0.5 * std::cos(pi * omega_t / omega_n));
}
TEST(ObliqueImpact, that_sticks_swings_in_shear_in_2D) {
  sticks<2>(0.5);
}
TEST(ObliqueImpact, that_sticks_swings_in_shear_in_3D) {
  sticks<3>(0.4);
}

// Reference: the same paper: an impact that slides all the time loses 2 mu (1 + m r² / I) v_n of
// its tangential velocity, and gains spin 2 mu m v_n r / I on either side with v_n half the
// approach.
TEST(ObliqueImpact, that_slides_loses_what_friction_takes) {
  dem::Material material = glass();
  material.friction = 0.1;
  const double v = 0.1;
  const auto impact = collide<3>(collision<3>(material, {-v, 2.0 * v, 0.0}), 2e-10);
  const std::string source = "impulse of friction, mu times the normal one";
  verify({"velocity of a sphere that slides at impact", source, 2e-3, "2000 steps an impact"},
         impact.velocity[1] / v - (2.0 - 2.0 * material.friction));
  verify({"spin of a sphere that slides at impact", source, 2e-3, "2000 steps an impact"},
         std::abs(impact.spin[2]) * radius / v - material.friction / 0.4);
}

// Reference: Maw, Barber & Fawcett (1976). With psi = 2 (1 - nu) / (mu (2 - nu)) times tangential
// over normal velocity of the contact point, before (1) and after (2), and chi = (1 - nu) / (2 -
// nu) (1 + m r² / I), spheres of one material are all the same. From psi_1 = 4 chi - 1 on they
// slide throughout and psi_2 = psi_1 - 4 chi. Below, annuli of the contact slip, which a law with
// one force for the whole contact cannot know: it sticks until all of it slides. And while the
// contact shrinks, that force fades by the mean of the stretch, though the parts that leave came
// last and are stretched least. So it gives back too little: psi_2 is up to 0.55 too large, most at
// psi_1 = 1.5 without a Poisson's ratio, 0.46 at 0.23, and 0.38 at 0.4.
TEST(ObliqueImpact, rebounds_as_its_law_says_and_near_the_solution_of_maw_barber_and_fawcett) {
  const double v = 0.1;
  const std::string paper = "Maw, Barber & Fawcett (1976), doi:10.1016/0043-1648(76)90201-2";
  for (const double nu : {0.0, 0.23, 0.4}) {
    dem::Material material = glass();
    material.poisson_ratio = nu;
    material.friction = 0.1;
    const cases::ObliqueImpact theory{.poisson_ratio = nu};
    const double scale = theory.psi_scale() / material.friction;
    const double overlap =
        std::pow(15.0 * 0.5 * mass_of(material) * v * v /
                     (16.0 * std::sqrt(0.5 * radius) * reduced_modulus(material)),
                 0.4);
    for (const double share : {0.05, 0.15, 0.25, 0.4, 0.55, 0.7, 0.85, 0.95, 1.2, 1.5}) {
      const double psi = share * (4.0 * theory.chi() - 1.0);
      const auto impact = collide<3>(collision<3>(material, {-v, psi / scale * v, 0.0}),
                                     2.94 * overlap / v / 3000.0);
      const double after = (impact.velocity[1] - 2.0 * radius * impact.spin[2]) / v * scale;
      const double law = theory.rebound_of_one_spring(psi);
      const double exact = theory.rebound(psi);
      std::printf("nu %.2f, psi_1 %6.3f: psi_2 %7.4f, law %7.4f, Maw et al. %7.4f\n", nu, psi,
                  after, law, exact);
      verify({"psi_2 of an oblique impact by the law of a single spring, of psi from 0 to 9",
              "its equations for a plane contact, integrated in the test", 0.01,
              "3000 steps an impact; the contact turns meanwhile"},
             after - law);
      if (share > 1.0) {
        EXPECT_NEAR(exact, psi - 4.0 * theory.chi(), 1e-3);
        verify({"psi_2 of an oblique impact that slides, psi_1 >= 4 chi - 1", paper, 0.01,
                "3000 steps an impact; the contact turns meanwhile"},
               after - (psi - 4.0 * theory.chi()));
      } else
        verify({"psi_2 of an oblique impact with partial slip, psi_1 < 4 chi - 1", paper, 0.6,
                "no annulus of slip, and a force that fades by the mean stretch: 0.55 at worst"},
               after - exact);
    }
  }
}

} // namespace
} // namespace kerf
