#include "whole_file.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

namespace tether::sut {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class WholeFile : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_ = fs::path(::testing::TempDir()) / "whole_file_test";
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
  EXPECT_THAT(check_writable(folder_.string()).failure().message, HasSubstr("no regular file"));
  EXPECT_THAT(write_whole("/dev/null", "x").failure().message, HasSubstr("no regular file"));
  EXPECT_EQ(files(), 1);
}

}  // namespace
}  // namespace tether::sut
