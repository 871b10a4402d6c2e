#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/codec.h>
#include <tether/link/frame_buffer.h>
#include <tether/link/socket.h>

namespace tether::link {

/// Whole frames over a connected, blocking stream socket of any family, whatever is in them.
/// Failures call the other end `peer`. One thread sends and one receives at a time; `close` may be
/// called from any thread at any time.
class FrameSocket {
 public:
  /// `limit`: the largest frame that the peer may announce [bytes].
  FrameSocket(Descriptor socket, std::string peer, std::uint32_t limit);

  /// Blocks until the whole frame is on its way. Fails with kDisconnected, or kTimeout where
  /// sending is limited (limit_sending) and the peer does not read; there is no way on after that.
  Status send(const FramePieces& frame);
  /// Blocks until a whole frame is there, length included; valid until the next call. Fails with
  /// kDisconnected, or kProtocol for a length that is not allowed; what arrived before the
  /// connection ended is delivered first.
  Result<std::span<const std::uint8_t>> receive() { return receive_until(std::nullopt); }
  /// The same, but fails with kTimeout if no whole frame is there after `timeout`; a frame that had
  /// begun to come is not lost.
  Result<std::span<const std::uint8_t>> receive_within(Duration timeout);

  int descriptor() const { return socket_.get(); }
  /// Ends the connection; unblocks whoever sends or receives on either end.
  void close();

 private:
  using Deadline = std::optional<std::chrono::steady_clock::time_point>;

  Result<std::span<const std::uint8_t>> receive_until(const Deadline& deadline);
  Status receive_more(const Deadline& deadline);
  void look_out() const;

  Descriptor socket_;
  bool may_look_out_ = may_look_out();
  std::string peer_;
  FrameBuffer input_;
};

}  // namespace tether::link
