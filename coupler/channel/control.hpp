// Control messages over ZeroMQ: the broker serves all participants on one endpoint.
#pragma once

#include "coupler/protocol/message.hpp"
#include "coupler/protocol/protocol_error.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kerf::coupler {

/// Parts on the wire of a message, and back. decode() believes nothing: types, sizes, shapes and
/// the version are checked before any memory is taken.
/// @throws ProtocolError; encode() std::invalid_argument when a shape does not fit its values
std::vector<std::string> encode(const Message& message);
Message decode(const std::vector<std::string>& parts);

/// The broker's side: receives from any participant, answers one of them.
class ControlServer {
public:
  /// @param endpoint  ZeroMQ address to bind; "ipc://@name" leaves no file behind
  explicit ControlServer(const std::string& endpoint);
  ~ControlServer();
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  struct Incoming {
    std::string peer; // opaque identity of the sender, for send()
    Message message;
  };
  /// The next message, or nothing when none came within the limit.
  /// @throws ProtocolError for a malformed message (with the peer in its text); the peer was told
  ///         to stop, with the reason
  std::optional<Incoming> receive(std::chrono::milliseconds limit);
  void send(const std::string& peer, const Message& message);
  std::string endpoint() const; // as bound

private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
};

/// The participant's side.
class ControlClient {
public:
  explicit ControlClient(const std::string& endpoint);
  ~ControlClient();
  ControlClient(ControlClient&&) noexcept;
  ControlClient& operator=(ControlClient&&) noexcept;

  /// The next message, or nothing when none came within the limit.
  /// @throws ProtocolError for a malformed message
  std::optional<Message> receive(std::chrono::milliseconds limit);
  void send(const Message& message);
  /// True once after the connection has broken: the broker's process is gone.
  bool lost();

private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
};

} // namespace kerf::coupler
