// The list of contacts: which pairs it holds, in which order, and how it is made again.
#include "dem_core/contact.hpp"
#include "dem_core/contact_constants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace kerf::dem {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Of two centres at the start, over the sum of the radii. Irregular packings of bonded rock
/// overlap a little, which their bonds forget; more is a mistake of the user.
constexpr double least_distance = 0.5;

/// A contact to be, and the one of the old list that it continues.
struct Entry {
  Pair pair;
  std::uint32_t old = none;
};

/// The contacts that a block is to have, in the order of the list.
struct BlockList {
  struct Loose {
    std::vector<Entry> touching, apart;
  };
  std::vector<Entry> bonds;
  Loose linear, hertzian;
  std::uint32_t waiting = 0; // of them, with a second particle in another block

  Loose& loose(const Mixture& mixture) { return mixture.is_hertzian() ? hertzian : linear; }
  std::array<const std::vector<Entry>*, 5> parts() const {
    return {&bonds, &linear.touching, &linear.apart, &hertzian.touching, &hertzian.apart};
  }
};

std::size_t block_of(std::uint32_t particle) {
  return particle / particles_per_block;
}

template <int dim>
std::vector<Pair> pairs_within(const Particles<dim>& particles, double reach,
                               const Period<dim>& period) {
  std::vector<Vec<dim>> position(particles.size());
  const auto count = static_cast<std::int64_t>(particles.size());
#pragma omp parallel for schedule(static) if (count > particles_per_block)
  for (std::int64_t i = 0; i < count; ++i)
    position[i] = particles.position(i);
  std::vector<Pair> pairs = find_pairs<dim>(position, particles.radius, reach, period);
  if (!particles.cluster.empty()) // members of one body do not touch
    std::erase_if(pairs, [&](const Pair& pair) {
      return particles.cluster[pair.first] != 0 &&
             particles.cluster[pair.first] == particles.cluster[pair.second];
    });
  return pairs;
}

/// Calls fill(list, pairs of the block) for every block.
template <class Fill>
std::vector<BlockList> make_lists(std::size_t particles, std::span<const Pair> pairs, Fill fill) {
  std::vector<BlockList> lists((particles + particles_per_block - 1) / particles_per_block);
  const auto from = [&](std::size_t block) {
    const Pair least{static_cast<std::uint32_t>(block * particles_per_block), 0};
    return std::lower_bound(pairs.begin(), pairs.end(), least);
  };
  const auto blocks = static_cast<std::int64_t>(lists.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t b = 0; b < blocks; ++b) {
    fill(b, lists[b], std::span(from(b), from(b + 1)));
    for (const auto* part : lists[b].parts())
      for (const Entry& entry : *part)
        lists[b].waiting += block_of(entry.pair.second) != static_cast<std::size_t>(b);
  }
  return lists;
}

template <int dim> void resize(Contacts<dim>& c, std::size_t count) {
  c.first.resize(count);
  c.second.resize(count);
  c.target.resize(count);
  c.reference_branch.resize(count);
  c.rest_length.resize(count);
  c.share.resize(count);
  c.bonded.resize(count);
  c.normal_force.resize(count);
  c.shear_force.resize(count);
  if (c.has_moments)
    c.moment.resize(count);
}

/// A pair without bond or history; it is free of stress when the surfaces just touch.
template <int dim>
void set_new(Contacts<dim>& c, std::size_t k, Pair pair, const Particles<dim>& p,
             const Period<dim>& period) {
  const auto [i, j] = pair;
  const Vec<dim> relative = p.displacement[j] - p.displacement[i];
  c.reference_branch.set(k, period.shortest(p.reference[j] - p.reference[i] + relative) - relative);
  c.rest_length[k] = p.radius[i] + p.radius[j];
  c.share[k] = p.radius[i] / (p.radius[i] + p.radius[j]);
  c.bonded[k] = 0;
  c.normal_force[k] = 0.0;
  c.shear_force.set(k, Rot<dim>::Zero());
  if (c.has_moments)
    c.moment.set(k, Rot<dim>::Zero());
}

/// Contact `old` of another list with all its history.
template <int dim>
void set_copy(Contacts<dim>& c, std::size_t k, const Contacts<dim>& from, std::size_t old) {
  c.reference_branch.set(k, from.reference_branch[old]);
  c.rest_length[k] = from.rest_length[old];
  c.share[k] = from.share[old];
  c.bonded[k] = from.bonded[old];
  c.normal_force[k] = from.normal_force[old];
  c.shear_force.set(k, from.shear_force[old]);
  if (c.has_moments)
    c.moment.set(k, from.moment[old]);
}

/// Which block owns what, and where loads wait; the contacts themselves are still to be filled.
template <int dim>
void set_blocks(Contacts<dim>& c, std::span<const BlockList> lists, std::size_t particles) {
  c.block_offset.assign(1, 0);
  c.loose_offset.clear();
  c.hertz_offset.clear();
  c.waiting_offset.assign(1, static_cast<std::uint32_t>(particles));
  for (const BlockList& list : lists) {
    std::size_t end = c.block_offset.back();
    c.loose_offset.push_back(static_cast<std::uint32_t>(end += list.bonds.size()));
    end += list.linear.touching.size() + list.linear.apart.size();
    c.hertz_offset.push_back(static_cast<std::uint32_t>(end));
    end += list.hertzian.touching.size() + list.hertzian.apart.size();
    c.block_offset.push_back(static_cast<std::uint32_t>(end));
    c.waiting_offset.push_back(c.waiting_offset.back() + list.waiting);
  }
  c.losses.resize(lists.size());
  resize(c, c.block_offset.back());
}

/// What the blocks receive from one another, in the order of the contacts.
template <int dim> void set_incoming(Contacts<dim>& c) {
  c.incoming_offset.assign(c.blocks() + 1, 0);
  for (std::size_t k = 0; k < c.size(); ++k)
    if (c.target[k] != c.second[k])
      ++c.incoming_offset[block_of(c.second[k]) + 1];
  std::partial_sum(c.incoming_offset.begin(), c.incoming_offset.end(), c.incoming_offset.begin());
  c.incoming_row.resize(c.incoming_offset.back());
  c.incoming_second.resize(c.incoming_offset.back());
  std::vector<std::uint32_t> next(c.incoming_offset.begin(), c.incoming_offset.end() - 1);
  for (std::size_t k = 0; k < c.size(); ++k)
    if (c.target[k] != c.second[k]) {
      const std::uint32_t at = next[block_of(c.second[k])]++;
      c.incoming_row[at] = c.target[k];
      c.incoming_second[at] = c.second[k];
    }
}

/// Fills a list; set(k, entry) gives contact k all but its place.
template <int dim, class Set>
void fill(Contacts<dim>& c, std::span<const BlockList> lists, std::size_t particles, Set set) {
  set_blocks(c, lists, particles);
  const auto blocks = static_cast<std::int64_t>(lists.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t b = 0; b < blocks; ++b) {
    std::uint32_t k = c.block_offset[b], row = c.waiting_offset[b];
    for (const auto* part : lists[b].parts())
      for (const Entry& entry : *part) {
        const auto [i, j] = entry.pair;
        c.first[k] = i;
        c.second[k] = j;
        c.target[k] = block_of(j) == static_cast<std::size_t>(b) ? j : row++;
        set(k++, entry);
      }
  }
  set_incoming(c);
}

/// The contacts of a block in ascending order of their pairs.
template <int dim> std::vector<Entry> ascending(const Contacts<dim>& c, std::size_t block) {
  const std::uint32_t begin = c.block_offset[block], end = c.block_offset[block + 1];
  std::vector<Entry> entries(end - begin);
  for (std::uint32_t k = begin; k < end; ++k)
    entries[k - begin] = {{c.first[k], c.second[k]}, k};
  const auto less = [](const Entry& a, const Entry& b) { return a.pair < b.pair; };
  const auto all = entries.end(); // the parts of the list ascend
  for (auto part = std::is_sorted_until(entries.begin(), all, less); part != all;) {
    const auto next = std::is_sorted_until(part, all, less);
    std::inplace_merge(entries.begin(), part, next, less);
    part = next;
  }
  return entries;
}

} // namespace

template <int dim>
Contacts<dim> make_contacts(const Particles<dim>& particles, const Materials& materials,
                            std::optional<double> gap_tolerance, double skin,
                            const Period<dim>& period) {
  const double largest = *std::max_element(particles.radius.begin(), particles.radius.end());
  const double reach = std::max(skin, gap_tolerance.value_or(0.0) * 2.0 * largest);
  const std::vector<Pair> pairs = pairs_within(particles, reach, period);
  const auto distance_of = [&](Pair pair) {
    return period.shortest(particles.reference[pair.second] - particles.reference[pair.first])
        .norm();
  };
  for (const Pair pair : pairs) {
    const auto [i, j] = pair;
    const double contact_distance = particles.radius[i] + particles.radius[j];
    if (const double distance = distance_of(pair); distance < least_distance * contact_distance)
      throw std::invalid_argument(fmt::format(
          "the centres of particles {} and {} are {:.6g} m apart, less than half of the sum of "
          "their radii, {:.6g} m: they overlap too much",
          particles.ids[i], particles.ids[j], distance, contact_distance));
  }
  const auto lists =
      make_lists(particles.size(), pairs,
                 [&](std::size_t /*block*/, BlockList& list, std::span<const Pair> of_block) {
                   for (const Pair pair : of_block) {
                     const double contact_distance =
                         particles.radius[pair.first] + particles.radius[pair.second];
                     const double gap = distance_of(pair) - contact_distance;
                     const Mixture& mixture = materials.between(particles, pair.first, pair.second);
                     BlockList::Loose& loose = list.loose(mixture);
                     if (gap_tolerance && mixture.bonds && gap <= *gap_tolerance * contact_distance)
                       list.bonds.push_back({pair});
                     else if (gap <= skin)
                       (gap < 0.0 ? loose.touching : loose.apart).push_back({pair});
                   }
                 });
  Contacts<dim> c;
  c.law = materials.linear_law();
  c.has_moments = c.law != ContactLaw::linear || materials.has_hertzian();
  fill(c, lists, particles.size(),
       [&](std::size_t k, const Entry& entry) { set_new(c, k, entry.pair, particles, period); });
  for (std::size_t k = 0; k < c.size(); ++k)
    if (c.was_bonded(k)) {
      c.bonded[k] = 1;
      c.rest_length[k] = c.reference_branch[k].norm();
    }
  c.weight.set_all(1.0);
  set_constants(c, particles, materials);
  return c;
}

template <int dim>
void renew_contacts(Contacts<dim>& contacts, const Particles<dim>& particles,
                    const Materials& materials, double skin, const Period<dim>& period) {
  const std::vector<Pair> pairs = pairs_within(particles, skin, period);
  const auto lists = make_lists(
      particles.size(), pairs,
      [&](std::size_t block, BlockList& list, std::span<const Pair> of_block) {
        const auto loose = [&](Pair of) -> BlockList::Loose& {
          return list.loose(materials.between(particles, of.first, of.second));
        };
        auto pair = of_block.begin();
        for (const Entry& entry : ascending(contacts, block)) {
          for (; pair != of_block.end() && *pair < entry.pair; ++pair)
            loose(*pair).apart.push_back({*pair});
          const bool is_near = pair != of_block.end() && *pair == entry.pair;
          if (is_near)
            ++pair;
          const std::uint32_t k = entry.old;
          if (contacts.was_bonded(k) || contacts.bonded[k])
            list.bonds.push_back(entry);
          else if (is_near)
            (contacts.normal_force[k] != 0.0 ? loose(entry.pair).touching : loose(entry.pair).apart)
                .push_back(entry);
        }
        for (; pair != of_block.end(); ++pair)
          loose(*pair).apart.push_back({*pair});
      });
  Contacts<dim> renewed;
  renewed.law = contacts.law;
  renewed.has_moments = contacts.has_moments;
  fill(renewed, lists, particles.size(), [&](std::size_t k, const Entry& entry) {
    if (entry.old == none)
      set_new(renewed, k, entry.pair, particles, period);
    else
      set_copy(renewed, k, contacts, entry.old);
  });
  renewed.losses = contacts.losses;
  set_constants(renewed, particles, materials);
  renewed.weight.set_all(1.0);
  if (!contacts.weight.is_uniform())
    blend(renewed, particles);
  contacts = std::move(renewed);
}

template Contacts<2> make_contacts<2>(const Particles<2>&, const Materials&, std::optional<double>,
                                      double, const Period<2>&);
template Contacts<3> make_contacts<3>(const Particles<3>&, const Materials&, std::optional<double>,
                                      double, const Period<3>&);
template void renew_contacts<2>(Contacts<2>&, const Particles<2>&, const Materials&, double,
                                const Period<2>&);
template void renew_contacts<3>(Contacts<3>&, const Particles<3>&, const Materials&, double,
                                const Period<3>&);

} // namespace kerf::dem
