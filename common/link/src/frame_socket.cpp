#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include <sys/socket.h>
#include <sys/time.h>

#include <tether/link/socket.h>

namespace tether::link {

using Clock = std::chrono::steady_clock;

FrameSocket::FrameSocket(Descriptor socket, std::string peer, std::uint32_t limit)
    : socket_(std::move(socket)), peer_(std::move(peer)), input_(limit) {}

void FrameSocket::close() {
  ::shutdown(descriptor(), SHUT_RDWR);
}

Status FrameSocket::send(const FramePieces& frame) {
  for (std::size_t done = 0; done < frame.size();) {
    const Transfer sent = send_some(descriptor(), frame, done);
    if (sent.error) return lost(peer_, sent.error);
    if (sent.would_block) {
      return Failure{Failure::Kind::kTimeout, peer_ + " does not read its messages"};
    }
    done += sent.bytes;
  }
  return ok_status();
}

Result<std::span<const std::uint8_t>> FrameSocket::receive_within(Duration timeout) {
  return receive_until(Clock::now() + std::min(timeout, kLongestTimeout));
}

Result<std::span<const std::uint8_t>> FrameSocket::receive_until(const Deadline& deadline) {
  while (true) {
    const auto frame = input_.next();
    if (!frame || !frame->empty()) {
      reported_at_.reset();
      reported_ = 0;
      return frame;
    }
    if (on_slow_frame_ && input_.missing() > 0) report_slow_frame();
    if (const Status more = receive_more(deadline); !more) return more.failure();
  }
}

void FrameSocket::on_slow_frame(std::function<void(std::size_t)> report) {
  on_slow_frame_ = std::move(report);
  // A call that waits for the rest of a frame returns this often.
  const timeval period{0, std::chrono::microseconds(kSlowPeriod).count()};
  ::setsockopt(descriptor(), SOL_SOCKET, SO_RCVTIMEO, &period, sizeof period);
}

void FrameSocket::report_slow_frame() {
  const auto now = Clock::now();
  if (!reported_at_) reported_at_ = now;
  if (now - *reported_at_ < kSlowPeriod || input_.arrived() == reported_) return;
  reported_at_ = now;
  reported_ = input_.arrived();
  on_slow_frame_(reported_);
}

void FrameSocket::look_out() {
  if (!look_out_.is_due()) return;
  const auto end = Clock::now() + kLookOut;
  bool is_there = false;
  while (!is_there && Clock::now() < end) is_there = wait_readable(descriptor(), Duration(0));
  look_out_.done(is_there);
}

Status FrameSocket::receive_more(const Deadline& deadline) {
  // The rest of a frame that has begun is received with one call.
  std::span<std::uint8_t> space = input_.space();
  const bool rest_of_frame = input_.missing() > 0 && !deadline;
  if (rest_of_frame) space = space.first(input_.missing());
  if (!rest_of_frame && (!deadline || *deadline - Clock::now() > kLookOut)) look_out();
  if (deadline && !wait_readable(descriptor(), *deadline - Clock::now())) {
    return Failure{Failure::Kind::kTimeout, "timed out: no message from " + peer_};
  }
  const Transfer received = receive_some(descriptor(), space, rest_of_frame);
  if (received.error) return lost(peer_, received.error);
  if (received.ended) {
    return Failure{Failure::Kind::kDisconnected, peer_ + " closed the connection"};
  }
  input_.commit(received.bytes);
  return ok_status();
}

}  // namespace tether::link
