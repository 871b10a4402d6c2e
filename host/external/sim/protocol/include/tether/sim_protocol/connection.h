#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/channel.h>
#include <tether/sim_protocol/messages.h>

namespace tether::sim::protocol {

/// Where a simulator listens: "unix:/run/sim.sock", "tcp://host:port".
using Endpoint = std::variant<std::filesystem::path, link::Address>;
/// Fails with kInvalid and the expected format.
Result<Endpoint> parse_endpoint(const std::string& text);
std::string to_string(const Endpoint& endpoint);

/// One end of a connection between host and simulator. Blocking; one thread sends and one receives
/// at a time, but `close` may be called from any thread at any time.
///
/// Failures: kDisconnected (the other end is gone, or `close` was called), kProtocol (the received
/// message is not allowed: unknown, malformed, too large, not finite, not the reply to the last
/// request, or with other sizes or times than requested), kTimeout, kInvalid (the message to be
/// sent fails `validate`; nothing was sent).
class Connection {
 public:
  virtual ~Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Fails with kTimeout if the simulator has read nothing for 30 s.
  virtual Status send(const Request& request) = 0;
  virtual Status send(const Reply& reply) = 0;
  /// A request that is not allowed (kProtocol), such as Open of another version, is answered with
  /// Failed before this fails. Every returned request fits Open: as many poses as bodies, valid UAV
  /// indices, step boundaries not before now, pictures no larger than announced.
  virtual Result<Request> receive_request() = 0;
  /// Fails with kTimeout if there is none within `limit`. A partly received one is kept.
  virtual Result<Reply> receive_reply(Duration limit) = 0;
  /// Unblocks all calls of this end, and ends the connection.
  virtual void close() = 0;

 protected:
  Connection() = default;
};

/// The host's end. Fails with kDisconnected if there is no listener, kTimeout if there is no
/// answer. While a simulator serves another host, it does not answer Open.
Result<std::unique_ptr<Connection>> connect(const Endpoint& endpoint, Duration timeout);

/// The simulator's side: waits for one host after the other.
class Listener {
 public:
  virtual ~Listener() = default;
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Blocks until a host connects. Fails with kDisconnected after `close`.
  virtual Result<std::unique_ptr<Connection>> accept() = 0;
  /// With the actual port if 0 was given.
  virtual Endpoint endpoint() const = 0;
  /// Unblocks `accept`. Any thread, any time.
  virtual void close() = 0;

 protected:
  Listener() = default;
};

/// Listens there. A Unix socket is accessible to its owner only (mode 0600), replaces one without a
/// listener, and is removed with the listener. Fails with kInvalid, the endpoint and the reason.
Result<std::unique_ptr<Listener>> listen(const Endpoint& endpoint);

}  // namespace tether::sim::protocol
