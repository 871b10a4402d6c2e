#include "peer.h"

#include <utility>
#include <variant>

#include <linux/sockios.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace tether::link {
namespace {

/// How long a connection that is being closed waits for its peer to close too.
constexpr std::chrono::seconds kDrainLimit{2};
/// Most reads before a close at the end: a peer may keep sending.
constexpr int kLastReads = 16;

std::vector<std::uint8_t> take_image(Message& message) {
  auto* reply = std::get_if<Reply>(&message);
  if (reply == nullptr || !reply->sample) return {};
  auto* camera = std::get_if<uav::CameraSample>(&*reply->sample);
  return camera == nullptr ? std::vector<std::uint8_t>{} : std::move(camera->rgb);
}

std::vector<std::uint8_t> copy(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

}  // namespace

Result<std::span<const std::uint8_t>> Peer::next_frame() {
  auto frame = input_.next();
  may_have_frame_ = frame && !frame->empty();
  if (may_have_frame_ && frames_++ == 0) {
    deadline.reset();
    input_.set_limit(kMaxRequestBytes);
  }
  return frame;
}

Status Peer::send(const FramePieces& pieces, Message& message) {
  if (queued_bytes_ > kMaxQueuedBytes || queue_.size() >= kMaxQueuedFrames) {
    const Failure failure{Failure::Kind::kDisconnected,
                          remote_ +
                              " does not read its messages: " + std::to_string(queued_bytes_) +
                              " bytes in " + std::to_string(queue_.size()) + " frames are queued"};
    die();
    return failure;
  }
  std::size_t done = 0;
  if (queue_.empty()) {
    const Transfer sent = send_some(descriptor(), pieces, 0);
    if (sent.error) {
      die();
      return lost(remote_, sent.error);
    }
    done = sent.bytes;
    sent_bytes_ += sent.bytes;
  }
  if (done < pieces.size()) enqueue(pieces, done, message);
  return ok_status();
}

void Peer::enqueue(const FramePieces& pieces, std::size_t done, Message& message) {
  QueuedFrame frame{copy(pieces.head), take_image(message), copy(pieces.tail), done};
  queued_bytes_ += frame.left();
  queue_.push_back(std::move(frame));
}

Status Peer::flush() {
  while (!queue_.empty()) {
    QueuedFrame& frame = queue_.front();
    const Transfer sent = send_some(descriptor(), frame.pieces(), frame.done);
    if (sent.error) {
      die();
      return lost(remote_, sent.error);
    }
    frame.done += sent.bytes;
    queued_bytes_ -= sent.bytes;
    sent_bytes_ += sent.bytes;
    if (frame.left() > 0) return ok_status();
    queue_.pop_front();
  }
  shut_when_flushed();
  return ok_status();
}

std::uint64_t Peer::moved_bytes() const {
  int unacknowledged = 0;
  ::ioctl(descriptor(), SIOCOUTQ, &unacknowledged);
  const std::size_t arrived = input_.arrived();
  const bool is_large = arrived + input_.missing() > kSmallFrameBytes;
  return sent_bytes_ - static_cast<std::uint64_t>(unacknowledged) + (is_large ? arrived : 0);
}

Result<bool> Peer::receive() {
  const Transfer received = receive_some(descriptor(), input_.space());
  if (received.error) {
    die();
    return lost(remote_, received.error);
  }
  if (received.ended) {
    input_has_ended_ = true;
    return Failure{Failure::Kind::kDisconnected, remote_ + " closed the connection"};
  }
  input_.commit(received.bytes);
  return received.bytes > 0;
}

void Peer::discard_input() {
  const Transfer received = receive_some(descriptor(), input_.space());
  if (received.error) die();
  if (!received.ended) return;
  input_has_ended_ = true;
  shut_when_flushed();
}

void Peer::drain() {
  if (state_ != State::kOpen) return;
  state_ = State::kDraining;
  deadline = std::chrono::steady_clock::now() + kDrainLimit;
  shut_when_flushed();
}

void Peer::shut_when_flushed() {
  if (state_ != State::kDraining || !queue_.empty()) return;
  ::shutdown(descriptor(), SHUT_WR);
  if (input_has_ended_) die();
}

void Peer::die() {
  state_ = State::kDead;
  deadline.reset();
  queue_.clear();
  queued_bytes_ = 0;
  socket_ = Descriptor();
}

void Peer::finish(std::chrono::steady_clock::time_point end) {
  while (state_ != State::kDead && wants_to_write()) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd entry{descriptor(), POLLOUT, 0};
    if (left.count() <= 0 || ::poll(&entry, 1, static_cast<int>(left.count())) <= 0) break;
    if (!flush()) return;
  }
  if (state_ == State::kDead) return;
  // Reading what is there keeps the close from becoming a reset.
  ::shutdown(descriptor(), SHUT_WR);
  for (int i = 0; i < kLastReads && receive_some(descriptor(), input_.space()).bytes > 0; ++i) {
  }
  die();
}

}  // namespace tether::link
