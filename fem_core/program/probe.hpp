// Points of a body that a case asks to watch.
#pragma once

#include "fem_core/element.hpp"
#include "fem_core/engine.hpp"
#include "fem_core/program/table.hpp"

#include <string>
#include <vector>

namespace kerf::fem {

/// A point inside of an element.
template <int dim> struct Probe {
  std::string name;
  std::uint32_t element = 0;
  CornerValues N; // shape functions there
};

/// @throws coupler::SettingsError for a point that is in no element of the mesh
template <int dim>
std::vector<Probe<dim>> read_probes(const std::vector<Table>& list, const Mesh<dim>& mesh);

/// What the nodes of its element have, interpolated.
/// @param values  [num_nodes][dim]
template <int dim>
Vec<dim> at_probe(const Probe<dim>& probe, const Mesh<dim>& mesh, std::span<const double> values);

/// [num_nodes][dim] u^n since the last reset, after the step that began there, m
template <int dim>
std::vector<double> displacement_of_step(const Engine<dim>& engine, double time_step);

/// Mean stress of its element, Pa; not a number when it has been removed.
template <int dim> Symmetric<double, dim> stress_at(const Probe<dim>& probe, const Engine<dim>&);

} // namespace kerf::fem
