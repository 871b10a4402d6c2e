#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/text_file.h>
#include <tether/workers/shared_folder.h>

namespace tether::workers {
namespace {

class SharedFolderTest : public testing::Test {
 protected:
  ScratchFolder scratch_;
  SharedFolder folder_{scratch_.path()};
};

TEST_F(SharedFolderTest, CreatesAFileOnce) {
  EXPECT_TRUE(folder_.create("claim", "a"));
  EXPECT_FALSE(folder_.create("claim", "b"));
  EXPECT_EQ(folder_.read("claim"), "a");
  EXPECT_EQ(folder_.read("none"), std::nullopt);
  folder_.replace("claim", "c", "me");
  EXPECT_EQ(folder_.read("claim"), "c");
  EXPECT_THAT(folder_.list(""), testing::ElementsAre("claim"));
  EXPECT_TRUE(folder_.list("none").empty());
}

TEST_F(SharedFolderTest, PublishesAFolderWholeOnceAndLeavesNothing) {
  const auto local = scratch_.write("local/result.json", "first").parent_path();
  scratch_.write("local/frames/1.svg", "picture");
  EXPECT_TRUE(folder_.publish(local, "staging/w/1", "turn/host/seed-0001"));
  EXPECT_EQ(folder_.read("turn/host/seed-0001/frames/1.svg"), "picture");
  scratch_.write("local/result.json", "second");
  EXPECT_FALSE(folder_.publish(local, "staging/w/2", "turn/host/seed-0001"));
  EXPECT_EQ(folder_.read("turn/host/seed-0001/result.json"), "first");
  EXPECT_TRUE(folder_.list("staging/w").empty());
}

// At most 12 requests for each trial, with the four files that a flight leaves.
TEST_F(SharedFolderTest, PublishesATrialInFewRequests) {
  std::filesystem::path local;
  for (const char* name : {"result.json", "record.mcap", "run.log", "sut-uav1.log"})
    local = scratch_.write(std::string("local/") + name, "x").parent_path();
  folder_.make("staging/w");
  folder_.make("turn/host");
  const auto before = folder_.operations();
  EXPECT_TRUE(folder_.publish(local, "staging/w/1", "turn/host/seed-0001"));
  EXPECT_LE(folder_.operations() - before, 10u);
}

TEST_F(SharedFolderTest, SaysWhatTheFileSystemRefuses) {
  scratch_.write("file", "");
  const Error error = thrown_error(ErrorCode::kSetup, [&] { folder_.create("file/claim", "a"); });
  EXPECT_EQ(error.subject(), scratch_.path("file/claim").string());
}

}  // namespace
}  // namespace tether::workers
