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
  int number = -1;
  {
    FileDescriptor first = open_null();
    number = first.get();
    const FileDescriptor second = std::move(first);
    EXPECT_FALSE(first);  // NOLINT(bugprone-use-after-move)
    EXPECT_EQ(second.get(), number);
    EXPECT_TRUE(is_open(number));
  }
  EXPECT_FALSE(is_open(number));
}

TEST(FileDescriptor, AssignmentClosesThePreviousOne) {
  FileDescriptor owner = open_null();
  const int number = owner.get();
  owner = FileDescriptor();
  EXPECT_FALSE(owner);
  EXPECT_FALSE(is_open(number));
}

}  // namespace
}  // namespace tether::os
