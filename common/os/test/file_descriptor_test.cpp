#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <gtest/gtest.h>

#include <tether/os/file_descriptor.h>

namespace tether::os {
namespace {

bool is_open(int descriptor) {
  return fcntl(descriptor, F_GETFD) >= 0;
}

FileDescriptor open_null() {
  return FileDescriptor(open("/dev/null", O_RDONLY | O_CLOEXEC));
}

TEST(FileDescriptor, HasOneOwnerThatClosesIt) {
  FileDescriptor first = open_null();
  const int number = first.get();
  FileDescriptor second = std::move(first);
  EXPECT_FALSE(first);  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(second.get(), number);
  EXPECT_TRUE(is_open(number));
  second = FileDescriptor();
  EXPECT_FALSE(second);
  EXPECT_FALSE(is_open(number));
}

}  // namespace
}  // namespace tether::os
