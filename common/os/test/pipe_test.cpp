#include <csignal>
#include <string>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/os/pipe.h>

namespace tether::os {
namespace {

TEST(Pipe, IsNotInheritedByPrograms) {
  const Pipe pipe = make_pipe();
  ASSERT_TRUE(pipe.read_end && pipe.write_end);
  EXPECT_EQ(fcntl(pipe.read_end.get(), F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
  EXPECT_EQ(fcntl(pipe.write_end.get(), F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
}

TEST(WriteAll, WritesMoreThanThePipeHolds) {
  Pipe pipe = make_pipe();
  const std::string text(1 << 20, 'x');
  std::size_t got = 0;
  std::jthread reader([&] {
    char block[4096];
    for (ssize_t n = 0; (n = read(pipe.read_end.get(), block, sizeof block)) > 0;)
      got += static_cast<std::size_t>(n);
  });
  EXPECT_TRUE(write_all(pipe.write_end, text));
  pipe.write_end = FileDescriptor();
  reader.join();
  EXPECT_EQ(got, text.size());
}

TEST(WriteAll, FailsWhenNobodyReads) {
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  Pipe pipe = make_pipe();
  pipe.read_end = FileDescriptor();
  EXPECT_FALSE(write_all(pipe.write_end, "text"));
  EXPECT_TRUE(write_all(pipe.write_end, ""));
  std::signal(SIGPIPE, before);
}

}  // namespace
}  // namespace tether::os
