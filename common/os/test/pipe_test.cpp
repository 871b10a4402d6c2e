#include <csignal>
#include <string>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/os/file_descriptor.h>

namespace tether::os {
namespace {

TEST(Pipe, IsNotInheritedByPrograms) {
  const Pipe pipe = make_pipe();
  ASSERT_TRUE(pipe.read_end && pipe.write_end);
  EXPECT_EQ(fcntl(pipe.read_end.get(), F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
  EXPECT_EQ(fcntl(pipe.write_end.get(), F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
}

TEST(WriteAll, WritesMoreThanThePipeHoldsAndFailsWithoutAReader) {
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  Pipe pipe = make_pipe();
  const std::string text(1 << 20, 'x');
  std::jthread reader([&] {
    std::string got(text.size(), ' ');
    for (std::size_t done = 0; done < got.size();) {
      const ssize_t n = read(pipe.read_end.get(), got.data() + done, got.size() - done);
      ASSERT_GT(n, 0);
      done += static_cast<std::size_t>(n);
    }
    EXPECT_EQ(got, text);
  });
  EXPECT_TRUE(write_all(pipe.write_end, text));
  reader.join();
  pipe.read_end = FileDescriptor();
  EXPECT_FALSE(write_all(pipe.write_end, "text"));
  std::signal(SIGPIPE, before);
}

}  // namespace
}  // namespace tether::os
