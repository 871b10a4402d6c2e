#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/codec.h>
#include <tether/link/frame_buffer.h>
#include <tether/link/socket.h>

namespace tether::link {

/// Whole frames of any content over a connected, blocking stream socket of any family. Failures
/// name the other end `peer`. One thread sends and one receives at a time; `close` is thread-safe.
class FrameSocket {
 public:
  static constexpr std::chrono::milliseconds kSlowPeriod{100};

  /// `limit`: the largest frame that is accepted from the peer [bytes].
  FrameSocket(Descriptor socket, std::string peer, std::uint32_t limit);

  /// Blocks until the system has taken the whole frame. Fails with kDisconnected, or with kTimeout
  /// if the peer does not read (limit_sending); the socket cannot be used after that.
  Status send(const FramePieces& frame);
  /// Blocks until a whole frame has arrived, length included; valid until the next call. Fails with
  /// kDisconnected, or kProtocol for a length that is not allowed, after all frames that arrived
  /// before the connection ended.
  Result<std::span<const std::uint8_t>> receive() { return receive_until(std::nullopt); }
  /// The same, but fails with kTimeout if no whole frame has arrived after `timeout`. A frame that
  /// arrived in part is not lost.
  Result<std::span<const std::uint8_t>> receive_within(Duration timeout);

  /// From now on, the receiving thread calls `report` every kSlowPeriod while more bytes of a frame
  /// arrive but not the last, with their number so far.
  void on_slow_frame(std::function<void(std::size_t bytes)> report);

  int descriptor() const { return socket_.get(); }
  /// Ends the connection; unblocks calls that send or receive on either end.
  void close();

 private:
  using Deadline = std::optional<std::chrono::steady_clock::time_point>;

  Result<std::span<const std::uint8_t>> receive_until(const Deadline& deadline);
  Status receive_more(const Deadline& deadline);
  void look_out();
  void report_slow_frame();

  Descriptor socket_;
  LookOut look_out_;
  std::string peer_;
  FrameBuffer input_;
  std::function<void(std::size_t)> on_slow_frame_;
  Deadline
      reported_at_;  // of the frame that has arrived in part; before the first report, its begin
  std::size_t reported_ = 0;
};

}  // namespace tether::link
