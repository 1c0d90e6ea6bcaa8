// The pieces of a body: particles that are joined by bonds which hold.
#pragma once

#include "dem_core/contact.hpp"
#include "dem_core/particles.hpp"

#include <cstdint>
#include <vector>

namespace kerf::dem {

/// Fragments are numbered from the largest by solid volume to the smallest; of equal ones the one
/// with the smallest id comes first. A particle without bonds is a fragment, too.
struct Fragments {
  std::vector<std::uint32_t> of; // [n] number of the fragment of each particle
  std::vector<double> volume;    // of each fragment, descending, m³ (m² in 2D)

  std::size_t count() const noexcept { return volume.size(); }
  double largest_share() const; // of the largest in the volume of all
};

template <int dim>
Fragments find_fragments(const Contacts<dim>& contacts, const Particles<dim>& particles);

} // namespace kerf::dem
