// Which particles are close enough to touch before the list is made again.
#pragma once

#include "dem_core/particles.hpp"

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

namespace kerf::dem {

/// Two particles, first < second.
struct Pair {
  std::uint32_t first, second;

  bool operator==(const Pair&) const = default;
  auto operator<=>(const Pair& other) const { return key() <=> other.key(); }

private:
  std::uint64_t key() const { return std::uint64_t{first} << 32 | second; } // one comparison
};

/// All pairs with a gap, distance - (r_i + r_j), of at most `reach`, in ascending order.
/// Particles whose position is not finite have no neighbours.
/// @param position  [n] m
/// @param radius    [n] m
/// @throws std::invalid_argument when a period is shorter than twice the largest distance that
///         counts: a particle would then touch two images of another
template <int dim>
std::vector<Pair> find_pairs(std::span<const Vec<dim>> position, std::span<const double> radius,
                             double reach, const Period<dim>& period);

/// Tells when a list of pairs that was made with a skin has to be made again.
template <int dim> class Skin {
public:
  Skin() = default;
  /// @param width         gap up to which the list holds pairs, m
  /// @param displacement  [n] when the list was made, m
  Skin(double width, std::span<const Aligned<Vec<dim>>> displacement)
      : width_(width), displacement_(displacement.begin(), displacement.end()) {}

  double width() const noexcept { return width_; }
  /// Takes notice of a step in which no particle moved farther than this, m.
  void wear(double farthest) noexcept { bound_ += farthest; }
  /// True as soon as one particle has moved by more than half the width. The steps add up to a
  /// bound that spares looking at all particles as long as it is small.
  bool is_worn(std::span<const Aligned<Vec<dim>>> displacement);

private:
  friend struct StateParts;

  double width_ = 0.0;
  double bound_ = 0.0; // of the distance that any particle has moved, m
  std::vector<Vec<dim>> displacement_;
};

} // namespace kerf::dem
