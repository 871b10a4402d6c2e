#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/calibration/whole_file.h>

namespace tether::calibration {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class WholeFile : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name).string(); }
  std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator());
  }

  ScratchFolder folder_;
};

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST_F(WholeFile, IsWrittenAndReplaced) {
  EXPECT_TRUE(write_whole(path("a"), "first"));
  EXPECT_TRUE(write_whole(path("a"), "2"));
  EXPECT_EQ(text_of(path("a")), "2");
  EXPECT_EQ(files(), 1);
}

TEST_F(WholeFile, CheckingLeavesNothing) {
  EXPECT_TRUE(check_writable(path("a")));
  EXPECT_EQ(files(), 0);
  ASSERT_TRUE(write_whole(path("a"), "old"));
  EXPECT_TRUE(check_writable(path("a")));
  EXPECT_EQ(text_of(path("a")), "old");
}

TEST_F(WholeFile, WhatCannotBeWrittenIsNamed) {
  for (const std::string& bad : {path("none/a"), path("a/b")}) {
    ASSERT_TRUE(write_whole(path("a"), "a file, no folder"));
    for (const Status& status : {check_writable(bad), write_whole(bad, "x")}) {
      ASSERT_FALSE(status);
      EXPECT_EQ(status.failure().kind, Failure::Kind::kInvalid);
      EXPECT_THAT(status.failure().message, StartsWith(bad + ": cannot be written: "));
    }
  }
  EXPECT_THAT(check_writable(folder_.path().string()).failure().message,
              HasSubstr("no regular file"));
  EXPECT_THAT(write_whole("/dev/null", "x").failure().message, HasSubstr("no regular file"));
  EXPECT_EQ(files(), 1);
}

}  // namespace
}  // namespace tether::calibration
