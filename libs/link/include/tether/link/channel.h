#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/codec.h>
#include <tether/link/messages.h>

namespace tether::link {

/// The SUT's end of a connection: blocking, whole messages. One thread sends requests and receives;
/// `send` may be called from several threads (progress), `receive` from one at a time.
class Channel {
 public:
  virtual ~Channel() = default;
  virtual Status send(const Message& message) = 0;
  /// Blocks until a whole message is there.
  virtual Result<Message> receive() = 0;
  /// Unblocks `receive` on this and the other end.
  virtual void close() = 0;
};

/// "host:port", "[v6]:port".
struct Address {
  std::string host;
  std::uint16_t port = 0;
};
Result<Address> parse_address(const std::string& text);
std::string to_string(const Address& address);

/// Connects over TCP with TCP_NODELAY (paper, Section II).
Result<std::unique_ptr<Channel>> connect_tcp(const Address& address, Duration timeout);

}  // namespace tether::link
