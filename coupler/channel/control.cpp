// Control messages between the broker's router socket and the participants' dealer sockets.
#include "coupler/channel/control.hpp"

#include "coupler/channel/bodies.hpp"

#include <cerrno>
#include <fmt/format.h>
#include <system_error>
#include <zmq.hpp>

namespace kerf::coupler {
namespace {

constexpr std::int64_t largest_part = std::int64_t{4} << 30; // bytes
constexpr std::size_t most_parts = 10'000;

/// Waits for a message and takes all of its parts; nothing when none came in time.
std::vector<std::string> receive_parts(zmq::socket_t& socket, std::chrono::milliseconds limit) {
  zmq_pollitem_t item{socket.handle(), 0, ZMQ_POLLIN, 0};
  if (limit.count() > 0 && zmq_poll(&item, 1, static_cast<long>(limit.count())) <= 0)
    return {};
  std::vector<std::string> parts;
  for (bool more = true; more;) {
    zmq::message_t part;
    // The parts of a message come together: only the first can be missing.
    const auto flags = parts.empty() ? zmq::recv_flags::dontwait : zmq::recv_flags::none;
    try {
      if (!socket.recv(part, flags))
        return {};
    } catch (const zmq::error_t& error) {
      if (error.num() != EINTR)
        throw;
      if (parts.empty())
        return {}; // a signal, for the caller to look at
      continue;
    }
    more = part.more();
    if (parts.size() < most_parts)
      parts.push_back(part.to_string());
  }
  if (parts.size() == most_parts)
    parts.resize(1); // refused: it announces more arrays than it brings
  return parts;
}

void send_parts(zmq::socket_t& socket, const std::vector<std::string>& parts) {
  for (std::size_t i = 0; i < parts.size();) {
    const auto flags = i + 1 < parts.size() ? zmq::send_flags::sndmore : zmq::send_flags::none;
    try {
      socket.send(zmq::buffer(parts[i]), flags);
      ++i;
    } catch (const zmq::error_t& error) {
      if (error.num() != EINTR)
        throw;
    }
  }
}

/// A peer's identity is five bytes that ZeroMQ made up.
std::string readable(const std::string& identity) {
  std::string text;
  for (const char byte : identity)
    text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text;
}

} // namespace

struct ControlServer::Socket {
  zmq::context_t context;
  zmq::socket_t router{context, zmq::socket_type::router};
};

ControlServer::ControlServer(const std::string& endpoint) : socket_(std::make_unique<Socket>()) {
  auto& router = socket_->router;
  router.set(zmq::sockopt::linger, 300); // ms; the reason of a stop should still arrive
  router.set(zmq::sockopt::maxmsgsize, largest_part);
  try {
    router.bind(endpoint);
  } catch (const zmq::error_t& error) {
    throw std::system_error(error.num(), std::generic_category(),
                            fmt::format("cannot bind {}", endpoint));
  }
}

ControlServer::~ControlServer() = default;

std::optional<ControlServer::Incoming> ControlServer::receive(std::chrono::milliseconds limit) {
  auto parts = receive_parts(socket_->router, limit);
  if (parts.empty())
    return std::nullopt;
  Incoming incoming{std::move(parts.front()), {}};
  parts.erase(parts.begin());
  try {
    incoming.message = decode(parts);
  } catch (const ProtocolError& error) {
    send(incoming.peer,
         to_message(Stop{fmt::format("the broker refuses a message: {}", error.what())}));
    throw ProtocolError(fmt::format("from peer {}: {}", readable(incoming.peer), error.what()));
  }
  return incoming;
}

void ControlServer::send(const std::string& peer, const Message& message) {
  auto parts = encode(message);
  parts.insert(parts.begin(), peer);
  send_parts(socket_->router, parts);
}

std::string ControlServer::endpoint() const {
  return socket_->router.get(zmq::sockopt::last_endpoint);
}

struct ControlClient::Socket {
  zmq::context_t context;
  zmq::socket_t dealer{context, zmq::socket_type::dealer};
  zmq::socket_t events{context, zmq::socket_type::pair}; // tells when the connection breaks

  /// No event may come once nobody listens: libzmq would lose the memory of its message.
  ~Socket() { zmq_socket_monitor(dealer.handle(), nullptr, 0); }
};

ControlClient::ControlClient(const std::string& endpoint) : socket_(std::make_unique<Socket>()) {
  auto& dealer = socket_->dealer;
  dealer.set(zmq::sockopt::linger, 300);    // ms; the report of an error should still arrive
  dealer.set(zmq::sockopt::sndtimeo, 1000); // ms; a full queue means that nobody listens
  dealer.set(zmq::sockopt::maxmsgsize, largest_part);
  constexpr const char* events = "inproc://events";
  try {
    if (zmq_socket_monitor(dealer.handle(), events, ZMQ_EVENT_DISCONNECTED) != 0)
      throw zmq::error_t();
    socket_->events.set(zmq::sockopt::linger, 0);
    socket_->events.connect(events);
    dealer.connect(endpoint);
  } catch (const zmq::error_t& error) {
    throw std::invalid_argument(
        fmt::format("cannot connect to the broker at \"{}\": {}", endpoint, error.what()));
  }
}

ControlClient::~ControlClient() = default;
ControlClient::ControlClient(ControlClient&&) noexcept = default;
ControlClient& ControlClient::operator=(ControlClient&&) noexcept = default;

std::optional<Message> ControlClient::receive(std::chrono::milliseconds limit) {
  const auto parts = receive_parts(socket_->dealer, limit);
  if (parts.empty())
    return std::nullopt;
  return decode(parts);
}

void ControlClient::send(const Message& message) {
  send_parts(socket_->dealer, encode(message));
}

bool ControlClient::lost() {
  return !receive_parts(socket_->events, {}).empty();
}

} // namespace kerf::coupler

#ifdef __SANITIZE_THREAD__
/// libzmq is compiled without the sanitizer, which so cannot see that it hands memory from one
/// thread to another in order.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
  return "called_from_lib:libzmq.so\nrace:libzmq.so\n";
}
#endif
