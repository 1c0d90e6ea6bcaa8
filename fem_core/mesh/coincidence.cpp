#include "fem_core/mesh/coincidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace kerf::fem {
namespace {

struct Entry {
  std::uint64_t cell; // hashed: two cells may share it, which costs a comparison
  std::uint32_t node;
  auto operator<=>(const Entry&) const = default;
};

template <int dim> std::uint64_t hash(const Vec<dim>& cell) {
  std::uint64_t value = 0;
  for (int a = 0; a < dim; ++a) {
    value ^= static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[a]));
    value *= 0xbf58476d1ce4e5b9u; // of splitmix64, mixes low bits into high ones
    value ^= value >> 29;
  }
  return value;
}

} // namespace

template <int dim>
std::optional<std::pair<std::uint32_t, std::uint32_t>>
coincident_nodes(const Mesh<dim>& mesh, double tolerance, double cell) {
  if (mesh.num_nodes() == 0)
    return std::nullopt;
  // Every node is in the cells that its surroundings touch: mostly one, and so in a regular mesh
  // whose first node is in the middle of a cell.
  const Vec<dim> origin = mesh.position(0).array() - 0.5 * cell;
  std::vector<Entry> entries;
  entries.reserve(mesh.num_nodes());
  for (std::uint32_t node = 0; node < mesh.num_nodes(); ++node) {
    const Vec<dim> x = mesh.position(node) - origin;
    const Vec<dim> lower = ((x.array() - tolerance) / cell).floor();
    const Vec<dim> upper = ((x.array() + tolerance) / cell).floor();
    for (int corner = 0; corner < (1 << dim); ++corner) {
      Vec<dim> at = lower;
      bool is_new = true;
      for (int a = 0; a < dim; ++a)
        if (corner >> a & 1) {
          is_new = is_new && upper[a] != lower[a];
          at[a] = upper[a];
        }
      if (is_new)
        entries.push_back({hash<dim>(at), node});
    }
  }
  std::sort(entries.begin(), entries.end());

  std::optional<std::pair<std::uint32_t, std::uint32_t>> first;
  for (std::size_t k = 0; k < entries.size(); ++k)
    for (std::size_t l = k + 1; l < entries.size() && entries[l].cell == entries[k].cell; ++l) {
      const std::pair pair{entries[k].node, entries[l].node};
      if (pair.first != pair.second && (!first || pair < *first) &&
          (mesh.position(pair.first) - mesh.position(pair.second)).norm() < tolerance)
        first = pair;
    }
  return first;
}

template std::optional<std::pair<std::uint32_t, std::uint32_t>> coincident_nodes<2>(const Mesh<2>&,
                                                                                    double, double);
template std::optional<std::pair<std::uint32_t, std::uint32_t>> coincident_nodes<3>(const Mesh<3>&,
                                                                                    double, double);

} // namespace kerf::fem
