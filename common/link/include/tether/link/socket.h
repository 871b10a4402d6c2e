#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/channel.h>
#include <tether/link/codec.h>

/// What both ends do with a socket: the system calls themselves, one each way per frame.
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

/// Longer limits mean this one, so that a point in time can be reckoned.
inline constexpr Duration kLongestTimeout = std::chrono::hours(24 * 365);

/// No delay; keep-alive probes, so that a peer that vanished is noticed within half a minute; not
/// inherited by child processes. Buffer sizes are left to the system, which fits them to the
/// traffic. What the system does not grant is done without.
void tune(int descriptor);
/// False: calls on it return `would_block` instead of waiting.
void set_blocking(int descriptor, bool blocks);

/// Calls that send give up (`would_block`) when the peer has read nothing for so long.
void limit_sending(int descriptor, Duration limit);

/// What one call did. `bytes` is 0 when the call would have blocked, failed, or found the end.
struct Transfer {
  std::size_t bytes = 0;
  bool would_block = false;
  bool ended = false;     ///< the peer closed its side (receiving only)
  std::error_code error;  ///< not of would_block
};

/// Sends what is left of the pieces after the first `done` bytes with one call.
Transfer send_some(int descriptor, const FramePieces& pieces, std::size_t done);
/// Receives into `space` with one call; with `whole`, blocks until it is full.
Transfer receive_some(int descriptor, std::span<std::uint8_t> space, bool whole = false);

/// Replies and the next requests often come at once: a command, then an image. Looking out for them
/// so long before sleeping saves the time of falling asleep and waking, most of an exchange.
inline constexpr std::chrono::microseconds kLookOut{20};
/// Whether a thread that looks out leaves a core to its peer.
bool may_look_out();

/// Waits until the socket can be read (also: has ended). False: not within `timeout`.
bool wait_readable(int descriptor, Duration timeout);
/// Waits until the socket can be written to: a connection that was begun is made, or has failed.
bool wait_writable(int descriptor, Duration timeout);

/// A socket connected over TCP, tuned, trying every address of the host in turn. Fails with
/// kDisconnected (name unknown, refused, unreachable) or kTimeout; the text names the address.
Result<Descriptor> open_tcp(const Address& address, Duration timeout);

/// A socket that listens there; port 0 takes a free one. Fails with kInvalid, naming the address.
Result<Descriptor> listen_on_tcp(const Address& address);
/// This end of a TCP socket, in numbers; empty: it has none.
Address local_address(int descriptor);

/// What accepting came to.
struct Accepted {
  Descriptor socket;  ///< tuned, does not block; closed where `error` is set
  Address remote;     ///< in numbers
  std::error_code error;
};
/// Accepts one of the connections that wait at a listening socket.
Accepted accept_tcp(int listening);

/// "the connection to HOST:PORT was lost: REASON".
Failure lost(const std::string& peer, const std::error_code& error);

}  // namespace tether::link
