#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/codec.h>
#include <tether/link/messages.h>

namespace tether::link {

/// The SUT's end of a connection: blocking, whole messages. `send` and `close` may be called from
/// any thread at any time, `receive` and `receive_within` from one thread at a time.
class Channel {
 public:
  virtual ~Channel() = default;
  /// Fails with kInvalid (the message breaks `validate`; nothing was sent) or kDisconnected.
  virtual Status send(const Message& message) = 0;
  /// Blocks until a whole message is there. Fails with kDisconnected or kProtocol; what arrived
  /// before the connection ended is delivered first.
  virtual Result<Message> receive() = 0;
  /// The same, but fails with kTimeout if no whole message is there after `timeout`; a message that
  /// had begun to come is not lost.
  virtual Result<Message> receive_within(Duration timeout) = 0;
  /// What a loop with other things to do may poll for input; then receives with a `timeout` of 0
  /// until that fails with kTimeout. −1: a channel without a descriptor.
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
/// Fails with kInvalid, saying what is expected.
Result<Address> parse_address(const std::string& text);
std::string to_string(const Address& address);

/// Connects over TCP with TCP_NODELAY (paper, Section II), trying every address of the host in
/// turn. Fails with kDisconnected (name unknown, refused, unreachable) or kTimeout; the text names
/// the address.
Result<std::unique_ptr<Channel>> connect_tcp(const Address& address, Duration timeout);

}  // namespace tether::link
