// Transport "zmq": frames as ZeroMQ messages between a pair of sockets, in one machine or over a
// network. Two frames may be under way in each direction, as with shared memory: every message
// tells how many frames its sender has taken, and one without a frame is sent only when the other
// end could not go on without that news.
#include "coupler/channel/memory_channel.hpp"
#include "coupler/protocol/protocol_error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fmt/format.h>
#include <random>
#include <unistd.h>
#include <zmq.hpp>

namespace kerf::coupler {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto slice = std::chrono::milliseconds(50);

/// The first bytes of every message; a frame follows when `is_frame` is 1.
struct Prefix {
  std::uint32_t is_frame = 0;
  std::uint32_t taken = 0; // frames that the sender of this message has received
};
static_assert(sizeof(Prefix) == 8);

/// Memory aligned to 64 for one frame, with the prefix right before it.
class Buffer {
public:
  explicit Buffer(std::size_t capacity)
      : memory_(static_cast<std::byte*>(std::aligned_alloc(64, 64 + (capacity + 63) / 64 * 64)),
                &std::free) {
    if (!memory_)
      throw std::bad_alloc();
  }
  std::byte* frame() { return memory_.get() + 64; }
  std::byte* message() { return frame() - sizeof(Prefix); }

private:
  std::unique_ptr<std::byte, decltype(&std::free)> memory_;
};

class ZeromqChannel final : public Channel {
public:
  ZeromqChannel(ChannelAddress& address, End end)
      : socket_(context_, zmq::socket_type::pair),
        out_capacity_(end == End::broker ? address.down_capacity : address.up_capacity),
        in_capacity_(end == End::broker ? address.up_capacity : address.down_capacity),
        out_(out_capacity_), in_(in_capacity_) {
    socket_.set(zmq::sockopt::linger, 100); // ms; the last frame may still be under way
    // The limit also holds for ZeroMQ's own handshake, which has a few hundred bytes.
    const std::size_t largest_message = sizeof(Prefix) + std::max<std::size_t>(in_capacity_, 4096);
    socket_.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(largest_message));
    if (end == End::broker) {
      bind(address);
    } else {
      connect(address);
      peer_is_there_ = true; // as good as: what is sent before the broker listens waits for it
      tell_taken();          // without it the broker's end does not know that somebody is there
    }
  }

  std::span<std::byte> outgoing(const Wait& wait) override {
    const auto start = Clock::now();
    while (!peer_is_there_ || sent_ - peer_has_taken_ >= num_slots)
      if (!await_message(wait, start))
        throw TimeoutError(
            fmt::format("the other end did not take the last {} frames within {:g} s", num_slots,
                        std::chrono::duration<double>(wait.limit).count()));
    return {out_.frame(), out_capacity_};
  }

  void send(std::size_t bytes) override {
    if (bytes > out_capacity_)
      throw std::invalid_argument(
          fmt::format("a frame of {} bytes does not fit the capacity of {}", bytes, out_capacity_));
    ++sent_;
    send_message(Prefix{1, received_}, bytes);
  }

  std::span<const std::byte> receive(const Wait& wait) override {
    const auto start = Clock::now();
    while (pending_.empty())
      if (!await_message(wait, start))
        throw TimeoutError(fmt::format("no frame came within {:g} s",
                                       std::chrono::duration<double>(wait.limit).count()));
    const std::size_t bytes = pending_.front().size() - sizeof(Prefix);
    if (bytes > 0)
      std::memcpy(in_.frame(), pending_.front().data<std::byte>() + sizeof(Prefix), bytes);
    pending_.pop_front();
    ++received_;
    if (received_ - told_taken_ == num_slots)
      tell_taken();
    return {in_.frame(), bytes};
  }

private:
  void bind(ChannelAddress& address) {
    if (address.endpoint.empty()) { // a name in the abstract space: no file, and nobody else's
      std::random_device random;
      address.endpoint = fmt::format("ipc://@kerf-{}-{:08x}{:08x}", getpid(), random(), random());
    }
    try {
      socket_.bind(address.endpoint);
    } catch (const zmq::error_t& error) {
      throw std::system_error(error.num(), std::generic_category(),
                              fmt::format("cannot bind {}", address.endpoint));
    }
    if (address.endpoint.back() == '*')
      address.endpoint = socket_.get(zmq::sockopt::last_endpoint);
  }

  void connect(const ChannelAddress& address) {
    try {
      socket_.connect(address.endpoint);
    } catch (const zmq::error_t& error) {
      throw std::invalid_argument(
          fmt::format("cannot connect to \"{}\": {}", address.endpoint, error.what()));
    }
  }

  void tell_taken() { send_message(Prefix{0, received_}, 0); }

  void send_message(const Prefix& prefix, std::size_t bytes) {
    std::memcpy(out_.message(), &prefix, sizeof prefix);
    for (;;) {
      try {
        if (!socket_.send(zmq::const_buffer(out_.message(), sizeof prefix + bytes),
                          zmq::send_flags::dontwait))
          throw ClosedError("the other end has closed the link");
        told_taken_ = prefix.taken;
        return;
      } catch (const zmq::error_t& error) {
        if (error.num() != EINTR)
          throw;
      }
    }
  }

  /// Takes one message in, or lets one slice of time pass. Returns false when the limit has passed.
  bool await_message(const Wait& wait, Clock::time_point start) {
    if (take_message())
      return true;
    const auto left = wait.limit - (Clock::now() - start);
    if (left <= Clock::duration::zero())
      return false;
    const auto time =
        std::chrono::ceil<std::chrono::milliseconds>(std::min<Clock::duration>(left, slice));
    zmq_pollitem_t item{socket_.handle(), 0, ZMQ_POLLIN, 0};
    if (zmq_poll(&item, 1, static_cast<long>(time.count())) == 0 && wait.idle)
      wait.idle();
    return true;
  }

  bool take_message() {
    zmq::message_t message;
    try {
      if (!socket_.recv(message, zmq::recv_flags::dontwait))
        return false;
    } catch (const zmq::error_t& error) {
      if (error.num() == EINTR)
        return false;
      throw;
    }
    Prefix prefix;
    if (message.size() < sizeof prefix || message.size() > sizeof prefix + in_capacity_)
      throw ProtocolError(fmt::format("a message of {} bytes came, a frame has at most {}",
                                      message.size(), in_capacity_));
    std::memcpy(&prefix, message.data(), sizeof prefix);
    if (prefix.is_frame > 1 || sent_ - prefix.taken > sent_ - peer_has_taken_ ||
        pending_.size() + prefix.is_frame > num_slots)
      throw ProtocolError("a message came that is not a frame of this link");
    peer_is_there_ = true;
    peer_has_taken_ = prefix.taken;
    if (prefix.is_frame != 0)
      pending_.push_back(std::move(message));
    return true;
  }

  zmq::context_t context_;
  zmq::socket_t socket_;
  std::size_t out_capacity_; // bytes
  std::size_t in_capacity_;
  Buffer out_;
  Buffer in_;
  std::deque<zmq::message_t> pending_; // came while waiting for room to send
  bool peer_is_there_ = false;
  std::uint32_t sent_ = 0;
  std::uint32_t peer_has_taken_ = 0;
  std::uint32_t received_ = 0;
  std::uint32_t told_taken_ = 0;
};

} // namespace

std::unique_ptr<Channel> open_zeromq(ChannelAddress& address, End end) {
  segment_bytes(address.up_capacity, address.down_capacity); // refuses impossible capacities
  return std::make_unique<ZeromqChannel>(address, end);
}

} // namespace kerf::coupler
