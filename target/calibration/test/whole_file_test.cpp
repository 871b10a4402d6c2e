#include <filesystem>
#include <iterator>

#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/calibration/characterize.h>
#include <tether/os/text_file.h>

namespace tether::calibration {
namespace {

namespace fs = std::filesystem;

class WholeFile : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name).string(); }
  std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator());
  }

  ScratchFolder folder_;
};

TEST_F(WholeFile, IsCheckedWrittenAndReplaced) {
  EXPECT_TRUE(check_writable(path("a")));
  EXPECT_EQ(files(), 0);
  EXPECT_TRUE(write_whole(path("a"), "first"));
  EXPECT_TRUE(check_writable(path("a")));
  EXPECT_EQ(os::read_file(path("a")), "first");
  EXPECT_TRUE(write_whole(path("a"), "2"));
  EXPECT_EQ(os::read_file(path("a")), "2");
  EXPECT_EQ(files(), 1);
}

TEST_F(WholeFile, FailureNamesThePath) {
  ASSERT_TRUE(write_whole(path("a"), "a file, no folder"));
  for (const std::string& bad :
       {path("none/a"), path("a/b"), folder_.path().string(), std::string("/dev/null")}) {
    for (const Status& status : {check_writable(bad), write_whole(bad, "x")}) {
      ASSERT_FALSE(status);
      EXPECT_EQ(status.failure().kind, Failure::Kind::kInvalid);
      EXPECT_THAT(status.failure().message, ::testing::StartsWith(bad + ": "));
    }
  }
  EXPECT_EQ(files(), 1);
}

}  // namespace
}  // namespace tether::calibration
