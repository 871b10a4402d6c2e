#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <tether/base/time.h>
#include <tether/link/channel.h>
#include <tether/link/codec.h>
#include <tether/link/messages.h>

namespace tether::link {

/// Identifies one connection for its whole life; never reused within a server.
using PeerId = std::uint64_t;

/// What happened on the coordinator's end. Called from within `Server::poll`, on its thread; must
/// not throw.
class ServerEvents {
 public:
  virtual ~ServerEvents() = default;
  virtual void on_connected(PeerId peer, const std::string& remote_address) = 0;
  virtual void on_message(PeerId peer, Message message) = 0;
  /// The connection is gone; the peer's id is not used again. `failure` says why (kDisconnected: it
  /// closed; kProtocol: it sent what it must not, and was told so with a Refusal before being
  /// closed).
  virtual void on_closed(PeerId peer, const Failure& failure) = 0;
};

/// The coordinator's end: many connections, one thread, no locks. Frames go out whole and in order.
class Server {
 public:
  virtual ~Server() = default;
  /// Where to connect.
  virtual Address address() const = 0;
  /// Handles what is there; if nothing is, waits at most `max_wait` (0: does not wait) for
  /// something to come. Returns whether anything was handled.
  virtual bool poll(Duration max_wait) = 0;
  /// Queues a frame. A peer that does not read is closed when more than the queue's bound waits for
  /// it.
  virtual void send(PeerId peer, const Message& message) = 0;
  /// Sends what is queued, then closes; `on_closed` is not called for it.
  virtual void close(PeerId peer) = 0;
};

/// Listens on TCP with TCP_NODELAY; port 0 takes a free one. A peer that has not sent its first
/// whole frame within `hello_timeout` is closed.
/// @throws Error(kSetup) when the address cannot be bound.
std::unique_ptr<Server> listen_tcp(const Address& address, Duration hello_timeout,
                                   ServerEvents& events);

/// A new random token: 128 bits of the kernel's generator, in hex. @throws Error(kSetup).
std::string make_token();
/// Compares without telling, by its duration, where they differ.
bool tokens_equal(const std::string& a, const std::string& b);

}  // namespace tether::link
