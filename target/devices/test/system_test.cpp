#include "system.h"

#include <array>
#include <cerrno>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::devices {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class SystemTest : public testing::Test {
 protected:
  ScratchFolder scratch_;
  System& system_ = real_system();
};

TEST_F(SystemTest, TellsKindsApart) {
  ASSERT_EQ(::mkfifo(scratch_.path("pipe").c_str(), 0600), 0);
  const std::vector<std::pair<std::string, FileKind>> kCases = {
      {scratch_.write("file", ""), FileKind::kRegular},
      {scratch_.path(), FileKind::kFolder},
      {"/dev/null", FileKind::kCharacterDevice},
      {scratch_.path("pipe"), FileKind::kOther}};
  for (const auto& [path, expected] : kCases) {
    FileKind kind{};
    EXPECT_EQ(system_.stat(path, kind), 0) << path;
    EXPECT_EQ(kind, expected) << path;
  }
  FileKind kind{};
  EXPECT_EQ(system_.stat(scratch_.path("missing"), kind), -ENOENT);
  // Opening a pipe does not wait for its other end.
  const Descriptor pipe(system_, system_.open(scratch_.path("pipe"), false));
  EXPECT_GE(pipe.number(), 0);
}

TEST_F(SystemTest, ReadsAFileAgain) {
  const Descriptor file(system_, system_.open(scratch_.write("file", "abc"), false));
  ASSERT_GE(file.number(), 0);
  std::array<char, 8> buffer{};
  EXPECT_EQ(system_.read_again(file.number(), buffer.data(), buffer.size()), 3);
  EXPECT_EQ(system_.read_again(file.number(), buffer.data(), buffer.size()), 3);
  EXPECT_EQ(std::string(buffer.data()), "abc");
}

TEST_F(SystemTest, GivesErrorsAsNegativeNumbers) {
  EXPECT_EQ(system_.open(scratch_.path("missing"), false), -ENOENT);
  std::array<char, 8> buffer{};
  EXPECT_EQ(system_.read_again(-1, buffer.data(), buffer.size()), -EBADF);
  EXPECT_EQ(system_.ioctl(-1, 0, nullptr), -EBADF);
}

TEST_F(SystemTest, ListsAFolderInOrder) {
  scratch_.write("b", "");
  scratch_.write("a", "");
  EXPECT_THAT(system_.list(scratch_.path()), ElementsAre("a", "b"));
  EXPECT_THAT(system_.list(scratch_.path("missing")), IsEmpty());
}

}  // namespace
}  // namespace tether::devices
