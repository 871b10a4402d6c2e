#include "port.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}
const sockaddr* plain(const sockaddr_in& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

struct Socket {
  int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  Socket() = default;
  ~Socket() { ::close(fd); }
};

std::string received(int fd, sockaddr_in* from = nullptr) {
  std::array<char, 100> bytes{};
  socklen_t size = sizeof(sockaddr_in);
  const ssize_t got = ::recvfrom(fd, bytes.data(), bytes.size(), 0,
                                 reinterpret_cast<sockaddr*>(from), from ? &size : nullptr);
  return {bytes.data(), got > 0 ? static_cast<std::size_t>(got) : 0};
}

const std::vector<std::uint8_t> kHello = {'h', 'i'};

TEST(AsIsPort, KnowsThePortsOfCompanionsAndFlightControllers) {
  EXPECT_TRUE(Port::is_companion(plain(loopback(14540)), sizeof(sockaddr_in)));
  EXPECT_TRUE(Port::is_companion(plain(loopback(14550)), sizeof(sockaddr_in)));
  EXPECT_FALSE(Port::is_companion(plain(loopback(8080)), sizeof(sockaddr_in)));
  EXPECT_TRUE(Port::is_controller(plain(loopback(14580)), sizeof(sockaddr_in)));
  EXPECT_FALSE(Port::is_controller(nullptr, 0));
  EXPECT_TRUE(Port::is_controllers_stream(plain(loopback(5760)), sizeof(sockaddr_in)));
  EXPECT_TRUE(Port::is_controllers_stream(plain(loopback(14540)), sizeof(sockaddr_in)));
  EXPECT_FALSE(Port::is_controllers_stream(plain(loopback(8080)), sizeof(sockaddr_in)));
}

// Two programs on one machine can have the same port.
TEST(AsIsPort, ABoundSocketReceivesWhatIsDelivered) {
  Port one, other;
  const Socket a, b;
  const sockaddr_in wanted = loopback(14540);
  ASSERT_EQ(one.bind(a.fd, plain(wanted), sizeof wanted), 0);
  ASSERT_EQ(other.bind(b.fd, plain(wanted), sizeof wanted), 0);
  one.deliver(kHello);
  sockaddr_in from{};
  EXPECT_EQ(received(a.fd, &from), "hi");
  EXPECT_EQ(received(b.fd), "");
  const socklen_t size = sizeof from;
  one.believe(reinterpret_cast<sockaddr*>(&from), &size);
  EXPECT_EQ(ntohs(from.sin_port), 14580);
}

TEST(AsIsPort, ABoundSocketBelievesInItsPort) {
  Port port;
  const Socket socket;
  const sockaddr_in wanted = loopback(14540);
  ASSERT_EQ(port.bind(socket.fd, plain(wanted), sizeof wanted), 0);
  sockaddr_in seen{};
  socklen_t size = sizeof seen;
  ASSERT_TRUE(port.believed(socket.fd, reinterpret_cast<sockaddr*>(&seen), &size));
  EXPECT_EQ(ntohs(seen.sin_port), 14540);
}

TEST(AsIsPort, AForgottenSocketIsLeftAlone) {
  Port port;
  const Socket socket;
  const sockaddr_in wanted = loopback(14540);
  ASSERT_EQ(port.bind(socket.fd, plain(wanted), sizeof wanted), 0);
  EXPECT_TRUE(port.is_any());
  port.forget(socket.fd);
  EXPECT_FALSE(port.is_ours(socket.fd));
  EXPECT_FALSE(port.is_any());
  port.deliver(kHello);
  EXPECT_EQ(received(socket.fd), "");
}

// Of two programs, each has its own controller at the same port.
TEST(AsIsPort, AConnectionIsALineToTheController) {
  Port one, other;
  const int a = ::socket(AF_INET, SOCK_STREAM, 0), b = ::socket(AF_INET, SOCK_STREAM, 0);
  ASSERT_EQ(::fcntl(b, F_SETFL, O_NONBLOCK), 0);
  const sockaddr_in wanted = loopback(5760);
  ASSERT_EQ(one.connect_stream(a, plain(wanted), sizeof wanted), 0);
  EXPECT_EQ(other.connect_stream(b, plain(wanted), sizeof wanted), -1);
  EXPECT_EQ(errno, EINPROGRESS) << "a program that does not wait for it";
  EXPECT_TRUE(one.is_line(a));
  EXPECT_FALSE(one.is_serial(a));
  sockaddr_in peer{};
  socklen_t size = sizeof peer;
  ASSERT_EQ(::getpeername(a, reinterpret_cast<sockaddr*>(&peer), &size), 0);
  one.believe_peer(a, reinterpret_cast<sockaddr*>(&peer), &size);
  EXPECT_EQ(ntohs(peer.sin_port), 5760);
  const int copy = ::dup(a);
  one.copy(a, copy);
  one.deliver(kHello);
  EXPECT_EQ(received(copy), "hi") << "once, for both descriptors";
  EXPECT_EQ(received(b), "");
  ::shutdown(copy, SHUT_RDWR);
  for (int i = 0; i < 3; ++i) one.deliver(kHello);  // nobody reads: no signal
  for (const int fd : {a, copy}) one.forget(fd), ::close(fd);
  EXPECT_FALSE(one.is_any());
  other.forget(b);
  ::close(b);
}

}  // namespace
}  // namespace tether::as_is
