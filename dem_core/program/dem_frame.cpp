#include "dem_core/program/dem_frame.hpp"

#include "dem_core/stress.hpp"

#include <algorithm>
#include <compare>
#include <numeric>
#include <vector>

namespace kerf::dem {

namespace {

/// Which particle each row shows, and in which row each particle is.
struct RowOrder {
  std::vector<std::uint32_t> particle, row;

  explicit RowOrder(std::span<const std::uint32_t> ids) : particle(ids.size()), row(ids.size()) {
    std::iota(particle.begin(), particle.end(), 0u);
    std::sort(particle.begin(), particle.end(),
              [&](std::uint32_t i, std::uint32_t j) { return ids[i] < ids[j]; });
    for (std::uint32_t r = 0; r < row.size(); ++r)
      row[particle[r]] = r;
  }
};

/// A contact between two rows; `is_turned` when the engine sees it from the other end.
struct ContactRow {
  std::uint32_t first, second;
  std::uint32_t contact;
  bool is_turned;
  auto operator<=>(const ContactRow&) const = default;
};

template <int dim>
std::vector<ContactRow> contact_rows(const Contacts<dim>& contacts, const RowOrder& order) {
  std::vector<ContactRow> rows(contacts.size());
  for (std::uint32_t k = 0; k < rows.size(); ++k) {
    const auto [first, second] =
        std::minmax({order.row[contacts.first[k]], order.row[contacts.second[k]]});
    rows[k] = {first, second, k, order.row[contacts.first[k]] != first};
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// value(item) of every item, in their order.
template <class Items, class Value> auto column(const Items& items, Value value) {
  std::vector<decltype(value(items.front()))> values;
  values.reserve(items.size());
  for (const auto& item : items)
    values.push_back(value(item));
  return values;
}

/// The field of a column of numbers or of small vectors, which lie one behind the other.
template <class Value> Field field(const char* name, const std::vector<Value>& values) {
  if constexpr (std::is_arithmetic_v<Value>) {
    return {name, 1, std::span<const Value>(values)};
  } else {
    constexpr std::size_t size = Value::SizeAtCompileTime;
    static_assert(sizeof(Value) == size * sizeof(double));
    const double* data = values.empty() ? nullptr : values.front().data();
    return {name, size, std::span<const double>(data, values.size() * size)};
  }
}

} // namespace

template <int dim>
void write_dem_frame(FrameWriter& frames, std::uint64_t step, double time,
                     const Engine<dim>& engine, const Fragments& fragments,
                     std::span<const Grid> tools) {
  const Particles<dim>& p = engine.particles();
  const Contacts<dim>& c = engine.contacts();
  const RowOrder order(p.ids);
  const auto of_particles = [&](auto value) { return column(order.particle, value); };
  const auto from = [&](const auto& values) {
    return of_particles([&](std::uint32_t i) { return values[i]; });
  };
  const auto position = of_particles([&](std::uint32_t i) { return p.position(i); });
  const auto id = of_particles([&](std::uint32_t i) { return std::int64_t{p.ids[i]}; });
  const auto boundary = of_particles([&](std::uint32_t i) {
    return std::int64_t{engine.boundary().of(i) != nullptr && !p.is_member(i)};
  });
  const auto cluster = of_particles([&](std::uint32_t i) {
    return p.is_member(i) ? std::int64_t{p.cluster[i]} - 1 : std::int64_t{-1};
  });
  const auto material = of_particles([&](std::uint32_t i) {
    return p.material.empty() ? std::int64_t{0} : std::int64_t{p.material[i]};
  });
  const auto weight =
      of_particles([&](std::uint32_t i) { return p.weight.empty() ? 1.0 : p.weight[i]; });
  const auto radius = from(p.radius), mass = from(p.mass);
  const auto displacement = of_particles([&](auto i) -> Vec<dim> { return p.displacement[i]; });
  const auto velocity = of_particles([&](auto i) -> Vec<dim> { return p.velocity[i]; });
  const auto angular_velocity =
      of_particles([&](auto i) -> Rot<dim> { return p.angular_velocity[i]; });

  const auto fragment =
      of_particles([&](std::uint32_t i) { return std::int64_t{fragments.of[i]}; });

  const auto stress = from(particle_stress(c, p));

  const std::vector<ContactRow> rows = contact_rows(c, order);
  const auto of_contacts = [&](const auto& values) {
    return column(rows, [&](const ContactRow& row) { return values[row.contact]; });
  };
  std::vector<std::uint32_t> pairs;
  for (const ContactRow& row : rows)
    pairs.insert(pairs.end(), {row.first, row.second});
  const auto bonded =
      column(rows, [&](const ContactRow& row) { return std::int64_t{c.bonded[row.contact]}; });
  const auto tangential_force = column(rows, [&](const ContactRow& row) -> Vec<dim> {
    return (row.is_turned ? -1.0 : 1.0) * shear_force(c, p, row.contact);
  });
  const auto normal_force = of_contacts(c.normal_force);
  const auto normal_stiffness = of_contacts(c.normal_stiffness);
  const auto tangential_stiffness = of_contacts(c.tangential_stiffness);
  const auto contact_weight = of_contacts(c.weight);

  std::vector<Grid> grids = {
      {.name = "particles",
       .positions = std::get<0>(field("position", position).data),
       .points_of = {},
       .cells = Cells::points,
       .connectivity = {},
       .point_fields = {field("id", id), field("radius", radius), field("mass", mass),
                        field("displacement", displacement), field("velocity", velocity),
                        field("angular_velocity", angular_velocity), field("weight", weight),
                        field("boundary", boundary), field("cluster", cluster),
                        field("fragment", fragment), field("stress", stress)},
       .cell_fields = {}},
      {.name = "contacts",
       .positions = {},
       .points_of = "particles",
       .cells = Cells::segments,
       .connectivity = pairs,
       .point_fields = {},
       .cell_fields = {
           field("bonded", bonded), field("normal_force", normal_force),
           field("tangential_force", tangential_force), field("normal_stiffness", normal_stiffness),
           field("tangential_stiffness", tangential_stiffness), field("weight", contact_weight)}}};
  if (!p.material.empty())
    grids[0].point_fields.push_back(field("material", material));
  grids.insert(grids.end(), tools.begin(), tools.end());
  frames.write(step, time, grids);
}

template void write_dem_frame<2>(FrameWriter&, std::uint64_t, double, const Engine<2>&,
                                 const Fragments&, std::span<const Grid>);
template void write_dem_frame<3>(FrameWriter&, std::uint64_t, double, const Engine<3>&,
                                 const Fragments&, std::span<const Grid>);

} // namespace kerf::dem
