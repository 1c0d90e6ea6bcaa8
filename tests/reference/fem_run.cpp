// Small bodies of one shape in every formulation that another code can state, for comparison:
//
//     fem_run SHAPE > RUNS.json
//
// Each run has what it starts from and the displacement at its end.
#include "fem_core/input_error.hpp"
#include "tests/cases/fem_bodies.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <stdexcept>

namespace kerf::fem {
namespace {

using cases::rock;
using nlohmann::json;

constexpr double yield_stress = 20e6, hardening_modulus = 500e6; // Pa

struct Run {
  std::string law; // elastic, neo_hookean or j2
  bool finite_strain = false;
  std::string plane = "strain";     // stress, axisymmetric
  std::string formulation = "full"; // mean_dilatation, one_point
};

std::vector<Run> runs_of(Shape shape) {
  std::vector<Run> runs = {{.law = "elastic"},
                           {.law = "neo_hookean"},
                           {.law = "j2"},
                           {.law = "j2", .finite_strain = true}};
  const bool plane = dimension_of(shape) == 2;
  if (plane) {
    runs.push_back({.law = "elastic", .plane = "stress"});
    for (const char* law : {"elastic", "neo_hookean"})
      runs.push_back({.law = law, .plane = "axisymmetric"});
    runs.push_back({.law = "j2", .finite_strain = true, .plane = "axisymmetric"});
  }
  if (shape == Shape::quad4 || shape == Shape::hex8) {
    runs.push_back({.law = "elastic", .formulation = "mean_dilatation"});
    runs.push_back({.law = "j2", .finite_strain = true, .formulation = "mean_dilatation"});
    runs.push_back({.law = "elastic", .formulation = "one_point"});
    runs.push_back({.law = "j2", .finite_strain = true, .formulation = "one_point"});
  }
  if (shape == Shape::quad4)
    runs.push_back({.law = "j2",
                    .finite_strain = true,
                    .plane = "axisymmetric",
                    .formulation = "mean_dilatation"});
  return runs;
}

Law law_of(const Run& run) {
  if (run.law == "elastic")
    return rock;
  if (run.law == "neo_hookean")
    return NeoHookean::from(rock);
  return J2Plastic::from(rock, Hardening::linear(yield_stress, hardening_modulus));
}

/// Some 10 % of strain: a smooth field of 5 % of the speed of compression waves, while one side is
/// sheared off.
template <int dim> json result_of(Shape shape, const Run& run) {
  const double c = std::sqrt(rock.moduli.uniaxial() / rock.density); // m/s
  const bool ring = run.plane == "axisymmetric";
  Mesh<dim> mesh = cases::distorted_box<dim>(shape);
  for (std::size_t a = 0; ring && a < mesh.num_nodes(); ++a)
    mesh.positions[a * dim] += 5e-3;
  BoundarySetting<dim> side = cases::held<dim>("left", {});
  side.components.fill(true);
  side.motion = Motion::velocity;
  side.velocity = Vec<dim>::Unit(1) * 0.02 * c;
  Material material{.law = law_of(run),
                    .finite_strain = run.finite_strain,
                    .formulation = run.formulation == "full"        ? Formulation::full
                                   : run.formulation == "one_point" ? Formulation::one_point
                                                                    : Formulation::mean_dilatation};
  material.hourglass_stiffness = 0.0; // another code has another control
  Engine<dim> engine(mesh, {.materials = {{.material = material, .region = {}, .box = {}}},
                            .plane = ring                    ? Plane::axisymmetric
                                     : run.plane == "stress" ? Plane::stress
                                                             : Plane::strain,
                            .boundary = {side}});

  std::vector<double> velocity(mesh.positions.size());
  for (std::size_t k = 0; k < velocity.size(); ++k) {
    const Vec<dim> X = mesh.position(k / dim) / 4e-3;
    velocity[k] = 0.05 * c * std::sin(2.0 * X.sum() + static_cast<double>(k % dim) + X[0] * X[1]);
  }
  const double time_step = 0.5 * 2.0 / std::sqrt(engine.step_limit().omega2);
  const int steps = 200;
  engine.start(time_step);
  engine.set_motion(std::vector<double>(velocity.size()), velocity);
  for (int n = 0; n < steps; ++n)
    engine.integrate();
  return {{"shape", name_of(shape)},
          {"law", run.law},
          {"finite_strain", run.finite_strain},
          {"plane", run.plane},
          {"formulation", run.formulation},
          {"density", rock.density},
          {"lambda", rock.moduli.lambda},
          {"mu", rock.moduli.mu},
          {"yield_stress", yield_stress},
          {"hardening_modulus", hardening_modulus},
          {"dimension", dim},
          {"positions", mesh.positions},
          {"cells", mesh.blocks[0].nodes},
          {"moved", nodes_with_tag(mesh, "left", "tag")},
          {"moved_velocity", std::vector<double>(side.velocity.begin(), side.velocity.end())},
          {"velocity", velocity},
          {"time_step", time_step},
          {"steps", steps},
          {"displacement", engine.displacement()}};
}

} // namespace
} // namespace kerf::fem

int main(int argc, char** argv) try {
  using namespace kerf::fem;
  for (const Shape shape : {Shape::tri3, Shape::quad4, Shape::tet4, Shape::hex8}) {
    if (argc != 2 || name_of(shape) != argv[1])
      continue;
    nlohmann::json results;
    for (const Run& run : runs_of(shape))
      results.push_back(dimension_of(shape) == 2 ? result_of<2>(shape, run)
                                                 : result_of<3>(shape, run));
    std::puts(results.dump().c_str());
    return 0;
  }
  throw std::invalid_argument("give one shape: tri3, quad4, tet4 or hex8");
} catch (const std::exception& error) {
  std::fprintf(stderr, "fem_run: %s\n", error.what());
  return 2;
}
