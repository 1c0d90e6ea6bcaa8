#include "fem_core/mass.hpp"

namespace kerf::fem {

template <int dim>
NodeValues<dim> element_mass(const Elements<dim>& elements, std::size_t element, double density) {
  NodeValues<dim> mass = NodeValues<dim>::Zero();
  for (int q = 0; q < gauss_points<dim>; ++q)
    mass += density * elements.volume_at(element, q) * shape_functions<dim>(gauss_rule<dim>()[q]);
  return mass;
}

template <int dim> std::vector<double> lumped_mass(const Elements<dim>& elements, double density) {
  std::vector<double> mass(elements.num_nodes(), 0.0);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const NodeValues<dim> of_element = element_mass(elements, e, density);
    for (int a = 0; a < element_nodes<dim>; ++a)
      mass[elements.nodes[e * element_nodes<dim> + static_cast<std::size_t>(a)]] += of_element[a];
  }
  return mass;
}

template NodeValues<2> element_mass<2>(const Elements<2>&, std::size_t, double);
template NodeValues<3> element_mass<3>(const Elements<3>&, std::size_t, double);
template std::vector<double> lumped_mass<2>(const Elements<2>&, double);
template std::vector<double> lumped_mass<3>(const Elements<3>&, double);

} // namespace kerf::fem
