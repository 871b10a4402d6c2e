#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include <tether/link/messages.h>
#include <tether/link/server.h>
#include <tether/link/socket.h>

namespace tether::system_test {

/// What `tether` may use more because of a hostile peer: what it queues for one, and a little.
inline constexpr long kMostExtraMemory_KiB = (link::kMaxQueuedBytes >> 10) + 8 * 1024;

/// A connection to a run that sends any bytes.
class RawPeer {
 public:
  /// @throws std::runtime_error when nothing listens there.
  explicit RawPeer(const std::string& address);

  /// False: the other end is gone, or has read nothing for five seconds.
  bool write(std::string_view bytes) const;
  bool write(const link::Message& message) const;
  /// The next message; none: the connection has ended, or nothing came within the limit.
  std::optional<link::Message> read(std::chrono::duration<double> limit);
  /// Reads on up to a Refusal; its text. Empty: the connection ended without, or the limit passed.
  std::string read_refusal(std::chrono::duration<double> limit);
  /// SHUT_RD or SHUT_WR.
  void shut(int how) const;
  /// Closing it then resets the connection instead of ending it.
  void reset_at_close() const;

 private:
  link::FrameSocket socket_;
};

/// As it goes over the wire.
std::string frame_of(const link::Message& message);

}  // namespace tether::system_test
