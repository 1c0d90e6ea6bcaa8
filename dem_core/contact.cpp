#include "dem_core/contact.hpp"

#include "dem_core/contact_constants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

template <int dim>
std::vector<Pair> pairs_within(const Particles<dim>& particles, double reach,
                               const Period<dim>& period) {
  std::vector<Vec<dim>> position(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    position[i] = particles.position(i);
  std::vector<Pair> pairs = find_pairs<dim>(position, particles.radius, reach, period);
  if (!particles.cluster.empty()) // members of one body do not touch
    std::erase_if(pairs, [&](const Pair& pair) {
      return particles.cluster[pair.first] != 0 &&
             particles.cluster[pair.first] == particles.cluster[pair.second];
    });
  return pairs;
}

template <int dim> void resize(Contacts<dim>& c, std::size_t count) {
  c.first.resize(count);
  c.second.resize(count);
  c.reference_branch.resize(count);
  c.rest_length.resize(count);
  c.share.resize(count);
  c.bonded.resize(count);
  c.bonded_at_start.resize(count);
  c.normal_force.resize(count);
  c.shear_force.resize(count);
  if (c.law != ContactLaw::linear)
    c.moment.resize(count);
}

/// A pair without bond or history; it is free of stress when the surfaces just touch.
template <int dim>
void set_new(Contacts<dim>& c, std::size_t k, Pair pair, const Particles<dim>& p,
             const Period<dim>& period) {
  const auto [i, j] = pair;
  const Vec<dim> relative = p.displacement[j] - p.displacement[i];
  c.first[k] = i;
  c.second[k] = j;
  c.reference_branch.set(k, period.shortest(p.reference[j] - p.reference[i] + relative) - relative);
  c.rest_length[k] = p.radius[i] + p.radius[j];
  c.share[k] = p.radius[i] / (p.radius[i] + p.radius[j]);
  c.bonded[k] = 0;
  c.bonded_at_start[k] = 0;
  c.normal_force[k] = 0.0;
  c.shear_force.set(k, Rot<dim>::Zero());
  if (c.law != ContactLaw::linear)
    c.moment.set(k, Rot<dim>::Zero());
}

/// Contact `old` of another list with all its history.
template <int dim>
void set_copy(Contacts<dim>& c, std::size_t k, const Contacts<dim>& from, std::size_t old) {
  c.first[k] = from.first[old];
  c.second[k] = from.second[old];
  c.reference_branch.set(k, from.reference_branch[old]);
  c.rest_length[k] = from.rest_length[old];
  c.share[k] = from.share[old];
  c.bonded[k] = from.bonded[old];
  c.bonded_at_start[k] = from.bonded_at_start[old];
  c.normal_force[k] = from.normal_force[old];
  c.shear_force.set(k, from.shear_force[old]);
  if (c.law != ContactLaw::linear)
    c.moment.set(k, from.moment[old]);
}

/// Fills what follows from the pairs: which block owns what, and where loads wait.
template <int dim> void arrange(Contacts<dim>& c, std::size_t particles) {
  const auto block_of = [](std::uint32_t i) { return i / particles_per_block; };
  const std::size_t blocks = (particles + particles_per_block - 1) / particles_per_block;
  c.block_offset.assign(blocks + 1, 0);
  c.waiting_offset.assign(blocks + 1, 0);
  c.incoming_offset.assign(blocks + 1, 0);
  c.losses.resize(blocks);
  c.target.resize(c.size());
  auto row = static_cast<std::uint32_t>(particles);
  for (std::size_t k = 0; k < c.size(); ++k) {
    const std::uint32_t own = block_of(c.first[k]), other = block_of(c.second[k]);
    ++c.block_offset[own + 1];
    c.target[k] = c.second[k];
    if (other != own) {
      c.target[k] = row++;
      ++c.waiting_offset[own + 1];
      ++c.incoming_offset[other + 1];
    }
  }
  c.waiting_offset[0] = static_cast<std::uint32_t>(particles);
  for (std::size_t b = 0; b < blocks; ++b) {
    c.block_offset[b + 1] += c.block_offset[b];
    c.waiting_offset[b + 1] += c.waiting_offset[b];
    c.incoming_offset[b + 1] += c.incoming_offset[b];
  }
  c.incoming_row.resize(c.incoming_offset[blocks]);
  c.incoming_second.resize(c.incoming_offset[blocks]);
  std::vector<std::uint32_t> next(c.incoming_offset.begin(), c.incoming_offset.end() - 1);
  for (std::size_t k = 0; k < c.size(); ++k)
    if (c.target[k] != c.second[k]) {
      const std::uint32_t at = next[block_of(c.second[k])]++;
      c.incoming_row[at] = c.target[k];
      c.incoming_second[at] = c.second[k];
    }
}

/// The contact weight between two particles.
template <int dim> double weight_of(const Particles<dim>& p, std::uint32_t i, std::uint32_t j) {
  return bounded_share((p.radius[j] * p.weight[i] + p.radius[i] * p.weight[j]) /
                       (p.radius[i] + p.radius[j]));
}

} // namespace

template <int dim> std::size_t Contacts<dim>::bonds() const noexcept {
  return static_cast<std::size_t>(std::count(bonded.begin(), bonded.end(), std::uint8_t{1}));
}

template <int dim> double Contacts<dim>::memory() const {
  constexpr std::size_t numbers = dim + 3 + rotations<dim>;
  return static_cast<double>(size() * (numbers * sizeof(double) + 3 * sizeof(std::uint32_t) + 2) +
                             weight.each().size() * sizeof(double) +
                             waiting_rows() * 2 * sizeof(std::uint32_t));
}

template <int dim>
Contacts<dim> make_contacts(const Particles<dim>& particles, const Material& material,
                            std::optional<double> gap_tolerance, double skin,
                            const Period<dim>& period) {
  const double largest = *std::max_element(particles.radius.begin(), particles.radius.end());
  const double reach = std::max(skin, gap_tolerance.value_or(0.0) * 2.0 * largest);
  Contacts<dim> c;
  c.law = law_of(material);
  const std::vector<Pair> pairs = pairs_within(particles, reach, period);
  resize(c, pairs.size());
  std::size_t count = 0;
  for (const Pair pair : pairs) {
    const auto [i, j] = pair;
    const double contact_distance = particles.radius[i] + particles.radius[j];
    const double distance = period.shortest(particles.reference[j] - particles.reference[i]).norm();
    if (distance < least_distance * contact_distance)
      throw std::invalid_argument(fmt::format(
          "the centres of particles {} and {} are {:.6g} m apart, less than half of the sum of "
          "their radii, {:.6g} m: they overlap too much",
          particles.ids[i], particles.ids[j], distance, contact_distance));
    const bool bonded =
        gap_tolerance && distance - contact_distance <= *gap_tolerance * contact_distance;
    if (!bonded && distance - contact_distance > skin)
      continue;
    set_new(c, count, pair, particles, period);
    if (bonded) {
      c.bonded[count] = c.bonded_at_start[count] = 1;
      c.rest_length[count] = c.reference_branch[count].norm();
    }
    ++count;
  }
  resize(c, count);
  arrange(c, particles.size());
  c.weight.set_all(1.0);
  set_constants(c, particles, material);
  return c;
}

template <int dim>
void renew_contacts(Contacts<dim>& contacts, const Particles<dim>& particles,
                    const Material& material, double skin, const Period<dim>& period) {
  const std::vector<Pair> pairs = pairs_within(particles, skin, period);
  std::vector<Entry> entries;
  entries.reserve(std::max(pairs.size(), contacts.size()));
  auto pair = pairs.begin();
  for (std::uint32_t k = 0; k < contacts.size(); ++k) {
    const Pair old{contacts.first[k], contacts.second[k]};
    for (; pair != pairs.end() && *pair < old; ++pair)
      entries.push_back({*pair});
    const bool is_near = pair != pairs.end() && *pair == old;
    if (is_near)
      ++pair;
    if (is_near || contacts.bonded_at_start[k])
      entries.push_back({old, k});
  }
  for (; pair != pairs.end(); ++pair)
    entries.push_back({*pair});

  Contacts<dim> renewed;
  renewed.law = contacts.law;
  resize(renewed, entries.size());
  const auto count = static_cast<std::int64_t>(entries.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t k = 0; k < count; ++k)
    if (entries[k].old == none)
      set_new(renewed, k, entries[k].pair, particles, period);
    else
      set_copy(renewed, k, contacts, entries[k].old);
  renewed.losses = contacts.losses;
  arrange(renewed, particles.size());
  set_constants(renewed, particles, material);
  renewed.weight.set_all(1.0);
  if (!contacts.weight.is_uniform())
    blend(renewed, particles);
  contacts = std::move(renewed);
}

template <int dim> void blend(Contacts<dim>& contacts, const Particles<dim>& particles) {
  std::vector<double> weight(contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k)
    weight[k] = weight_of(particles, contacts.first[k], contacts.second[k]);
  contacts.weight.set_each(std::move(weight));
}

template <int dim> Incidence incidence(const Contacts<dim>& c, std::size_t particles) {
  Incidence result;
  result.offset.assign(particles + 1, 0);
  for (std::size_t k = 0; k < c.size(); ++k) {
    ++result.offset[c.first[k] + 1];
    ++result.offset[c.second[k] + 1];
  }
  for (std::size_t i = 0; i < particles; ++i)
    result.offset[i + 1] += result.offset[i];
  result.entry.resize(2 * c.size());
  std::vector<std::uint32_t> next(result.offset.begin(), result.offset.end() - 1);
  for (std::uint32_t k = 0; k < c.size(); ++k) {
    result.entry[next[c.first[k]]++] = 2 * k;
    result.entry[next[c.second[k]]++] = 2 * k + 1;
  }
  return result;
}

template <int dim>
ContactStiffness stiffness_of(const Contacts<dim>& c, std::size_t k, double opening) {
  ContactStiffness stiffness{c.normal_stiffness[k], c.tangential_stiffness[k],
                             c.bending_stiffness[k], c.twisting_stiffness[k]};
  if (c.law == ContactLaw::hertz_mindlin) {
    const double root = std::sqrt(std::max(0.0, -opening));
    stiffness.normal *= 1.5 * root; // of delta^(3/2)
    stiffness.tangential *= root;
    stiffness.bending *= root;
  }
  return stiffness;
}

template <int dim>
Span<dim> span_of(const Contacts<dim>& c, const Particles<dim>& particles, std::size_t k) {
  Span<dim> span;
  const Vec<dim> B = c.reference_branch[k];
  const Vec<dim> relative =
      particles.displacement[c.second[k]] - particles.displacement[c.first[k]];
  span.branch = B + relative;
  span.length = span.branch.norm();
  // |b| - |B| is computed from the displacement, so that it keeps its digits when it is small.
  const double stretch = relative.dot(2.0 * B + relative) / (span.length + B.norm());
  span.opening = stretch + (B.norm() - c.rest_length[k]);
  return span;
}

template <int dim>
Vec<dim> shear_force(const Contacts<dim>& c, const Particles<dim>& particles, std::size_t k) {
  if constexpr (dim == 2)
    return spin<2>(c.shear_force[k], span_of(c, particles, k).normal());
  else
    return c.shear_force[k];
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template struct Contacts<dim>;                                                                   \
  template Contacts<dim> make_contacts<dim>(const Particles<dim>&, const Material&,                \
                                            std::optional<double>, double, const Period<dim>&);    \
  template void renew_contacts<dim>(Contacts<dim>&, const Particles<dim>&, const Material&,        \
                                    double, const Period<dim>&);                                   \
  template void blend<dim>(Contacts<dim>&, const Particles<dim>&);                                 \
  template Incidence incidence<dim>(const Contacts<dim>&, std::size_t);                            \
  template ContactStiffness stiffness_of<dim>(const Contacts<dim>&, std::size_t, double);          \
  template Span<dim> span_of<dim>(const Contacts<dim>&, const Particles<dim>&, std::size_t);       \
  template Vec<dim> shear_force<dim>(const Contacts<dim>&, const Particles<dim>&, std::size_t);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
