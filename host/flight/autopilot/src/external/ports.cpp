#include "external/ports.h"

#include <array>
#include <cerrno>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <tether/base/error.h>

namespace tether::autopilot {
namespace {

constexpr int kOn = 1;

sockaddr_in local(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// @throws Error(kSetup) if the port is in use
os::FileDescriptor bound(int type, std::uint16_t port, std::string_view user) {
  os::FileDescriptor socket(::socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  // Of TCP: connections of an earlier run that wait for their end are no reason.
  if (type == SOCK_STREAM) ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &kOn, sizeof kOn);
  const sockaddr_in address = local(port);
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw Error(ErrorCode::kSetup,
                fmt::format("cannot use {} port {}, which {} needs: {}. End what uses it, such as "
                            "another simulation",
                            type == SOCK_STREAM ? "TCP" : "UDP", port, user, reason_of(errno)));
  return socket;
}

void wait_for(const os::FileDescriptor& socket, Duration limit) {
  pollfd waits{socket.get(), POLLIN, 0};
  (void)::poll(
      &waits, 1,
      static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(limit).count()));
}

}  // namespace

UdpPort::UdpPort(std::uint16_t number, std::string_view user)
    : number_(number), socket_(bound(SOCK_DGRAM, number, user)) {
  sockaddr_in own{};
  socklen_t size = sizeof own;
  ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&own), &size);
  number_ = ntohs(own.sin_port);
}

std::vector<Bytes> UdpPort::receive(std::size_t most) {
  std::vector<Bytes> all;
  std::array<std::uint8_t, 65536> datagram;
  sockaddr_in from{};
  socklen_t size_of_from = sizeof from;
  for (ssize_t size = 0;
       all.size() < most &&
       (size = ::recvfrom(socket_.get(), datagram.data(), datagram.size(), 0,
                          reinterpret_cast<sockaddr*>(&from), &size_of_from)) > 0;) {
    if (peer_ == 0) peer_ = ntohs(from.sin_port);
    all.emplace_back(datagram.begin(), datagram.begin() + size);
  }
  return all;
}

void UdpPort::send(std::span<const std::uint8_t> bytes) {
  const sockaddr_in to = local(peer_);
  // As on a real link, nobody may listen.
  (void)::sendto(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
                 reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

void UdpPort::wait(Duration limit) const {
  wait_for(socket_, limit);
}

TcpPort::TcpPort(std::uint16_t number, std::string_view user)
    : number_(number), listener_(bound(SOCK_STREAM, number, user)) {
  if (::listen(listener_.get(), 1) != 0)
    throw Error(ErrorCode::kSetup, fmt::format("cannot wait for {} at TCP port {}: {}", user,
                                               number, reason_of(errno)));
}

bool TcpPort::accept() {
  if (!stream_)
    stream_ = os::FileDescriptor(
        ::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (stream_) ::setsockopt(stream_.get(), IPPROTO_TCP, TCP_NODELAY, &kOn, sizeof kOn);
  return static_cast<bool>(stream_);
}

std::vector<std::uint8_t> TcpPort::receive() {
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 4096> part{};
  for (ssize_t size = 0; (size = ::recv(stream_.get(), part.data(), part.size(), 0)) > 0;)
    bytes.insert(bytes.end(), part.begin(), part.begin() + size);
  return bytes;
}

void TcpPort::send(std::span<const std::uint8_t> bytes) {
  const ssize_t sent = ::send(stream_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent != static_cast<ssize_t>(bytes.size()))
    throw Error(ErrorCode::kLinkLost,
                "takes no more from the simulator: " + reason_of(sent < 0 ? errno : EAGAIN));
}

void TcpPort::wait(Duration limit) const {
  wait_for(stream_, limit);
}

}  // namespace tether::autopilot
