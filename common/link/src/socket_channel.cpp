#include "socket_channel.h"

#include <mutex>
#include <string>
#include <utility>

#include <tether/link/socket.h>

namespace tether::link {
namespace {

class SocketChannel final : public Channel {
 public:
  SocketChannel(Descriptor socket, std::string peer)
      : socket_(std::move(socket), std::move(peer), kMaxReplyBytes) {
    // A failure shows at the next message.
    socket_.on_slow_frame([this](std::size_t bytes) {
      static_cast<void>(send(Progress{.received_bytes = static_cast<std::uint32_t>(bytes)}));
    });
  }

  Status send(const Message& message) override;
  Result<Message> receive() override { return decoded(socket_.receive()); }
  Result<Message> receive_within(Duration timeout) override {
    return decoded(socket_.receive_within(timeout));
  }
  int descriptor() const override { return socket_.descriptor(); }
  void close() override { socket_.close(); }

 private:
  static Result<Message> decoded(const Result<std::span<const std::uint8_t>>& frame) {
    if (!frame) return frame.failure();
    return decode(*frame);
  }

  FrameSocket socket_;
  std::mutex sending_;
  Encoder encoder_;  // guarded by sending_
};

Status SocketChannel::send(const Message& message) {
  if (Status valid = validate(message); !valid) return valid;
  const std::lock_guard lock(sending_);
  return socket_.send(encoder_.encode_pieces(message));
}

}  // namespace

std::unique_ptr<Channel> make_socket_channel(Descriptor socket, std::string peer) {
  return std::make_unique<SocketChannel>(std::move(socket), std::move(peer));
}

}  // namespace tether::link
