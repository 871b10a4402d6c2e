#include "socket_channel.h"

#include "frame_buffer.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <sys/socket.h>

namespace tether::link {
namespace {

class SocketChannel final : public Channel {
 public:
  SocketChannel(Descriptor socket, std::string peer)
      : socket_(std::move(socket)), peer_(std::move(peer)) {}

  Status send(const Message& message) override;
  Result<Message> receive() override { return receive_until(std::nullopt); }
  Result<Message> receive_within(Duration timeout) override {
    return receive_until(std::chrono::steady_clock::now() + std::min(timeout, kLongestTimeout));
  }
  int descriptor() const override { return socket_.get(); }
  void close() override { ::shutdown(descriptor(), SHUT_RDWR); }

 private:
  using Deadline = std::optional<std::chrono::steady_clock::time_point>;

  void look_out() const;
  Result<Message> receive_until(const Deadline& deadline);
  Status receive_more(const Deadline& deadline);

  Descriptor socket_;
  const bool may_look_out_ = may_look_out();
  std::string peer_;
  std::mutex sending_;
  Encoder encoder_;  // guarded by sending_
  FrameBuffer input_{kMaxReplyBytes};
};

Status SocketChannel::send(const Message& message) {
  if (Status valid = validate(message); !valid) return valid;
  const std::lock_guard lock(sending_);
  const FramePieces pieces = encoder_.encode_pieces(message);
  for (std::size_t done = 0; done < pieces.size();) {
    const Transfer sent = send_some(descriptor(), pieces, done);
    if (sent.error) return lost(peer_, sent.error);
    done += sent.bytes;
  }
  return ok_status();
}

Result<Message> SocketChannel::receive_until(const Deadline& deadline) {
  while (true) {
    const auto frame = input_.next();
    if (!frame) return frame.failure();
    if (!frame->empty()) return decode(*frame);
    if (const Status more = receive_more(deadline); !more) return more.failure();
  }
}

void SocketChannel::look_out() const {
  if (!may_look_out_) return;
  const auto end = std::chrono::steady_clock::now() + kLookOut;
  while (!wait_readable(descriptor(), Duration(0)) && std::chrono::steady_clock::now() < end) {
  }
}

Status SocketChannel::receive_more(const Deadline& deadline) {
  // Of a frame that has begun to come, the rest is fetched in one go.
  std::span<std::uint8_t> space = input_.space();
  const bool rest_of_frame = input_.missing() > 0 && !deadline;
  if (rest_of_frame) space = space.first(input_.missing());
  if (deadline && !wait_readable(descriptor(), *deadline - std::chrono::steady_clock::now())) {
    return Failure{Failure::Kind::kTimeout, "no answer from " + peer_ + " within the limit"};
  }
  if (!deadline && !rest_of_frame) look_out();
  const Transfer received = receive_some(descriptor(), space, rest_of_frame);
  if (received.error) return lost(peer_, received.error);
  if (received.ended) {
    return Failure{Failure::Kind::kDisconnected, peer_ + " closed the connection"};
  }
  input_.commit(received.bytes);
  return ok_status();
}

}  // namespace

std::unique_ptr<Channel> make_socket_channel(Descriptor socket, std::string peer) {
  return std::make_unique<SocketChannel>(std::move(socket), std::move(peer));
}

}  // namespace tether::link
