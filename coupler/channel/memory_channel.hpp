// The channel over memory that both ends share; shared_memory.cpp and loopback.cpp provide it.
#pragma once

#include "coupler/channel/slot_queue.hpp"

#include <memory>

namespace kerf::coupler {

/// What stands at the beginning of the shared memory.
struct SegmentHeader {
  static constexpr std::uint64_t magic_number = 0x31676573'6672656b; // "kerfseg1"

  std::uint64_t magic = magic_number;
  std::uint64_t version = 0; // of the protocol
  std::uint64_t up_capacity = 0;
  std::uint64_t down_capacity = 0;
  std::uint64_t reserved[4] = {};
};
static_assert(sizeof(SegmentHeader) == 64);

/// Bytes of a segment: the header, the direction up, the direction down.
/// @throws std::invalid_argument when a capacity is beyond any machine's memory
std::size_t segment_bytes(std::size_t up_capacity, std::size_t down_capacity);

/// Writes the header of zeroed memory.
void prepare_segment(std::byte* memory, std::size_t up_capacity, std::size_t down_capacity);

enum class End { broker, participant };

/// @param memory  segment_bytes(), prepared; kept as long as the channel lives
/// @throws std::invalid_argument when the header does not name these capacities
std::unique_ptr<Channel> make_memory_channel(std::shared_ptr<std::byte> memory, End end,
                                             std::size_t up_capacity, std::size_t down_capacity);

// The transports that channel.cpp chooses from.
std::unique_ptr<Channel> open_shared_memory(ChannelAddress& address, End end);
std::unique_ptr<Channel> open_loopback(ChannelAddress& address, End end);
std::unique_ptr<Channel> open_zeromq(ChannelAddress& address, End end);

} // namespace kerf::coupler
