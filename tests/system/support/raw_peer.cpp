#include "raw_peer.h"

#include <stdexcept>
#include <variant>

#include <sys/socket.h>

#include <tether/link/codec.h>
#include <tether/link/socket.h>

namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

link::Descriptor connected_to(const std::string& address) {
  auto socket = link::open_tcp(link::parse_address(address).value(), 10s);
  if (!socket) throw std::runtime_error(socket.failure().message);
  link::limit_sending(socket->get(), 5s);
  return std::move(*socket);
}

}  // namespace

RawPeer::RawPeer(const std::string& address)
    : socket_(connected_to(address), address, link::kMaxReplyBytes) {}

bool RawPeer::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_.descriptor(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

bool RawPeer::write(const link::Message& message) const {
  return write(frame_of(message));
}

std::optional<link::Message> RawPeer::read(std::chrono::duration<double> limit) {
  const auto frame = socket_.receive_within(std::chrono::duration_cast<Duration>(limit));
  if (!frame) return std::nullopt;
  return link::decode(*frame).value();
}

std::string RawPeer::read_refusal(std::chrono::duration<double> limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (const auto message = read(end - std::chrono::steady_clock::now()))
    if (const auto* refusal = std::get_if<link::Refusal>(&*message)) return refusal->message;
  return "";
}

void RawPeer::shut(int how) const {
  ::shutdown(socket_.descriptor(), how);
}

void RawPeer::reset_at_close() const {
  const linger hard{1, 0};
  ::setsockopt(socket_.descriptor(), SOL_SOCKET, SO_LINGER, &hard, sizeof hard);
}

std::string frame_of(const link::Message& message) {
  link::Encoder encoder;
  const auto frame = encoder.encode(message);
  return {reinterpret_cast<const char*>(frame.data()), frame.size()};
}

}  // namespace tether::system_test
