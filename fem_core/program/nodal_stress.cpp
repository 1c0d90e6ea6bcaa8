#include "fem_core/program/nodal_stress.hpp"

#include "fem_core/element.hpp"

#include <fmt/format.h>

namespace kerf::fem {
namespace {

/// m³; m² in 2D; of the whole ring in axisymmetry.
template <int dim> double volume_of(const Engine<dim>& engine, std::uint32_t element) {
  const bool is_ring = engine.settings().plane == Plane::axisymmetric;
  double volume = 0.0;
  for (const ElementPoint<dim>& point : points_of<dim>({.shape = engine.mesh().shape_of(element),
                                        .space = is_ring ? Space::axisymmetric : Space::plane,
                                        .corners = engine.mesh().corners(element),
                                        .alpha = {}}))
    volume += point.volume;
  return volume;
}

} // namespace

template <int dim>
std::vector<NodalStress> stress_at_nodes(const Engine<dim>& engine,
                                         std::span<const double> stress) {
  constexpr std::size_t components = Symmetric<double, dim>::size;
  const std::size_t num_nodes = engine.mesh().num_nodes();
  const std::size_t num_materials = engine.settings().materials.size();
  std::vector<NodalStress> fields;
  std::vector<std::vector<double>> volume(num_materials, std::vector<double>(num_nodes));
  for (std::size_t k = 0; k < num_materials; ++k)
    fields.push_back({num_materials == 1 ? "stress_at_nodes" : fmt::format("stress_at_nodes_{}", k),
                      std::vector<double>(num_nodes * components)});

  for (const std::uint32_t e : engine.active_elements()) {
    const std::size_t k = engine.material_of(e);
    const double of_element = volume_of(engine, e);
    for (const std::size_t node : engine.mesh().nodes_of_element(e)) {
      volume[k][node] += of_element;
      for (std::size_t c = 0; c < components; ++c)
        fields[k].values[node * components + c] += of_element * stress[e * components + c];
    }
  }
  for (std::size_t k = 0; k < num_materials; ++k)
    for (std::size_t node = 0; node < num_nodes; ++node)
      if (volume[k][node] > 0.0)
        for (std::size_t c = 0; c < components; ++c)
          fields[k].values[node * components + c] /= volume[k][node];
  return fields;
}

template std::vector<NodalStress> stress_at_nodes<2>(const Engine<2>&, std::span<const double>);
template std::vector<NodalStress> stress_at_nodes<3>(const Engine<3>&, std::span<const double>);

} // namespace kerf::fem
