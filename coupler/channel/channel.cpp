// Chooses the transport of a channel by its name.
#include "coupler/channel/channel.hpp"

#include "coupler/channel/memory_channel.hpp"

#include <fmt/format.h>

namespace kerf::coupler {
namespace {

std::unique_ptr<Channel> open(ChannelAddress& address, End end) {
  if (address.transport == "shm")
    return open_shared_memory(address, end);
  if (address.transport == "zmq")
    return open_zeromq(address, end);
  if (address.transport == "loopback")
    return open_loopback(address, end);
  throw std::invalid_argument(
      fmt::format("unknown transport \"{}\": shm, zmq or loopback", address.transport));
}

} // namespace

std::unique_ptr<Channel> open_broker_end(ChannelAddress& address) {
  return open(address, End::broker);
}

std::unique_ptr<Channel> open_participant_end(const ChannelAddress& address) {
  ChannelAddress copy = address;
  return open(copy, End::participant);
}

} // namespace kerf::coupler
