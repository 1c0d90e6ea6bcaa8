// The shapes of elements: tri3, quad4, tet4 and hex8, with nodes and sides in VTK's order.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace kerf::fem {

enum class Shape : std::uint8_t { tri3, quad4, tet4, hex8 };

constexpr int dimension_of(Shape shape) {
  return shape == Shape::tri3 || shape == Shape::quad4 ? 2 : 3;
}
constexpr int nodes_of(Shape shape) {
  return std::array{3, 4, 4, 8}[static_cast<std::size_t>(shape)];
}
constexpr std::string_view name_of(Shape shape) {
  return std::array<std::string_view, 4>{"tri3", "quad4", "tet4",
                                         "hex8"}[static_cast<std::size_t>(shape)];
}

/// Local nodes of the sides of a shape: seen from outside counter-clockwise in 3D, with the element
/// on the left in 2D.
template <Shape shape> inline constexpr auto sides = nullptr;
template <>
inline constexpr std::array<std::array<std::uint8_t, 2>, 3> sides<Shape::tri3> = {
    {{0, 1}, {1, 2}, {2, 0}}};
template <>
inline constexpr std::array<std::array<std::uint8_t, 2>, 4> sides<Shape::quad4> = {
    {{3, 0}, {1, 2}, {0, 1}, {2, 3}}}; // left, right, bottom, top
template <>
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> sides<Shape::tet4> = {
    {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
template <>
inline constexpr std::array<std::array<std::uint8_t, 4>, 6> sides<Shape::hex8> = {
    {{0, 4, 7, 3}, // left, right, bottom, top, back, front
     {1, 2, 6, 5},
     {0, 1, 5, 4},
     {3, 7, 6, 2},
     {0, 3, 2, 1},
     {4, 5, 6, 7}}};

constexpr int sides_of(Shape shape) {
  return std::array{3, 4, 4, 6}[static_cast<std::size_t>(shape)];
}
/// Local nodes of one side.
constexpr std::span<const std::uint8_t> side_nodes(Shape shape, int side) {
  const auto k = static_cast<std::size_t>(side);
  switch (shape) {
  case Shape::tri3:
    return sides<Shape::tri3>[k];
  case Shape::quad4:
    return sides<Shape::quad4>[k];
  case Shape::tet4:
    return sides<Shape::tet4>[k];
  case Shape::hex8:
    break;
  }
  return sides<Shape::hex8>[k];
}

} // namespace kerf::fem
