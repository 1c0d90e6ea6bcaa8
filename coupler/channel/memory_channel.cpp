// See memory_channel.hpp: two slot queues, one up and one down.
#include "coupler/channel/memory_channel.hpp"

#include "coupler/protocol/frame.hpp"

#include <fmt/format.h>
#include <new>

namespace kerf::coupler {
namespace {

constexpr std::size_t largest_capacity = std::size_t{1} << 40; // bytes

class MemoryChannel final : public Channel {
public:
  MemoryChannel(std::shared_ptr<std::byte> memory, std::byte* out, std::size_t out_capacity,
                std::byte* in, std::size_t in_capacity)
      : memory_(std::move(memory)), sender_(out, out_capacity), receiver_(in, in_capacity) {}

  std::span<std::byte> outgoing(const Wait& wait) override { return sender_.outgoing(wait); }
  void send(std::size_t bytes) override { sender_.send(bytes); }
  std::span<const std::byte> receive(const Wait& wait) override { return receiver_.receive(wait); }

private:
  std::shared_ptr<std::byte> memory_;
  SlotSender sender_;
  SlotReceiver receiver_;
};

} // namespace

std::size_t segment_bytes(std::size_t up_capacity, std::size_t down_capacity) {
  if (up_capacity > largest_capacity || down_capacity > largest_capacity)
    throw std::invalid_argument(fmt::format("frames of {} bytes up and {} bytes down: at most {}",
                                            up_capacity, down_capacity, largest_capacity));
  return sizeof(SegmentHeader) + slot_queue_bytes(up_capacity) + slot_queue_bytes(down_capacity);
}

void prepare_segment(std::byte* memory, std::size_t up_capacity, std::size_t down_capacity) {
  auto* header = ::new (memory) SegmentHeader;
  header->version = protocol_version;
  header->up_capacity = up_capacity;
  header->down_capacity = down_capacity;
}

std::unique_ptr<Channel> make_memory_channel(std::shared_ptr<std::byte> memory, End end,
                                             std::size_t up_capacity, std::size_t down_capacity) {
  const auto* header = reinterpret_cast<const SegmentHeader*>(memory.get());
  if (header->magic != SegmentHeader::magic_number || header->version != protocol_version)
    throw std::invalid_argument("the shared memory was not made by this version of the protocol");
  if (header->up_capacity != up_capacity || header->down_capacity != down_capacity)
    throw std::invalid_argument(
        fmt::format("the shared memory is for frames of {} bytes up and {} down, not {} and {}",
                    header->up_capacity, header->down_capacity, up_capacity, down_capacity));
  std::byte* up = memory.get() + sizeof(SegmentHeader);
  std::byte* down = up + slot_queue_bytes(up_capacity);
  if (end == End::broker)
    return std::make_unique<MemoryChannel>(std::move(memory), down, down_capacity, up, up_capacity);
  return std::make_unique<MemoryChannel>(std::move(memory), up, up_capacity, down, down_capacity);
}

} // namespace kerf::coupler
