#include "dem_core/spatial_order.hpp"

#include "common/spatial_order.hpp"

namespace kerf::dem {

template <int dim> void put_in_spatial_order(Settings<dim>& settings) {
  const std::vector<std::uint32_t> order = spatial_order<dim>(settings.positions);
  const auto arranged = [&](const auto& values) {
    auto result = values;
    for (std::size_t k = 0; k < order.size(); ++k)
      result[k] = values[order[k]];
    return result;
  };
  settings.positions = arranged(settings.positions);
  settings.radii = arranged(settings.radii);
  if (!settings.material_of.empty())
    settings.material_of = arranged(settings.material_of);
  settings.ids = settings.ids.empty() ? order : arranged(settings.ids);
}

template void put_in_spatial_order<2>(Settings<2>&);
template void put_in_spatial_order<3>(Settings<3>&);

} // namespace kerf::dem
