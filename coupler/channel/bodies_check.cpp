// Whether declarations, plans and limits fit together.
#include "coupler/channel/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace kerf::coupler {
namespace {

std::string wrong_size(const std::string& name, std::size_t size, std::size_t expected) {
  return size == expected ? "" : fmt::format("{} has {} values, not {}", name, size, expected);
}

/// @param least  smallest value allowed
std::string bad_number(const std::string& name, const std::vector<double>& values,
                       double least = -std::numeric_limits<double>::max()) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]) || values[i] < least)
      return fmt::format("{}[{}] is {}", name, i, values[i]);
  return "";
}

std::string bad_index(const std::string& name, const std::vector<std::uint32_t>& indices,
                      std::size_t num_points) {
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] >= num_points)
      return fmt::format("{}[{}] is {}, there are {} points", name, i, indices[i], num_points);
  return "";
}

std::string bad_ids(const std::vector<std::int64_t>& ids) {
  if (ids.empty())
    return "there is no point";
  if (ids.size() > std::numeric_limits<std::uint32_t>::max())
    return fmt::format("there are {} points, indices have 32 bits", ids.size());
  if (std::is_sorted(ids.begin(), ids.end(), std::less_equal<>()))
    return ""; // strictly ascending, as nearly always
  std::vector<std::int64_t> sorted = ids;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  return twice == sorted.end() ? "" : fmt::format("the id {} stands twice", *twice);
}

std::string bad_mesh(const Declaration& d) {
  const int nodes = d.nodes_per_element;
  const bool known = d.dimension == 2 ? nodes == 3 || nodes == 4 : nodes == 4 || nodes == 8;
  if (nodes == 0)
    return d.elements.empty() && d.boundary.empty() ? "" : "there are elements of no nodes";
  if (!known)
    return fmt::format("elements of {} nodes in {} dimensions", nodes, d.dimension);
  if (d.elements.size() % static_cast<std::size_t>(nodes) != 0)
    return fmt::format("elements has {} values, not {} for each", d.elements.size(), nodes);
  if (auto fault = bad_index("elements", d.elements, d.num_points()); !fault.empty())
    return fault;
  for (const auto& [tag, faces] : d.boundary) {
    const std::string name = fmt::format("boundary \"{}\"", tag);
    if (faces.size() % static_cast<std::size_t>(d.nodes_per_face()) != 0)
      return fmt::format("{} has {} values, not {} for each face", name, faces.size(),
                         d.nodes_per_face());
    if (auto fault = bad_index(name, faces, d.num_points()); !fault.empty())
      return fault;
  }
  return "";
}

std::string bad_interface(const Interface& interface, std::size_t num_points) {
  const std::string name = fmt::format("points of \"{}\"", interface.coupling);
  const auto& points = interface.points;
  if (!std::is_sorted(points.begin(), points.end(), std::less_equal<>()))
    return fmt::format("{} are not in ascending order", name);
  if (auto fault = bad_index(name, points, num_points); !fault.empty())
    return fault;
  const std::string stiffness = fmt::format("stiffness of \"{}\"", interface.coupling);
  if (!interface.stiffness.empty())
    if (auto fault = wrong_size(stiffness, interface.stiffness.size(), points.size());
        !fault.empty())
      return fault;
  return bad_number(stiffness, interface.stiffness, 0.0);
}

std::string first_of(std::initializer_list<std::string> faults) {
  for (const std::string& fault : faults)
    if (!fault.empty())
      return fault;
  return "";
}

} // namespace

int Declaration::nodes_per_face() const noexcept {
  if (dimension == 2)
    return 2;
  return nodes_per_element == 8 ? 4 : 3;
}

std::string fault_in(const Declaration& d) {
  if (d.dimension != 2 && d.dimension != 3)
    return fmt::format("the dimension is {}, not 2 or 3", d.dimension);
  const std::size_t n = d.num_points();
  if (!std::isfinite(d.memory_estimate) || d.memory_estimate < 0.0)
    return fmt::format("memory_estimate is {}", d.memory_estimate);
  return first_of({
      bad_ids(d.ids),
      wrong_size("positions", d.positions.size(), n * static_cast<std::size_t>(d.dimension)),
      bad_number("positions", d.positions),
      d.radii.empty() ? "" : wrong_size("radii", d.radii.size(), n),
      bad_number("radii", d.radii, std::numeric_limits<double>::min()),
      d.stiffness.empty() ? "" : wrong_size("stiffness", d.stiffness.size(), n),
      bad_number("stiffness", d.stiffness, 0.0),
      bad_mesh(d),
  });
}

std::string fault_in(const Plan& plan, std::size_t num_points) {
  if (!plan.weights.empty())
    if (auto fault = first_of({wrong_size("weights", plan.weights.size(), num_points),
                               bad_number("weights", plan.weights, 0.0)});
        !fault.empty())
      return fault;
  for (const Interface& interface : plan.interfaces)
    if (auto fault = bad_interface(interface, num_points); !fault.empty())
      return fault;
  return "";
}

std::string fault_in(const Limits& limits, const Plan& plan, int dimension) {
  const std::size_t interfaces = plan.interfaces.size();
  if (auto fault = first_of({wrong_size("inverse_mass", limits.inverse_mass.size(), interfaces),
                             wrong_size("omega2", limits.omega2.size(), interfaces)});
      !fault.empty())
    return fault;
  for (std::size_t i = 0; i < interfaces; ++i) {
    const std::size_t n = plan.interfaces[i].points.size();
    const std::string mass = fmt::format("inverse_mass of \"{}\"", plan.interfaces[i].coupling);
    const std::string omega2 = fmt::format("omega2 of \"{}\"", plan.interfaces[i].coupling);
    const std::size_t values = n * static_cast<std::size_t>(dimension);
    if (auto fault = first_of({wrong_size(mass, limits.inverse_mass[i].size(), values),
                               bad_number(mass, limits.inverse_mass[i], 0.0),
                               wrong_size(omega2, limits.omega2[i].size(), n),
                               bad_number(omega2, limits.omega2[i], 0.0)});
        !fault.empty())
      return fault;
  }
  if (!std::isfinite(limits.largest_omega2) || limits.largest_omega2 < 0.0)
    return fmt::format("largest_omega2 is {}", limits.largest_omega2);
  return "";
}

} // namespace kerf::coupler
