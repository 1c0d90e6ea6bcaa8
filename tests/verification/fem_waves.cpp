// Waves in finite elements against closed forms, and the energy of long runs.
#include "tests/cases/fem_bodies.hpp"
#include "tests/verification/verification.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kerf::fem {
namespace {

using cases::rock;
constexpr double pi = std::numbers::pi;

double step_below_limit(const auto& engine, double share) {
  return share * 2.0 / std::sqrt(engine.step_limit().omega2);
}

// A row of quads with nu = 0 in uniform motion along x is a chain of masses rho h H joined by
// springs E H / h: omega = (2 c / h) sin(k h / 2), c = sqrt(E / rho), the textbook chain (for
// example T. J. R. Hughes, The Finite Element Method, 1987, section 9.1). Exact; tolerance for
// rounding.
TEST(FemBar, of_quads_with_zero_poisson_ratio_has_the_dispersion_of_a_chain) {
  const double E = 10e9, rho = 2500.0, h = 1e-3;
  const int count = 24;
  const Mesh<2> mesh = make_box(BoxMesh<2>{.size = {count * h, 0.7e-3}, .count = {count, 1}},
                                {.length = {count * h, 0.0}});
  Engine<2> engine(mesh, {.materials = cases::of<2>(IsotropicElastic::from_young(rho, E, 0.0))});
  const std::vector<double> mass = engine.mass();
  for (int wave = 1; wave <= count / 2; ++wave) {
    const double k = 2.0 * pi * wave / (count * h);
    const double omega = 2.0 * std::sqrt(E / rho) / h * std::sin(0.5 * k * h);
    std::vector<double> u(mesh.positions.size(), 0.0);
    for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
      u[2 * a] = std::cos(k * mesh.position(a)[0] + 0.3);
    const std::vector<double> f = cases::forces(engine, u);
    const double highest = 4.0 * E / rho / h / h; // omega²
    double worst = 0.0;
    for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
      worst = std::max({worst, std::abs(f[2 * a] / mass[a] + omega * omega * u[2 * a]) / highest,
                        std::abs(f[2 * a + 1] / mass[a]) / highest});
    verify({"accelerations of waves in a row of quads", "omega = (2 c / h) sin(k h / 2)", 1e-12,
            "rounding"},
           worst);
  }
}

const std::string shear_or_compression = "c_P² = C11 / rho, c_S² = mu / rho";
struct Wave {
  const char* name;
  int component;
  double speed; // m/s
};

// Plane waves travel with c_P = sqrt(C11 / rho) and c_S = sqrt(mu / rho). A pulse of length 64 h
// lags by the dispersion (k h)²/24 of its main wave number over 200 h, below 0.8 % of the
// amplitude; an error of 1 % in a modulus would show as 5 %.
TEST(FemPulse, travels_with_the_speeds_of_compression_and_shear_waves) {
  const double h = 1e-3, A = 1e-8, length = 64 * h, from = 60 * h, way = 200 * h;
  for (const Wave& wave :
       {Wave{"P", 0, std::sqrt(12e9 / 2500.0)}, Wave{"S", 1, std::sqrt(4e9 / 2500.0)}}) {
    const Mesh<2> mesh =
        make_box(BoxMesh<2>{.size = {320 * h, 3 * h}, .count = {320, 3}}, {.length = {0.0, 3 * h}});
    const InitialPulse pulse{.amplitude = A,
                             .center = from,
                             .length = length,
                             .wave_speed = wave.speed,
                             .spacing = h,
                             .component = wave.component};
    Engine<2> engine(
        mesh,
        {.materials = cases::of<2>(rock), .boundary = {}, .initial = {cases::started<2>(pulse)}});
    const int steps = static_cast<int>(std::ceil(way / wave.speed / step_below_limit(engine, 0.8)));
    engine.start(way / wave.speed / steps);
    for (int n = 0; n < steps; ++n)
      cases::step(engine);
    double error = 0.0;
    const std::vector<double> reached = engine.displacement();
    for (std::size_t a = 0; a < mesh.num_nodes(); ++a) {
      const double z = mesh.position(a)[0] - from - way;
      const double exact =
          std::abs(z) < length / 2 ? A * (1 + std::cos(2 * pi * z / length)) / 2 : 0;
      const Vec<2> u(reached.data() + 2 * a);
      error = std::max(error, std::abs(u[wave.component] - exact));
    }
    verify({std::string("pulse of a ") + wave.name + " wave after 200 elements, over its amplitude",
            shear_or_compression, 0.01, "dispersion (k h)² / 24 over 200 h is below 0.008"},
           error / A);
    std::printf("  %s: largest error of the pulse after 200 elements %.2e of its amplitude\n",
                wave.name, error / A);
  }
}

template <class Dim> struct FemBound : testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
struct DimensionName {
  template <class Dim> static std::string GetName(int) {
    return Dim::value == 2 ? "quad4" : "hex8";
  }
};
TYPED_TEST_SUITE(FemBound, Dimensions, DimensionName);

template <int dim> std::vector<std::vector<double>> weightings(const Mesh<dim>& mesh) {
  return {{}, cases::ramp(mesh, 0.0, 3e-3), cases::ramp(mesh, 1e-3, 1e-3)};
}

// The bound of the elements against the dense eigenvalue problem of the assembled body: never
// below, but for the rounding of two eigenvalue solvers. How much of the time step it wastes is
// printed; 1.25 only guards against a bound that became useless.
TYPED_TEST(FemBound, is_never_below_the_highest_frequency_and_wastes_little) {
  constexpr int dim = TypeParam::value;
  BoxMesh<dim> box{.size = Vec<dim>::LinSpaced(dim, 3.0, 5.0) * 1e-3};
  box.count.fill(dim == 2 ? 4 : 3);
  for (const bool distorted : {false, true}) {
    const Mesh<dim> mesh = distorted ? cases::distorted_box<dim>() : make_box(box);
    for (const std::vector<double>& alpha : weightings(mesh)) {
      Engine<dim> engine(mesh, {.materials = cases::of<dim>(rock), .boundary = {}, .initial = {}});
      engine.set_weights(alpha);
      const double ratio = engine.step_limit().omega2 / cases::largest_omega2(engine);
      verify({"excess of the critical step by the elements' bound, " + std::to_string(dim) + "D",
              "dense eigenvalues of M^-1 K", 1e-12, "rounding of two eigenvalue solvers"},
             std::max(0.0, 1.0 - ratio));
      EXPECT_LE(std::sqrt(ratio), 1.25);
      std::printf("  time step of the bound over the critical one: %.4f (%s%s)\n",
                  1.0 / std::sqrt(ratio), distorted ? "distorted" : "regular",
                  alpha.empty() ? "" : ", blended");
    }
  }
}

// In a periodic mesh of equal cubes the sawtooth along every axis strains each element by the same
// amounts, with all combinations of signs. Its frequency is that of C11; an element alone can
// choose the worst signs, those of pure dilatation. Their eigenvalues relate as C11 to C11 + (dim -
// 1) C12, so for nu = 0 the bound is exact. Tolerance: rounding of two eigenvalue solvers.
TYPED_TEST(FemBound, of_equal_cubes_exceeds_the_highest_frequency_as_dilatation_exceeds_c11) {
  constexpr int dim = TypeParam::value;
  BoxMesh<dim> box{.size = Vec<dim>::Constant(4e-3)};
  box.count.fill(4); // even: the sawtooth fits
  const Mesh<dim> mesh = make_box(box, Period<dim>{.length = box.size});
  for (const double nu : {0.0, 0.25}) {
    const auto material = IsotropicElastic::from_young(2500.0, 10e9, nu);
    const double C11 = material.moduli.uniaxial();
    const double ratio = (C11 + (dim - 1) * material.moduli.lambda) / C11;
    Engine<dim> engine(mesh, {.materials = cases::of<dim>(material)});
    const double exact = cases::largest_omega2(engine);
    const std::string reason = "rounding of two eigenvalue solvers";
    verify({"bound of the frequency of a mesh of cubes, " + std::to_string(dim) + "D",
            "4 c_P² / h², by (C11 + (dim - 1) C12) / C11", 1e-11, reason},
           engine.step_limit().omega2 / exact - ratio);
    verify({"highest frequency of a mesh of cubes, " + std::to_string(dim) + "D", "4 c_P² / h²",
            1e-11, reason},
           4.0 * C11 / 2500.0 / 1e-6 / exact - 1.0);
  }
}

// Rojek (2008) eq. 10, dt_cr = 2 / omega_max. Below it the scheme keeps, for every mode,
// E = 1/2 m vbar² + 1/2 k u² (1 - (omega dt / 2)²), so the elastic energy stays below
// E / (1 - 0.99²); above it the highest mode grows by 1.33 a step.
TYPED_TEST(FemBound, of_the_assembled_body_parts_stable_from_unstable_steps) {
  constexpr int dim = TypeParam::value;
  for (const bool blended : {false, true}) {
    const Mesh<dim> mesh = cases::distorted_box<dim>();
    const InitialPulse pulse{
        .amplitude = 1e-9, .center = 1e-3, .length = 1.7e-3, .wave_speed = 2000.0};
    Engine<dim> engine(mesh, {.materials = cases::of<dim>(rock),
                              .boundary = {},
                              .initial = {cases::started<dim>(pulse)}});
    if (blended)
      engine.set_weights(cases::ramp(mesh, 0.0, 3e-3));
    const double critical = 2.0 / std::sqrt(cases::largest_omega2(engine));

    engine.start(0.99 * critical);
    cases::step(engine);
    const double start = engine.energies().kinetic + engine.energies().elastic;
    double most = 0.0;
    for (int n = 1; n < (dim == 2 ? 100000 : 20000); ++n) {
      cases::step(engine);
      if (n % 10 == 0)
        most = std::max(most, engine.energies().elastic);
    }
    EXPECT_LE(most, start / (1.0 - 0.99 * 0.99));

    engine.start(1.01 * critical);
    for (int n = 0; n < 300; ++n)
      cases::step(engine);
    EXPECT_GT(engine.energies().elastic, 1e6 * start);
  }
}

struct Drift {
  double largest = 0.0; // of |E_n - E_0| / E_0
  double at_end = 0.0;  // (E_end - E_0) / E_0
};

template <int dim> Drift drift(Engine<dim>& engine, int steps) {
  engine.start(step_below_limit(engine, 0.8));
  cases::step(engine);
  const Energies e0 = engine.energies();
  const double start = e0.kinetic + e0.elastic;
  Drift drift;
  for (int n = 1; n < steps; ++n) {
    cases::step(engine);
    if (n % 50 != 0 && n + 1 != steps)
      continue;
    const Energies e = engine.energies();
    drift.at_end = (e.kinetic + e.elastic - e.external_work - start) / start;
    drift.largest = std::max(drift.largest, std::abs(drift.at_end));
  }
  return drift;
}

// 1/2 v^(n-1/2) . M v^(n+1/2) + 1/2 u . K u is constant for a linear body in exact arithmetic.
// Rounding is a random walk of about 1e-16 a step, 3e-14 after 1e5 steps; 1e-12 leaves room. The
// bodies are held somewhere: one that travels far keeps fewer digits of its strain.
TEST(FemEnergy, of_a_linear_body_drifts_by_less_than_1e_12_in_1e5_steps) {
  const BoxMesh<2> box{.size = {16e-3, 2e-3}, .count = {16, 2}};
  Mesh<2> mesh = make_box(box);
  cases::distort(mesh, box, 0.2);
  const InitialPulse pulse{
      .amplitude = 1e-7, .center = 8e-3, .length = 10e-3, .wave_speed = 2000.0};
  Engine<2> engine(mesh, {.materials = cases::of<2>(rock),
                          .boundary = {cases::held<2>("right", {true, true}),
                                       cases::held<2>("bottom", {false, true})},
                          .initial = {cases::started<2>(pulse)}});
  engine.set_weights(cases::ramp(mesh, -1e-3, 5e-3));
  const Drift result = drift(engine, 100000);
  verify({"drift of the energy of quad4 over 1e5 steps", "invariant of central differences", 1e-12,
          "rounding is a random walk, 3e-14"},
         result.largest);
  std::printf("  quad4: largest drift %.1e, at the end %+.1e\n", result.largest, result.at_end);
}

TEST(FemEnergy, of_a_linear_block_of_hex8_drifts_by_less_than_1e_12_in_1e5_steps) {
  const InitialPulse pulse{
      .amplitude = 1e-7, .center = 1e-3, .length = 3e-3, .wave_speed = 2000.0, .component = 1};
  Engine<3> engine(cases::distorted_box<3>(),
                   {.materials = cases::of<3>(rock),
                    .boundary = {cases::held<3>("left", {true, true, true})},
                    .initial = {cases::started<3>(pulse)}});
  const Drift result = drift(engine, 100000);
  verify({"drift of the energy of hex8 over 1e5 steps", "invariant of central differences", 1e-12,
          "rounding is a random walk, 3e-14"},
         result.largest);
  std::printf("  hex8: largest drift %.1e, at the end %+.1e\n", result.largest, result.at_end);
}

} // namespace
} // namespace kerf::fem
