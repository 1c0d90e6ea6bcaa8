// Where each interface and field stands in the frames of one participant.
#pragma once

#include "coupler/channel/bodies.hpp"
#include "coupler/protocol/frame.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kerf::coupler {

/// The agreed contents of one participant's frames. Both sides build it from the same
/// declaration and plan; equal checksums say that they did.
///
/// After its header a frame carries, interface by interface in the order of the plan, every field
/// of that interface and kind as [n][components] float64.
class FrameLayout {
public:
  FrameLayout() = default;
  /// @param ids  [num_points] of the declaration
  /// @throws std::invalid_argument when a point of an interface has no id, or a field stands twice
  FrameLayout(int dimension, std::span<const std::int64_t> ids,
              std::span<const Interface> interfaces);

  std::size_t num_interfaces() const noexcept { return motion_.size(); }
  std::size_t count(FrameKind kind) const noexcept; // float64 values after the header
  std::size_t bytes(FrameKind kind) const noexcept; // with the header
  std::size_t up_capacity() const noexcept;         // bytes of the largest frame to the broker
  std::size_t down_capacity() const noexcept;       // bytes of the largest frame from the broker
  std::uint64_t checksum() const noexcept { return checksum_; }

  /// The values of one field of one interface, [n][components], inside a frame.
  /// @throws std::out_of_range when there is no such interface, std::invalid_argument when it
  ///         does not exchange that field in such frames or the frame is too short
  std::span<double> values(std::span<std::byte> frame, FrameKind kind, std::size_t interface,
                           Field field) const;
  std::span<const double> values(std::span<const std::byte> frame, FrameKind kind,
                                 std::size_t interface, Field field) const;

  /// Writes the header of a frame of this layout.
  void write_header(std::span<std::byte> frame, FrameKind kind, std::uint64_t step,
                    std::uint32_t epoch = 0) const;

private:
  struct Block { // one field of one interface
    Field field;
    std::size_t offset; // in float64 values after the header
    std::size_t size;   // n * components
  };
  using Blocks = std::vector<std::vector<Block>>; // [interfaces][fields]
  const Block& find(FrameKind kind, std::size_t interface, Field field) const;

  Blocks motion_;
  Blocks forces_;
  std::size_t motion_count_ = 0;
  std::size_t forces_count_ = 0;
  std::uint64_t checksum_ = 0;
};

/// @throws ProtocolError naming what differs, unless the frame has exactly the agreed length and
///         a header of this kind, step, epoch and layout
void check_frame(std::span<const std::byte> frame, FrameKind kind, std::uint64_t step,
                 const FrameLayout& layout, std::uint32_t epoch = 0);

} // namespace kerf::coupler
