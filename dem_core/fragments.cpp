#include "dem_core/fragments.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace kerf::dem {

namespace {

/// Sets that are joined; each is known by one of its members, the root.
class DisjointSets {
public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t root_of(std::uint32_t i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) {
    const auto [low, high] = std::minmax({root_of(i), root_of(j)});
    parent_[high] = low;
  }

private:
  std::vector<std::uint32_t> parent_;
};

} // namespace

double Fragments::largest_share() const {
  return volume.front() / std::accumulate(volume.begin(), volume.end(), 0.0);
}

template <int dim>
Fragments find_fragments(const Contacts<dim>& contacts, const Particles<dim>& particles) {
  const auto count = static_cast<std::uint32_t>(particles.size());
  DisjointSets sets(count);
  for (std::size_t k = 0; k < contacts.size(); ++k)
    if (contacts.bonded[k])
      sets.join(contacts.first[k], contacts.second[k]);

  std::vector<std::uint32_t> first_of; // member of each cluster, and one more
  for (std::uint32_t i = 0; i < count; ++i)
    if (particles.is_member(i)) {
      const std::uint32_t cluster = particles.cluster[i];
      first_of.resize(std::max<std::size_t>(first_of.size(), cluster + 1), count);
      first_of[cluster] = std::min(first_of[cluster], i);
      sets.join(first_of[cluster], i);
    }

  struct Piece {
    double volume = 0.0;
    std::uint32_t least_id = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t root = 0;
  };
  std::vector<Piece> pieces(count); // of each root
  for (std::uint32_t i = 0; i < count; ++i) {
    Piece& piece = pieces[sets.root_of(i)];
    piece.volume += volume_of_radius<dim>(particles.radius[i]);
    piece.least_id = std::min(piece.least_id, particles.ids[i]);
  }
  for (std::uint32_t i = 0; i < count; ++i)
    pieces[i].root = i;
  std::erase_if(pieces, [](const Piece& piece) { return piece.volume == 0.0; });
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return a.volume != b.volume ? a.volume > b.volume : a.least_id < b.least_id;
  });

  Fragments fragments;
  std::vector<std::uint32_t> number(count); // of each root
  for (const Piece& piece : pieces) {
    number[piece.root] = static_cast<std::uint32_t>(fragments.volume.size());
    fragments.volume.push_back(piece.volume);
  }
  fragments.of.resize(count);
  for (std::uint32_t i = 0; i < count; ++i)
    fragments.of[i] = number[sets.root_of(i)];
  return fragments;
}

template Fragments find_fragments<2>(const Contacts<2>&, const Particles<2>&);
template Fragments find_fragments<3>(const Contacts<3>&, const Particles<3>&);

} // namespace kerf::dem
