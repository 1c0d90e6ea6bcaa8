// The physical quantities that an interface can exchange.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace kerf::coupler {

/// A quantity per point of an interface; on the wire it is called by its name.
enum class Field {
  position,         // x^n, m
  velocity,         // v^(n-1/2), m/s
  angular_velocity, // rad/s
  force,            // N
  moment,           // N m
  heat_flow,        // W
  temperature,      // K
};

inline constexpr Field all_fields[] = {
    Field::position, Field::velocity,  Field::angular_velocity, Field::force,
    Field::moment,   Field::heat_flow, Field::temperature,
};

constexpr std::string_view name(Field field) noexcept {
  switch (field) {
  case Field::position:
    return "position";
  case Field::velocity:
    return "velocity";
  case Field::angular_velocity:
    return "angular_velocity";
  case Field::force:
    return "force";
  case Field::moment:
    return "moment";
  case Field::heat_flow:
    return "heat_flow";
  case Field::temperature:
    return "temperature";
  }
  return "unknown";
}

constexpr std::optional<Field> field_of_name(std::string_view text) noexcept {
  for (const Field field : all_fields)
    if (name(field) == text)
      return field;
  return std::nullopt;
}

/// Numbers per point. A rotation in the plane has one component, about the axis out of it.
constexpr std::size_t components(Field field, int dimension) noexcept {
  switch (field) {
  case Field::position:
  case Field::velocity:
  case Field::force:
    return static_cast<std::size_t>(dimension);
  case Field::angular_velocity:
  case Field::moment:
    return dimension == 2 ? 1 : 3;
  case Field::heat_flow:
  case Field::temperature:
    return 1;
  }
  return 0;
}

} // namespace kerf::coupler
