#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/link/server.h>
#include <tether/link/socket.h>

namespace tether::link {

/// A frame that the socket did not take completely.
struct QueuedFrame {
  std::vector<std::uint8_t> head;
  std::vector<std::uint8_t> image;
  std::vector<std::uint8_t> tail;
  std::size_t done = 0;

  FramePieces pieces() const { return {head, image, tail}; }
  std::size_t left() const { return head.size() + image.size() + tail.size() - done; }
};

/// One connection of a TcpServer.
///
///   kOpen ──drain()──► kDraining ──peer closed or deadline──► kDead
///     └──────────────── connection lost ───────────────────────┘
///
/// While draining, queued frames are still sent, then our side is shut down; input is dropped.
/// Closing at once could lose a Refusal on its way, because unread input makes TCP reset the
/// connection. A peer whose input has ended may still be open or draining.
class Peer {
 public:
  enum class State { kOpen, kDraining, kDead };
  using Deadline = std::optional<std::chrono::steady_clock::time_point>;

  /// `socket`: connected, does not block.
  Peer(PeerId id, Descriptor socket, std::string remote)
      : id_(id), socket_(std::move(socket)), remote_(std::move(remote)) {}

  PeerId id() const { return id_; }
  const std::string& remote() const { return remote_; }
  State state() const { return state_; }
  int descriptor() const { return socket_.get(); }
  bool wants_to_write() const { return !queue_.empty(); }
  /// It has closed its sending side: nothing more can be received.
  bool input_has_ended() const { return input_has_ended_; }
  std::chrono::steady_clock::time_point since() const { return since_; }
  /// It has sent no whole frame yet, or was closed after its first one.
  bool is_stranger() const { return frames_ == 0 || (frames_ == 1 && state_ == State::kDraining); }

  /// Sends what the socket takes and queues the rest, whose image it takes out of `message`.
  /// Fails (and is dead then) if the connection is lost or too much is queued.
  Status send(const FramePieces& pieces, Message& message);
  /// Sends what is queued as far as the socket takes it.
  Status flush();
  /// Receives once. True if it received bytes. Fails at the end of its input, and (dead then) if
  /// the connection is lost.
  Result<bool> receive();
  /// The next whole frame; empty if there is none. The first one removes the deadline and raises
  /// the limit on sizes.
  Result<std::span<const std::uint8_t>> next_frame();
  /// See Server::moved_bytes. @pre it is not dead
  std::uint64_t moved_bytes() const;
  /// Another frame may have arrived with the last one.
  bool may_have_frame() const { return may_have_frame_ && state_ == State::kOpen; }
  /// Receives once and drops the bytes; dead if the peer has closed and nothing is queued for it.
  void discard_input();

  void drain();
  void die();
  /// Waits for the queue to empty, blocking until `end` at the latest, then closes.
  void finish(std::chrono::steady_clock::time_point end);

  Deadline deadline;               ///< of the first frame, or of draining
  std::optional<Failure> closing;  ///< still to be reported

 private:
  void enqueue(const FramePieces& pieces, std::size_t done, Message& message);
  void shut_when_flushed();

  PeerId id_;
  Descriptor socket_;
  std::string remote_;
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
  std::size_t frames_ = 0;  // taken so far
  bool may_have_frame_ = false;
  FrameBuffer input_{kMaxHelloBytes};
  std::deque<QueuedFrame> queue_;
  std::size_t queued_bytes_ = 0;
  std::uint64_t sent_bytes_ = 0;  // that the socket took
  State state_ = State::kOpen;
  bool input_has_ended_ = false;
};

}  // namespace tether::link
