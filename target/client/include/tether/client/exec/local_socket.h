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

/// The connection between a program and its tether-exec: a Unix socket with one frame of the link
/// in each packet, and once a descriptor (the clock page). A frame too long for a packet is sent as
/// sealed memory, so that a message is complete at once even if the receiver is frozen. One thread
/// can send while another receives; any thread can call `shut_down`.
class LocalSocket {
 public:
  explicit LocalSocket(os::FileDescriptor socket) : socket_(std::move(socket)) {}

  int descriptor() const { return socket_.get(); }

  /// Fails with kInvalid (the message is invalid) or kDisconnected (also if the receiver has not
  /// read earlier messages and the socket does not block).
  Status send(const link::Message& message);
  Status send_clock(const os::FileDescriptor& clock_page);

  /// One packet: a message or the clock page.
  struct Packet {
    std::optional<link::Message> message;
    os::FileDescriptor clock_page;
  };
  /// Fails with kTimeout (no packet within `timeout`; none: blocks), kDisconnected or kProtocol.
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

/// A listening socket at `path`. Other users cannot connect if its folder is private. Fails with
/// kInvalid and the error of the system.
Result<os::FileDescriptor> listen_local(const std::string& path);
/// Accepts a waiting connection without blocking; an empty descriptor if there is none.
os::FileDescriptor accept_local(const os::FileDescriptor& listener);

}  // namespace tether::client
