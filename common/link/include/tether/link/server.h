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

/// A peer has connected; it is a stranger until its first whole frame has arrived.
struct Connected {
  std::string remote_address;
};
/// No more messages come from a peer, because of `failure`. kDisconnected: it closed the
/// connection, or did not read its messages. kProtocol: it violated the protocol. kTimeout: it sent
/// no whole frame in time. In the latter two cases a Refusal with the reason was sent to it.
struct Closed {
  Failure failure;
  /// The peer has closed its sending side or the whole connection, which cannot be distinguished:
  /// it is kept, and messages can be sent to it until `close`. Otherwise the connection is gone.
  /// Always false for strangers.
  bool may_still_read = false;
};
/// An event of one peer.
struct Event {
  PeerId peer = 0;
  std::variant<Connected, Message, Closed> what;
};

/// Bytes that may be queued for a peer that reads slowly; one frame of any size can always be
/// queued.
inline constexpr std::size_t kMaxQueuedBytes = 16u << 20;
/// Frames of any size that may be queued for it. A SUT of 64 threads that reads has fewer.
inline constexpr std::size_t kMaxQueuedFrames = 1024;
/// Strangers are connections that have not sent a whole frame yet, or were refused because of their
/// first one. At most so many are accepted; others wait in the system's queue until one ends.
inline constexpr std::size_t kMaxStrangers = 128;
/// Time limit of a stranger while other connections wait; enough for a peer that sends at once.
inline constexpr Duration kCrowdedStay = std::chrono::milliseconds(500);

/// Larger than a Request without details, and than a Progress, which a SUT that hangs sends too.
inline constexpr std::size_t kSmallFrameBytes = 1024;

/// The coordinator's end: many connections, one thread, no locks. Frames go out whole and in order.
class Server {
 public:
  virtual ~Server() = default;
  /// Where to connect.
  virtual Address address() const = 0;
  /// Handles input and output, and returns the events. If there are none, waits for one for at most
  /// `max_wait` (0: does not wait). Returns at most one event per peer: if the caller closes a peer
  /// because of its event, the span has no other event of it, and no peer can delay the others or
  /// the caller. The caller may move messages out. The span is valid until the next poll.
  virtual std::span<Event> poll(Duration max_wait) = 0;
  /// Writes as much of the message to the connection as it takes at once, and queues the rest for
  /// `poll`. Move the message in: its image is then never copied. A peer for which more than
  /// kMaxQueuedBytes or kMaxQueuedFrames are queued already is closed instead (`Closed` comes from
  /// the next poll). Does nothing for a peer that is gone.
  /// @throws Error(kInternal) if `validate` rejects the message.
  virtual void send(PeerId peer, Message message) = 0;
  /// A number that changes while a frame is in transit: bytes that the peer's system has
  /// acknowledged, and those that have arrived of a frame of more than kSmallFrameBytes. 0 if the
  /// peer is gone.
  virtual std::uint64_t moved_bytes(PeerId id) = 0;
  /// Sends what is queued, then closes; no further event comes from this peer.
  virtual void close(PeerId peer) = 0;
};

/// Listens on TCP with TCP_NODELAY; port 0 takes a free one. A peer that has not sent its first
/// whole frame (kMaxHelloBytes at most) within `hello_timeout` after connecting is refused, even if
/// it keeps sending bytes. @throws Error(kSetup), about the address, if it cannot be bound.
std::unique_ptr<Server> listen_tcp(const Address& address, Duration hello_timeout);

/// A new random token: 128 bits of the kernel's generator, in hex. @throws Error(kSetup).
std::string make_token();
/// Compares in constant time for texts of one length. The length of a token is not secret.
bool tokens_equal(const std::string& a, const std::string& b);

}  // namespace tether::link
