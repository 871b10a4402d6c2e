#include "socket_connection.h"

#include "conversation.h"

#include <mutex>
#include <string>
#include <utility>

#include <tether/link/socket.h>
#include <tether/sim_protocol/codec.h>

namespace tether::sim::protocol {
namespace {

class SocketConnection final : public Connection {
 public:
  SocketConnection(link::Descriptor socket, std::string peer)
      : socket_(std::move(socket), std::move(peer), kMaxFrameBytes) {}

  Status send(const Request& request) override;
  Status send(const Reply& reply) override;
  Result<Request> receive_request() override;
  Result<Reply> receive_reply(Duration limit) override;
  void close() override { socket_.close(); }

 private:
  Result<Request> next_request();
  template <class Message>
  Status send_encoded(const Message& message);

  link::FrameSocket socket_;
  std::mutex sending_;  // the receiving thread also sends, to refuse requests
  Encoder encoder_;
  Conversation conversation_;
};

template <class Message>
Status SocketConnection::send_encoded(const Message& message) {
  const std::lock_guard<std::mutex> lock(sending_);
  return socket_.send(encoder_.encode(message));
}

Status SocketConnection::send(const Request& request) {
  if (Status valid = validate(request); !valid) return valid;
  conversation_.ask(request);
  return send_encoded(request);
}

Status SocketConnection::send(const Reply& reply) {
  if (Status valid = validate(reply); !valid) return valid;
  return send_encoded(reply);
}

Result<Request> SocketConnection::next_request() {
  const auto frame = socket_.receive();
  if (!frame) return frame.failure();
  auto request = decode_request(*frame);
  if (!request) return request;
  if (const Status fits = conversation_.check(*request); !fits) return fits.failure();
  return request;
}

Result<Request> SocketConnection::receive_request() {
  auto request = next_request();
  if (request) {
    conversation_.ask(*request);
  } else if (request.failure().kind == Failure::Kind::kProtocol) {
    // The connection ends, whether this arrives or not.
    (void)send_encoded(Reply(Failed{request.failure().message}));
  }
  return request;
}

Result<Reply> SocketConnection::receive_reply(Duration limit) {
  const auto frame = socket_.receive_within(limit);
  if (!frame) return frame.failure();
  auto reply = decode_reply(*frame);
  if (!reply) return reply;
  if (const Status fits = conversation_.check(*reply); !fits) return fits.failure();
  return reply;
}

/// A hung simulator must not block the host.
constexpr Duration kSendLimit = std::chrono::seconds(30);

Result<std::unique_ptr<Connection>> made_by_host(link::Descriptor socket, std::string peer) {
  link::limit_sending(socket.get(), kSendLimit);
  return make_connection(std::move(socket), std::move(peer));
}

}  // namespace

std::unique_ptr<Connection> make_connection(link::Descriptor socket, std::string peer) {
  return std::make_unique<SocketConnection>(std::move(socket), std::move(peer));
}

Result<std::unique_ptr<Connection>> connect(const Endpoint& endpoint, Duration timeout) {
  const std::string peer = to_string(endpoint);
  if (const auto* path = std::get_if<std::filesystem::path>(&endpoint)) {
    auto socket = open_unix(*path, timeout);
    if (socket) return made_by_host(std::move(*socket), peer);
    return Failure{socket.failure().kind,
                   "cannot connect to " + peer + ": " + socket.failure().message};
  }
  auto socket = link::open_tcp(std::get<link::Address>(endpoint), timeout);
  if (!socket) return socket.failure();
  return made_by_host(std::move(*socket), peer);
}

}  // namespace tether::sim::protocol
