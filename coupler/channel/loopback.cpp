// Transport "loopback": both ends are threads of one process that meet under a name.
#include "coupler/channel/memory_channel.hpp"

#include <cstring>
#include <fmt/format.h>
#include <map>
#include <mutex>
#include <new>

namespace kerf::coupler {
namespace {

/// Links whose participant has not come yet. A link that lost its broker's end is forgotten.
struct Registry {
  std::mutex mutex;
  std::map<std::string, std::weak_ptr<std::byte>> links;
  unsigned long names = 0;
};

Registry& registry() {
  static Registry all;
  return all;
}

std::shared_ptr<std::byte> zeroed_memory(std::size_t bytes) {
  constexpr auto alignment = std::align_val_t{64};
  auto* memory = static_cast<std::byte*>(::operator new(bytes, alignment));
  std::memset(memory, 0, bytes);
  return {memory, [](std::byte* start) { ::operator delete(start, alignment); }};
}

std::unique_ptr<Channel> create(ChannelAddress& address) {
  auto memory = zeroed_memory(segment_bytes(address.up_capacity, address.down_capacity));
  prepare_segment(memory.get(), address.up_capacity, address.down_capacity);
  {
    const std::lock_guard lock(registry().mutex);
    if (address.endpoint.empty())
      address.endpoint = fmt::format("loopback-{}", ++registry().names);
    auto& link = registry().links[address.endpoint];
    if (!link.expired())
      throw std::invalid_argument(fmt::format("the link {} is already open", address.endpoint));
    link = memory;
  }
  return make_memory_channel(std::move(memory), End::broker, address.up_capacity,
                             address.down_capacity);
}

std::unique_ptr<Channel> attach(const ChannelAddress& address) {
  std::shared_ptr<std::byte> memory;
  {
    const std::lock_guard lock(registry().mutex);
    const auto link = registry().links.find(address.endpoint);
    if (link != registry().links.end()) {
      memory = link->second.lock();
      registry().links.erase(link);
    }
  }
  if (!memory)
    throw std::invalid_argument(
        fmt::format("no link waits under the name {} in this process", address.endpoint));
  return make_memory_channel(std::move(memory), End::participant, address.up_capacity,
                             address.down_capacity);
}

} // namespace

std::unique_ptr<Channel> open_loopback(ChannelAddress& address, End end) {
  return end == End::broker ? create(address) : attach(address);
}

} // namespace kerf::coupler
