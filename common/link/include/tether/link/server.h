#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/channel.h>
#include <tether/link/codec.h>
#include <tether/link/messages.h>

namespace tether::link {

/// Identifies one connection for its whole life; never reused within a server.
using PeerId = std::uint64_t;

/// A peer has connected; it is a stranger until its first whole frame is there.
struct Connected {
  std::string remote_address;
};
/// A peer says no more. `failure` says why. kDisconnected: it closed, or did not read what it was
/// sent. kProtocol: it sent what it must not. kTimeout: it never sent a whole frame. In the latter
/// two cases a Refusal with the reason was sent to it.
struct Closed {
  Failure failure;
  /// It has closed its sending side, or all of it, which looks the same from here: it is kept, and
  /// can be sent to until `close`. Otherwise the connection is gone. Never of strangers.
  bool may_still_read = false;
};
/// What happened at one peer.
struct Event {
  PeerId peer = 0;
  std::variant<Connected, Message, Closed> what;
};

/// Bytes that may wait for a peer that reads slowly; one frame of any size may always wait.
inline constexpr std::size_t kMaxQueuedBytes = 16u << 20;
/// Frames that may wait for it, whatever their size. A SUT of 64 threads that reads has fewer.
inline constexpr std::size_t kMaxQueuedFrames = 1024;
/// Strangers are connections that have not sent a whole frame yet, or were sent away by what they
/// sent first. So many are there at the same time; more wait with the system until one goes.
inline constexpr std::size_t kMaxStrangers = 128;
/// While others wait, how long a stranger may stay; whoever speaks at once is not hurried by it.
inline constexpr Duration kCrowdedStay = std::chrono::milliseconds(500);

/// The coordinator's end: many connections, one thread, no locks. Frames go out whole and in order.
class Server {
 public:
  virtual ~Server() = default;
  /// Where to connect.
  virtual Address address() const = 0;
  /// Handles what is there. If nothing is, waits at most `max_wait` (0: does not wait) for
  /// something to come. Returns at most one event per peer: if the caller closes a peer because of
  /// its event, no other event of it is in the span, and no peer can delay the others or the
  /// caller. The caller may move messages out. The span is valid until the next poll.
  virtual std::span<Event> poll(Duration max_wait) = 0;
  /// Writes the message to the connection at once as far as it takes it, and keeps the rest for
  /// `poll`. Move the message in: its image is then never copied. A peer that does not read is
  /// closed (`Closed` comes from the next poll) when something is to be sent while more than
  /// kMaxQueuedBytes or kMaxQueuedFrames wait for it. Does nothing for a peer that is gone.
  /// @throws Error(kInternal) if the message breaks `validate`.
  virtual void send(PeerId peer, Message message) = 0;
  /// Sends what is queued, then closes; no event comes from this peer any more.
  virtual void close(PeerId peer) = 0;
};

/// Listens on TCP with TCP_NODELAY; port 0 takes a free one. A peer that has not sent its first
/// whole frame (kMaxHelloBytes at most) within `hello_timeout` of connecting is refused, however
/// steadily its bytes come. @throws Error(kSetup) when the address cannot be bound.
std::unique_ptr<Server> listen_tcp(const Address& address, Duration hello_timeout);

/// A new random token: 128 bits of the kernel's generator, in hex. @throws Error(kSetup).
std::string make_token();
/// Compares without telling, by its duration, where they differ. Their lengths may show: that of a
/// run's token is no secret, 32 unless somebody chose another one.
bool tokens_equal(const std::string& a, const std::string& b);

}  // namespace tether::link
