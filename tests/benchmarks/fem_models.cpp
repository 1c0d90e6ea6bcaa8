#include "tests/benchmarks/fem_models.hpp"

#include "common/spatial_order.hpp"
#include "fem_core/mesh/box.hpp"
#include "tests/cases/fem_bodies.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace kerf::benchmarks {
namespace {

constexpr double strain = 3e-3;     // of the waves
constexpr double distortion = 0.15; // of the cells; folds no element
const auto& rock = cases::rock;     // lambda = mu

const std::array<FemWorkload, 5> workloads = {
    {{"hex8", fem::Shape::hex8, fem::Formulation::full, 100'000},
     {"hex8_one_point", fem::Shape::hex8, fem::Formulation::one_point, 100'000},
     {"tet4", fem::Shape::tet4, fem::Formulation::full, 300'000},
     {"tri3", fem::Shape::tri3, fem::Formulation::full, 205'000},
     {"quad4", fem::Shape::quad4, fem::Formulation::full, 102'000}}};

int elements_of_cell(fem::Shape shape) {
  return shape == fem::Shape::tet4 ? 6 : shape == fem::Shape::tri3 ? 2 : 1;
}

fem::Law law_of(const std::string& name, int dim) {
  if (name == "total_strain") {
    const double poisson = 0.5 * rock.moduli.lambda / (rock.moduli.lambda + rock.moduli.mu);
    return fem::TransverselyIsotropic::from({.density = rock.density,
                                             .young_in_plane = rock.moduli.young(),
                                             .young_normal = rock.moduli.young(),
                                             .poisson_in_plane = poisson,
                                             .poisson_normal = poisson,
                                             .shear_normal = rock.moduli.mu},
                                            dim);
  }
  if (name == "linear")
    return rock;
  if (name == "neo_hookean")
    return fem::NeoHookean::from(rock);
  if (name == "j2" || name == "j2_finite") // flows from a third of the largest shear on
    return fem::J2Plastic::from(
        rock, fem::Hardening::linear(std::numbers::sqrt3 * rock.moduli.mu * strain / 3.0,
                                     0.1 * rock.moduli.young()));
  throw std::invalid_argument(fmt::format("there is no law {}", name));
}

template <int dim> fem::Mesh<dim> in_spatial_order(const fem::Mesh<dim>& mesh) {
  constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  std::vector<Vec<dim>> centres;
  for (std::size_t e = 0; e < mesh.num_elements(); ++e)
    centres.emplace_back(mesh.corners(e).rowwise().mean());
  fem::Mesh<dim> ordered;
  ordered.blocks = {{.shape = mesh.blocks.front().shape, .nodes = {}}};
  std::vector<std::uint32_t> number(mesh.num_nodes(), none);
  for (const std::uint32_t e : spatial_order<dim>(centres))
    for (const std::uint32_t a : mesh.nodes_of_element(e)) {
      if (number[a] == none) {
        number[a] = static_cast<std::uint32_t>(ordered.num_nodes());
        const double* const X = &mesh.positions[std::size_t{a} * dim];
        ordered.positions.insert(ordered.positions.end(), X, X + dim);
      }
      ordered.blocks.front().nodes.push_back(number[a]);
    }
  return ordered;
}

} // namespace

std::span<const FemWorkload> fem_workloads() {
  return workloads;
}

template <int dim>
fem::Settings<dim> settings_of(const FemWorkload& workload, const std::string& law) {
  return {.materials = cases::of<dim>(law_of(law, dim), workload.formulation, law == "j2_finite")};
}

template <int dim> fem::Mesh<dim> mesh_of(fem::Shape shape, std::size_t elements) {
  const double cells = static_cast<double>(elements) / elements_of_cell(shape);
  const auto along_axis = static_cast<std::uint32_t>(std::lround(std::pow(cells, 1.0 / dim)));
  fem::BoxMesh<dim> box;
  box.shape = shape;
  box.count.fill(along_axis);
  box.size = Vec<dim>::Constant(along_axis * cell_edge);
  fem::Mesh<dim> mesh = fem::make_box(box);
  cases::distort(mesh, box, distortion);
  return in_spatial_order(mesh);
}

template <int dim> std::vector<double> velocity_of(const fem::Mesh<dim>& mesh) {
  constexpr double wave_number = 2.0 * std::numbers::pi / (8.0 * cell_edge); // 1/m
  const double shear_speed = std::sqrt(rock.moduli.mu / rock.density);       // m/s
  std::vector<double> velocity;
  for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
    for (int i = 0; i < dim; ++i) {
      const Vec<dim> phase = wave_number * mesh.position(a);
      velocity.push_back(strain * shear_speed *
                         (0.5 * std::sin(phase[i]) + std::sin(phase[(i + 1) % dim])));
    }
  return velocity;
}

double fem_time_step() {
  return 0.1 * cell_edge / std::sqrt(rock.moduli.uniaxial() / rock.density);
}

template <int dim>
fem::Engine<dim> engine_of(const FemWorkload& workload, const std::string& law,
                           const fem::Mesh<dim>& mesh) {
  fem::Engine<dim> engine(mesh, settings_of<dim>(workload, law));
  engine.start(fem_time_step());
  engine.set_motion(std::vector<double>(mesh.positions.size()), velocity_of<dim>(mesh));
  return engine;
}

template fem::Settings<2> settings_of(const FemWorkload&, const std::string&);
template fem::Mesh<2> mesh_of(fem::Shape, std::size_t);
template std::vector<double> velocity_of(const fem::Mesh<2>&);
template fem::Engine<2> engine_of(const FemWorkload&, const std::string&, const fem::Mesh<2>&);
template fem::Settings<3> settings_of(const FemWorkload&, const std::string&);
template fem::Mesh<3> mesh_of(fem::Shape, std::size_t);
template std::vector<double> velocity_of(const fem::Mesh<3>&);
template fem::Engine<3> engine_of(const FemWorkload&, const std::string&, const fem::Mesh<3>&);

} // namespace kerf::benchmarks
