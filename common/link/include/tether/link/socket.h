#pragma once

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/channel.h>
#include <tether/link/codec.h>

/// System calls on sockets, for both ends of the link: one call per frame in each direction.
namespace tether::link {

/// Owns a file descriptor; -1: none.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Descriptor();

  int get() const { return value_; }
  bool is_open() const { return value_ >= 0; }

 private:
  int value_ = -1;
};

/// Repeats a system call that a signal interrupted.
template <class Call>
auto uninterrupted(Call call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

/// Longer limits are reduced to this, so that deadlines do not overflow.
inline constexpr Duration kLongestTimeout = std::chrono::hours(24 * 365);

/// Sets TCP_NODELAY, keep-alive probes that find a vanished peer within half a minute, and
/// close-on-exec. The system chooses the buffer sizes. Options that the system refuses are ignored.
void tune(int descriptor);
/// False: calls on it return `would_block` instead of waiting.
void set_blocking(int descriptor, bool blocks);

/// Calls that send return `would_block` if the peer has read nothing for `limit`.
void limit_sending(int descriptor, Duration limit);

/// The result of one call. `bytes` is 0 if the call would have blocked, failed, or found the end.
struct Transfer {
  std::size_t bytes = 0;
  bool would_block = false;
  bool ended = false;     ///< the peer closed its side (receiving only)
  std::error_code error;  ///< not set with would_block
};

/// Sends the pieces without their first `done` bytes, with one call.
Transfer send_some(int descriptor, const FramePieces& pieces, std::size_t done);
/// Receives into `space` with one call; with `whole`, blocks until it is full.
Transfer receive_some(int descriptor, std::span<std::uint8_t> space, bool whole = false);

/// A request often follows a reply at once: a command, then an image. Polling for this time before
/// sleeping saves the time to fall asleep and to wake up, which is most of an exchange.
inline constexpr std::chrono::microseconds kLookOut{20};
/// Whether there is more than one core, so that a polling thread leaves one to its peer.
bool may_look_out();

/// Whether one end of a connection should look out: seldom once it was in vain several times in a
/// row. With many connections, replies take longer, and polling takes cores from those that
/// compute.
class LookOut {
 public:
  static constexpr int kMostMisses = 8;  ///< in a row, before it pauses
  static constexpr int kPause = 32;      ///< waits without it, then one with it

  explicit LookOut(bool is_possible = may_look_out()) : is_possible_(is_possible) {}
  /// Call it before each wait.
  bool is_due() { return is_possible_ && (misses_ < kMostMisses || ++skipped_ > kPause); }
  /// Has looked out; `in_time`: a message came.
  void done(bool in_time) {
    misses_ = in_time ? 0 : misses_ + 1;
    skipped_ = 0;
  }

 private:
  bool is_possible_;
  int misses_ = 0;
  int skipped_ = 0;
};

/// Waits until the socket can be read or has ended. False: not within `timeout`.
bool wait_readable(int descriptor, Duration timeout);
/// Waits until the socket can be written to, or a pending connection was made or has failed.
bool wait_writable(int descriptor, Duration timeout);

/// A socket connected over TCP, tuned, trying every address of the host in turn. Fails with
/// kDisconnected (name unknown, refused, unreachable) or kTimeout; the message contains the
/// address.
Result<Descriptor> open_tcp(const Address& address, Duration timeout);

/// A socket that listens at `address`; port 0 takes a free one. Fails with kInvalid; the message
/// contains the address.
Result<Descriptor> listen_on_tcp(const Address& address);
/// The numeric address of this end of a TCP socket; empty if it has none.
Address local_address(int descriptor);

/// An accepted connection, or why there is none.
struct Accepted {
  Descriptor socket;  ///< tuned, does not block; closed if `error` is set
  Address remote;     ///< numeric
  std::error_code error;
};
/// Accepts one pending connection of a listening socket.
Accepted accept_tcp(int listening);

/// "the connection to HOST:PORT was lost: REASON".
Failure lost(const std::string& peer, const std::error_code& error);

/// Splits a byte stream into frames. The socket's bytes are received directly into it, as many as
/// there are, so that a small frame costs one system call. It grows to the largest frame and keeps
/// that size. The length in a header is checked against the limit before memory is allocated.
///
///   receive into space(), commit(n), then call next() until it returns an empty span.
class FrameBuffer {
 public:
  /// `limit`: the largest frame that is accepted [bytes].
  explicit FrameBuffer(std::uint32_t limit);
  /// From the next frame on.
  void set_limit(std::uint32_t limit) { limit_ = limit; }

  /// Space for the next bytes; never empty, and enough for the rest of a frame that has begun.
  /// Invalidates the frames that next() returned.
  std::span<std::uint8_t> space();
  /// The first `count` bytes of space() have been received.
  void commit(std::size_t count) { end_ += count; }

  /// The next whole frame, length included; empty if it has not arrived completely. Fails with
  /// kProtocol if its length is not allowed; the stream cannot be used after that.
  Result<std::span<const std::uint8_t>> next();

  /// Missing bytes of a frame whose header has arrived; 0 if there is none.
  std::size_t missing() const { return frame_bytes_ > size() ? frame_bytes_ - size() : 0; }
  /// Those of it that have arrived; 0 if there is none.
  std::size_t arrived() const { return missing() > 0 ? size() : 0; }

 private:
  std::size_t size() const { return end_ - begin_; }
  void make_room(std::size_t bytes);

  std::uint32_t limit_;
  std::size_t capacity_;
  std::unique_ptr<std::uint8_t[]> data_;  // not initialised: most of it is never touched
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t frame_bytes_ = 0;  // of the frame at begin_; 0: not known yet
};

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
