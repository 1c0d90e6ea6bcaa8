// The frames that a participant and the broker exchange in every step: a fixed header, then raw
// little-endian float64 arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace kerf::coupler {

/// Raised whenever a message or a frame changes its meaning; a handshake between different
/// versions is refused by name.
inline constexpr std::uint32_t protocol_version = 1;

/// What a data frame carries, in the order in which a step sends them.
enum class FrameKind : std::uint32_t {
  motion = 1,           // up: per interface position x^n, then velocity v^(n-1/2)
  own_forces = 2,       // up: per interface the resultant without the interface force
  interface_forces = 3, // down: per interface the force of the coupling
};

/// The first 64 bytes of every data frame. What follows are `count` float64 values: the interfaces
/// of the participant in their agreed order, each field as [num_points][dimension].
struct FrameHeader {
  static constexpr std::uint32_t magic_number = 0x6672656b; // "kerf"

  std::uint32_t magic = magic_number;
  std::uint32_t version = protocol_version;
  FrameKind kind = FrameKind::motion;
  std::uint32_t epoch = 0;  // membership of the interfaces; a change of the ids starts a new one
  std::uint64_t step = 0;   // n of the time t_n = n dt
  std::uint64_t count = 0;  // float64 values that follow
  std::uint64_t layout = 0; // checksum of the interface ids and fields, agreed at initialize
  std::uint64_t reserved[3] = {};
};
static_assert(sizeof(FrameHeader) == 64);

/// Continues an FNV-1a checksum over some bytes; it names a layout, it does not protect a secret.
constexpr std::uint64_t checksum(std::string_view bytes,
                                 std::uint64_t seed = 0xcbf29ce484222325u) noexcept {
  for (const char byte : bytes)
    seed = (seed ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return seed;
}

} // namespace kerf::coupler
