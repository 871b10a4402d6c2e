#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/codec.h>
#include <tether/link/messages.h>
#include <tether/os/file_descriptor.h>

namespace tether::client {

/// What goes between a program and its tether-exec: the frames of the link, one per packet of a
/// Unix socket, and once a descriptor (the clock page). A frame too long for a packet goes as a
/// sealed piece of memory, so that whatever is sent is there whole at once, also for a receiver
/// that is frozen. One thread may send while another receives; `shut_down` may come from any.
class LocalSocket {
 public:
  explicit LocalSocket(os::FileDescriptor socket) : socket_(std::move(socket)) {}

  int descriptor() const { return socket_.get(); }

  /// Fails with kInvalid (the message breaks `validate`) or kDisconnected (also: the receiver has
  /// not read what it was sent before, and the socket does not block).
  Status send(const link::Message& message);
  Status send_clock(const os::FileDescriptor& clock_page);

  /// One packet: a message, or else the clock page.
  struct Packet {
    std::optional<link::Message> message;
    os::FileDescriptor clock_page;
  };
  /// Fails with kTimeout (nothing there within `timeout`; none: blocks), kDisconnected or
  /// kProtocol.
  Result<Packet> receive(std::optional<Duration> timeout = std::nullopt);

  /// Ends the connection; unblocks `receive`.
  void shut_down();

 private:
  Status send_packet(const std::uint8_t* data, std::size_t bytes, int descriptor);
  Status send_as_memory(const link::FramePieces& pieces);

  os::FileDescriptor socket_;
  link::Encoder encoder_;
  std::vector<std::uint8_t> packet_;  // kept, so that steady use allocates nothing
  std::vector<std::uint8_t> input_;
};

/// Connects to the socket at `path`. Fails with kDisconnected.
Result<LocalSocket> connect_local(const std::string& path);

/// A listening socket at `path`, which no other user can connect to if the folder is private.
/// Fails with kInvalid, saying what the system refused.
Result<os::FileDescriptor> listen_local(const std::string& path);
/// The next connection that waits, not blocking; none: there is none.
os::FileDescriptor accept_local(const os::FileDescriptor& listener);

}  // namespace tether::client
