#include "shards_fixture.h"

#include <atomic>
#include <string_view>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/os/text_file.h>

namespace tether::shards {
namespace {

namespace fs = std::filesystem;

class HandIn : public ShardsTest {
 protected:
  HandIn() { fs::create_directory(out()); }
  const campaign::TrialPlan plan_ = plans().front();
  const fs::path trial_ = plan_.folder;
};

TEST_F(HandIn, BringsAFolderWholeOnceAndLeavesNothing) {
  const fs::path first = flown(plan_);
  fs::create_directory(first / "frames");
  os::write_file_atomically(first / "frames/1.svg", "picture");
  EXPECT_TRUE(hand_in(first, out(), trial_));
  EXPECT_EQ(os::read_file(out() / trial_ / "frames/1.svg"), "picture");
  EXPECT_FALSE(hand_in(flown(plan_, 5.0), out(), trial_));
  EXPECT_EQ(campaign::read_result(out() / trial_), campaign::read_result(first));
  EXPECT_TRUE(fs::is_empty(out() / campaign::kShardsFolder));
}

TEST_F(HandIn, ReplacesWhatDoesNotCount) {
  for (const std::string_view end : {campaign::kEndSetupFailed, campaign::kEndInterrupted}) {
    fs::remove_all(out() / trial_);
    EXPECT_TRUE(hand_in(flown(plan_, 4.0, end), out(), trial_));
    EXPECT_TRUE(hand_in(flown(plan_, 5.0), out(), trial_)) << end;
  }
  os::write_file_atomically(out() / trial_ / "result.json", "{ cut");
  EXPECT_TRUE(hand_in(flown(plan_, 6.0), out(), trial_));
  EXPECT_TRUE(campaign::has_result(out() / trial_));
}

TEST_F(HandIn, LetsOneOfManyWin) {
  std::vector<fs::path> folders;
  for (int i = 0; i < 8; ++i) folders.push_back(flown(plan_, 4.0 + i));
  std::atomic<int> won = 0;
  {
    std::vector<std::jthread> threads;
    for (const fs::path& folder : folders)
      threads.emplace_back([&, folder] { won += hand_in(folder, out(), trial_) ? 1 : 0; });
  }
  EXPECT_EQ(won, 1);
  EXPECT_TRUE(campaign::has_result(out() / trial_));
  EXPECT_TRUE(fs::is_empty(out() / campaign::kShardsFolder));
}

TEST_F(HandIn, SaysWhatTheFileSystemRefuses) {
  os::write_file_atomically(out() / "file", "");
  const Error error =
      thrown_error(ErrorCode::kSetup, [&] { hand_in(flown(plan_), out() / "file", trial_); });
  EXPECT_EQ(error.subject(), (out() / "file" / campaign::kShardsFolder).string());
}

}  // namespace
}  // namespace tether::shards
