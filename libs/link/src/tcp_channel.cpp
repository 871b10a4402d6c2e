#include "frame_buffer.h"
#include "socket.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <asio/connect.hpp>
#include <asio/io_context.hpp>
#include <sys/socket.h>

#include <tether/link/channel.h>

namespace tether::link {
namespace {

class TcpChannel final : public Channel {
 public:
  TcpChannel(std::unique_ptr<asio::io_context> context, Tcp::socket socket, std::string peer)
      : context_(std::move(context)),
        socket_(std::move(socket)),
        descriptor_(socket_.native_handle()),
        peer_(std::move(peer)) {
    tune(socket_);
  }

  Status send(const Message& message) override;
  Result<Message> receive() override { return receive_until(std::nullopt); }
  Result<Message> receive_within(Duration timeout) override {
    return receive_until(std::chrono::steady_clock::now() + std::min(timeout, kLongestTimeout));
  }
  void close() override { ::shutdown(descriptor(), SHUT_RDWR); }

 private:
  using Deadline = std::optional<std::chrono::steady_clock::time_point>;

  int descriptor() const { return descriptor_; }
  void look_out() const;
  Result<Message> receive_until(const Deadline& deadline);
  Status receive_more(const Deadline& deadline);

  std::unique_ptr<asio::io_context> context_;
  Tcp::socket socket_;
  int descriptor_;
  const bool may_look_out_ = may_look_out();
  std::string peer_;
  std::mutex sending_;
  Encoder encoder_;  // guarded by sending_
  FrameBuffer input_{kMaxReplyBytes};
};

Status TcpChannel::send(const Message& message) {
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

Result<Message> TcpChannel::receive_until(const Deadline& deadline) {
  while (true) {
    const auto frame = input_.next();
    if (!frame) return frame.failure();
    if (!frame->empty()) return decode(*frame);
    if (const Status more = receive_more(deadline); !more) return more.failure();
  }
}

void TcpChannel::look_out() const {
  if (!may_look_out_) return;
  const auto end = std::chrono::steady_clock::now() + kLookOut;
  while (!wait_readable(descriptor(), Duration(0)) && std::chrono::steady_clock::now() < end) {
  }
}

Status TcpChannel::receive_more(const Deadline& deadline) {
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

Failure cannot_connect(const Address& address, Failure::Kind kind, const std::string& why) {
  return {kind, "cannot connect to " + to_string(address) + ": " + why +
                    " (is the coordinator running there?)"};
}

}  // namespace

Result<std::unique_ptr<Channel>> connect_tcp(const Address& address, Duration timeout) {
  auto context = std::make_unique<asio::io_context>(1);
  std::error_code error;
  const auto endpoints =
      Tcp::resolver(*context).resolve(address.host, std::to_string(address.port), error);
  if (error) return cannot_connect(address, Failure::Kind::kDisconnected, error.message());

  Tcp::socket socket(*context);
  std::optional<std::error_code> outcome;
  asio::async_connect(socket, endpoints,
                      [&outcome](std::error_code e, const Tcp::endpoint&) { outcome = e; });
  context->run_for(std::min(timeout, kLongestTimeout));
  if (!outcome) {
    socket.close(error);
    context->run();  // the handler refers to this frame
    return cannot_connect(address, Failure::Kind::kTimeout, "no answer");
  }
  if (*outcome) return cannot_connect(address, Failure::Kind::kDisconnected, outcome->message());
  socket.native_non_blocking(false, error);
  return std::unique_ptr<Channel>(
      std::make_unique<TcpChannel>(std::move(context), std::move(socket), to_string(address)));
}

}  // namespace tether::link
