// A copper rod that hits a rigid wall: finite plastic strain.
#include "tests/cases/fem_loads.hpp"
#include "tests/verification/verification.hpp"

#include "fem_core/mesh/disc.hpp"

#include <gtest/gtest.h>

namespace kerf::fem {
namespace {

constexpr double length = 32.4e-3, radius = 3.2e-3; // m
constexpr double speed = 227.0, end_time = 80e-6;   // m/s, s

Material copper(Formulation formulation) {
  return {.law = J2Plastic::from(IsotropicElastic::from_young(8930.0, 117e9, 0.35),
                                 Hardening::linear(400e6, 100e6)),
          .finite_strain = true,
          .formulation = formulation,
          .hourglass_stiffness = 0.01}; // elastic control resists plastic flow: 0.1 leaves 6.3 mm
}

struct Rod {
  double length, foot; // m
  double plastic;      // largest equivalent plastic strain of an element
  double balance;      // error of the energy over that of the impact
};

/// Flies against the direction of an axis; the foot stays on its wall.
template <int dim>
Rod strike(Mesh<dim> mesh, Formulation formulation, Plane plane, int axis,
           std::vector<BoundarySetting<dim>> walls) {
  const Vec<dim> velocity = -speed * Vec<dim>::Unit(axis);
  Engine<dim> engine(
      std::move(mesh),
      {.materials = {{.material = copper(formulation), .region = {}, .box = {}}},
       .plane = plane,
       .boundary = std::move(walls),
       .initial = {
           {.box = {}, .velocity = InitialVelocity<dim>{.velocity = velocity}, .pulse = {}}}});
  // Elements of the foot are flattened by plastic strains of 3, and with them the critical step.
  const int steps = static_cast<int>(std::ceil(end_time / (0.09 * cases::critical_step(engine))));
  engine.start(end_time / steps);
  engine.integrate();
  const double start = engine.energies().kinetic;
  for (int n = 1; n < steps; ++n)
    engine.integrate();
  const Energies e = engine.energies();
  Rod rod{.length = 0.0,
          .foot = 0.0,
          .plastic = 0.0,
          .balance = (e.kinetic + e.elastic + e.dissipated + e.hourglass - start) / start};
  const std::vector<double> u = engine.displacement();
  for (std::size_t a = 0; a < engine.mesh().num_nodes(); ++a) {
    const Vec<dim> X = engine.mesh().position(a), x = X + Vec<dim>(u.data() + a * dim);
    rod.length = std::max(rod.length, x[axis]);
    if (X[axis] < 1e-9)
      rod.foot = std::max(rod.foot, dim == 2 ? x[0] : x.template head<2>().norm());
  }
  for (const std::uint32_t element : engine.active_elements())
    rod.plastic = std::max(rod.plastic, engine.element_state(element).history[0]);
  std::printf("  length %.3f mm, radius of the foot %.3f mm, plastic strain %.2f, energy %+.1e\n",
              1e3 * rod.length, 1e3 * rod.foot, rod.plastic, rod.balance);
  return rod;
}

const std::string published = "range of codes; compare A. Kamoulakos, Bench Mark (1990) 31-35";

void verify_rod(const Rod& rod, const std::string& elements) {
  verify({"length of a Taylor bar of " + elements + ", mm", published + ": 21.4 to 21.6", 0.1,
          "the range of the codes"},
         1e3 * rod.length - 21.5);
  verify({"radius of the foot of a Taylor bar of " + elements + ", mm", published + ": 6.8 to 7.2",
          0.2, "the range of the codes"},
         1e3 * rod.foot - 7.0);
  EXPECT_LE(std::abs(rod.balance), 1e-4); // what is dissipated is the energy of the impact
  EXPECT_GT(rod.plastic, 2.0);
}

// Mean dilatation is needed: with full integration the plastic flow
// locks, and the foot ends with a radius of 5.1 mm. Without friction the wall is a side on which
// the foot slides.
TEST(FemTaylorBar, of_rings_ends_as_short_and_as_wide_as_in_other_codes) {
  verify_rod(
      strike<2>(make_box(BoxMesh<2>{.size = {radius, length}, .count = {5, 50}}),
                Formulation::mean_dilatation, Plane::axisymmetric, 1,
                {cases::held<2>("bottom", {false, true}), cases::held<2>("left", {true, false})}),
      "quad4 rings");
}

// A whole rod, free of symmetry. Its outline has 16 sides with their corners on the circle: the
// length does not care, and the foot is measured at the corners too.
TEST(FemTaylorBar, of_bricks_ends_as_short_and_as_wide_as_in_other_codes) {
  for (const auto& [formulation, elements] : {std::pair{Formulation::mean_dilatation, "hex8"},
                                              std::pair{Formulation::one_point, "one-point hex8"}})
    verify_rod(strike<3>(make_cylinder({.radius = radius, .radial = 2, .around = 16},
                                       {.length = length, .count = 32}),
                         formulation, Plane::strain, 2,
                         {cases::held<3>("bottom", {false, false, true})}),
               elements);
}

} // namespace
} // namespace kerf::fem
