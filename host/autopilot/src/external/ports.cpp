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
#include <tether/base/system_reason.h>

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
os::FileDescriptor bound(int type, std::uint16_t port) {
  os::FileDescriptor socket(::socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  // Of TCP: connections of an earlier run that wait for their end are no reason.
  if (type == SOCK_STREAM) ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &kOn, sizeof kOn);
  const sockaddr_in address = local(port);
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw Error(ErrorCode::kSetup,
                fmt::format("cannot use {} port {}, which PX4 needs: {}. End what uses it, such as "
                            "another simulation",
                            type == SOCK_STREAM ? "TCP" : "UDP", port, reason_of(errno)));
  return socket;
}

void wait_for(const os::FileDescriptor& socket, Duration limit) {
  pollfd waits{socket.get(), POLLIN, 0};
  (void)::poll(
      &waits, 1,
      static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(limit).count()));
}

}  // namespace

Ports::Ports(int instance) {
  for (std::uint16_t* number :
       {&numbers_.simulator, &numbers_.companion, &numbers_.controller, &numbers_.ground})
    *number = static_cast<std::uint16_t>(*number + instance);
  listener_ = bound(SOCK_STREAM, numbers_.simulator);
  datagrams_ = bound(SOCK_DGRAM, numbers_.companion);
  // PX4 binds these itself.
  (void)bound(SOCK_DGRAM, numbers_.controller);
  (void)bound(SOCK_DGRAM, numbers_.ground);
  if (::listen(listener_.get(), 1) != 0)
    throw Error(ErrorCode::kSetup, fmt::format("cannot wait for PX4 at TCP port {}: {}",
                                               numbers_.simulator, reason_of(errno)));
}

bool Ports::accept() {
  if (!stream_)
    stream_ = os::FileDescriptor(
        ::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (stream_) ::setsockopt(stream_.get(), IPPROTO_TCP, TCP_NODELAY, &kOn, sizeof kOn);
  return static_cast<bool>(stream_);
}

std::vector<std::uint8_t> Ports::receive_stream() {
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 4096> part{};
  for (ssize_t size = 0; (size = ::recv(stream_.get(), part.data(), part.size(), 0)) > 0;)
    bytes.insert(bytes.end(), part.begin(), part.begin() + size);
  return bytes;
}

void Ports::send_stream(std::span<const std::uint8_t> bytes) {
  const ssize_t sent = ::send(stream_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent != static_cast<ssize_t>(bytes.size()))
    throw Error(ErrorCode::kLinkLost,
                "takes no more from the simulator: " + reason_of(sent < 0 ? errno : EAGAIN));
}

std::vector<Bytes> Ports::receive_datagrams() {
  std::vector<Bytes> all;
  std::array<std::uint8_t, 65536> datagram;
  for (ssize_t size = 0;
       (size = ::recv(datagrams_.get(), datagram.data(), datagram.size(), 0)) > 0;)
    all.emplace_back(datagram.begin(), datagram.begin() + size);
  return all;
}

void Ports::send_datagram(std::span<const std::uint8_t> bytes) {
  const sockaddr_in to = local(numbers_.controller);
  // As on a real link, nobody may listen.
  (void)::sendto(datagrams_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
                 reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

void Ports::wait_for_datagram(Duration limit) const {
  wait_for(datagrams_, limit);
}

void Ports::wait_for_stream(Duration limit) const {
  wait_for(stream_, limit);
}

}  // namespace tether::autopilot
