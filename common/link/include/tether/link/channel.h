#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/codec.h>
#include <tether/link/messages.h>

namespace tether::link {

/// The SUT's end of a connection, for whole messages; calls block. `send` and `close` are
/// thread-safe; `receive` and `receive_within` may be called from one thread at a time. While a
/// message arrives slowly, they report that to the coordinator (Progress::received_bytes), so that
/// the SUT does not seem to hang.
class Channel {
 public:
  virtual ~Channel() = default;
  /// Fails with kInvalid (`validate` rejects the message; nothing was sent) or kDisconnected.
  virtual Status send(const Message& message) = 0;
  /// Blocks until a whole message has arrived. Fails with kDisconnected or kProtocol, after all
  /// messages that arrived before the connection ended.
  virtual Result<Message> receive() = 0;
  /// The same, but fails with kTimeout if no whole message has arrived after `timeout`. A message
  /// that arrived in part is not lost.
  virtual Result<Message> receive_within(Duration timeout) = 0;
  /// For a loop that polls several descriptors for input: when this one is readable, call
  /// `receive_within` with a timeout of 0 until it fails with kTimeout. −1: no descriptor.
  virtual int descriptor() const { return -1; }
  /// Ends the connection; unblocks `receive` on this and the other end.
  virtual void close() = 0;
};

/// "host:port", "[v6]:port".
struct Address {
  std::string host;  ///< a name, an IPv4 address, or an IPv6 address without brackets
  std::uint16_t port = 0;
  friend bool operator==(const Address&, const Address&) = default;
};
/// Fails with kInvalid and the expected form.
Result<Address> parse_address(const std::string& text);
std::string to_string(const Address& address);

/// Connects over TCP with TCP_NODELAY (paper, Section II), trying every address of the host in
/// turn. Fails with kDisconnected (name unknown, refused, unreachable) or kTimeout; the message
/// contains the address.
Result<std::unique_ptr<Channel>> connect_tcp(const Address& address, Duration timeout);

}  // namespace tether::link
