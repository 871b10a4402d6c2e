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
/// Fails with kInvalid, saying what is expected.
Result<Endpoint> parse_endpoint(const std::string& text);
std::string to_string(const Endpoint& endpoint);

/// One end of a connection between host and simulator. Blocking; one thread sends and one receives
/// at a time, but `close` may be called from any thread at any time.
///
/// Failures: kDisconnected (the other end is gone, or `close` was called), kProtocol (what came is
/// no message that may come here: unknown, malformed, too large, not finite, an answer to something
/// else, sizes or times that do not fit what was asked), kTimeout, kInvalid (what is to be sent
/// breaks `validate`; nothing was sent).
class Connection {
 public:
  virtual ~Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// kTimeout: the simulator has read nothing for 30 s.
  virtual Status send(const Request& request) = 0;
  virtual Status send(const Reply& reply) = 0;
  /// A request that cannot be served (kProtocol), another version's Open among them, is answered
  /// with Failed before this fails. A request that comes fits Open: as many poses as bodies, UAVs
  /// that there are, step boundaries not before now, pictures no larger than announced.
  virtual Result<Request> receive_request() = 0;
  /// kTimeout: none is there within `limit`; one that has begun to come is not lost.
  virtual Result<Reply> receive_reply(Duration limit) = 0;
  /// Unblocks whoever sends or receives here, and ends the connection.
  virtual void close() = 0;

 protected:
  Connection() = default;
};

/// The host's end. Fails with kDisconnected where nobody listens, kTimeout where nobody answers.
/// A simulator that serves another host lets this one wait: it will not answer Open before.
Result<std::unique_ptr<Connection>> connect(const Endpoint& endpoint, Duration timeout);

/// The simulator's side: waits for hosts, one after the other.
class Listener {
 public:
  virtual ~Listener() = default;
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Blocks until a host connects. Fails with kDisconnected after `close`.
  virtual Result<std::unique_ptr<Connection>> accept() = 0;
  /// With the port that was taken where 0 was asked for.
  virtual Endpoint endpoint() const = 0;
  /// Unblocks `accept`. Any thread, any time.
  virtual void close() = 0;

 protected:
  Listener() = default;
};

/// Listens there. A Unix socket is the owner's only (mode 0600), takes the place of one that nobody
/// listens on any more, and its file goes with the listener. Fails with kInvalid, naming the
/// endpoint and why.
Result<std::unique_ptr<Listener>> listen(const Endpoint& endpoint);

}  // namespace tether::sim::protocol
