#include "outside.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::as_is {
namespace {

constexpr pid_t kInit = 1;

TEST(Outside, AServerIsInsideIfOneOfTheProcessesListens) {
  for (const int family : {AF_INET, AF_INET6}) {
    const int server = ::socket(family, SOCK_STREAM, 0);
    ASSERT_EQ(::listen(server, 1), 0);
    sockaddr_in6 address{};  // has its port where that of IPv4 has it
    socklen_t size = sizeof address;
    ASSERT_EQ(::getsockname(server, reinterpret_cast<sockaddr*>(&address), &size), 0);
    const std::uint16_t port = ntohs(address.sin6_port);
    const pid_t own = ::getpid();
    EXPECT_EQ(listens_at(port, {&own, 1}), Who::kInside);
    EXPECT_EQ(listens_at(port, {&kInit, 1}), Who::kOutside);
    ::close(server);
    EXPECT_EQ(listens_at(port, {&own, 1}), Who::kNobody);
  }
}

TEST(Outside, ALockIsThatOfItsProcess) {
  const ScratchFolder scratch;
  const int file = ::open(scratch.path("lock").c_str(), O_RDWR | O_CREAT, 0600);
  const pid_t own = ::getpid();
  EXPECT_EQ(has_locked(file, {&own, 1}), Who::kNobody);
  ASSERT_EQ(::flock(file, LOCK_EX), 0);
  EXPECT_EQ(has_locked(file, {&own, 1}), Who::kInside);
  EXPECT_EQ(has_locked(file, {&kInit, 1}), Who::kOutside);
  ::close(file);
}

}  // namespace
}  // namespace tether::as_is
