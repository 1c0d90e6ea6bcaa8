// The finite element models that are timed.
#pragma once

#include "fem_core/engine.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace kerf::benchmarks {

struct FemWorkload {
  std::string name;
  fem::Shape shape = fem::Shape::hex8;
  fem::Formulation formulation = fem::Formulation::full;
  std::size_t elements = 0;
};

/// By the names of the performance page.
std::span<const FemWorkload> fem_workloads();

/// What a workload is made of: rock with lambda = mu.
/// total_strain: small strain, through a law that is called at every point, a layered rock with the
///               constants of the isotropic one
/// linear:       small strain, by the fastest way the engine has for it
/// neo_hookean:  finite strain from the reference configuration
/// j2, j2_finite: linear hardening, small strain and strain rates; the waves make it flow
inline constexpr std::array<const char*, 5> fem_laws = {"total_strain", "linear", "neo_hookean",
                                                        "j2", "j2_finite"};

/// A law of fem_laws; everything is of it.
/// @throws std::invalid_argument for another name
template <int dim>
fem::Settings<dim> settings_of(const FemWorkload& workload, const std::string& law);

/// Edge of the cubic or square cells that the elements are cut from, m.
inline constexpr double cell_edge = 1e-3;

/// A distorted cube or square with about so many elements, with free faces. Its elements lie along
/// a Morton curve, its nodes where the first of them has them: a fair start for every code.
template <int dim> fem::Mesh<dim> mesh_of(fem::Shape shape, std::size_t elements);

/// Where the waves begin: a velocity for every node, sines of a length of eight cells along every
/// axis, of compression and of shear.
/// @return [num_nodes][dim] m/s
template <int dim> std::vector<double> velocity_of(const fem::Mesh<dim>& mesh);

/// A tenth of the time in which a wave of compression crosses a cell, s; below what is stable for
/// every workload.
double fem_time_step();

/// The body at its start.
template <int dim>
fem::Engine<dim> engine_of(const FemWorkload& workload, const std::string& law,
                           const fem::Mesh<dim>& mesh);

} // namespace kerf::benchmarks
