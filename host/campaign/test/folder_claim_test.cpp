#include <atomic>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/folder_claim.h>
#include <tether/campaign_testing/sample_campaign.h>
#include <tether/os/text_file.h>

/// With whole processes: tests/system/faults/faults_campaign_test.cpp.
namespace tether::campaign {
namespace {

using testing::HasSubstr;

class Claim : public testing::Test {
 protected:
  void make(const std::filesystem::path& folder) const {
    std::filesystem::create_directories(folder);
  }
  /// As a campaign of another process holds its folder.
  std::unique_ptr<PathLock> run_campaign_in(const std::filesystem::path& folder) const {
    make(folder);
    auto lock = std::make_unique<PathLock>(folder / kLockFile, true);
    lock->write("1");
    return lock;
  }
  std::string refusal(const std::filesystem::path& folder) const {
    return error_message(ErrorCode::kUsage, [&] { require_no_campaign(folder); });
  }

  ScratchFolder scratch_;
  const std::filesystem::path out_ = scratch_.path("out");
};

TEST_F(Claim, OfARunIsItsAlone) {
  make(out_);
  {
    const PathLock first(out_);
    EXPECT_TRUE(first.is_held());
    EXPECT_FALSE(PathLock(out_).is_held());
  }
  EXPECT_TRUE(PathLock(out_).is_held());
}

TEST_F(Claim, OfACampaignIsOfAllBelowIt) {
  const auto running = run_campaign_in(out_);
  EXPECT_THAT(refusal(out_), HasSubstr(out_.string() + ": a campaign is running in this folder;"));
  for (const auto& below : {out_ / "hover", out_ / "not/there/yet", out_ / "a/../b/"})
    EXPECT_THAT(refusal(below),
                HasSubstr(below.string() + ": a campaign is running in " + out_.string()));
  EXPECT_FALSE(std::filesystem::exists(out_ / "not"));
  EXPECT_NO_THROW(require_no_campaign(out_.parent_path()));
  EXPECT_NO_THROW(require_no_campaign(out_.string() + "side"));
}

TEST_F(Claim, IsSeenThroughALink) {
  const auto running = run_campaign_in(out_);
  const auto link = scratch_.path("link");
  std::filesystem::create_directory_symlink(out_, link);
  EXPECT_THAT(refusal(link / "hover"), HasSubstr("a campaign is running in"));
}

TEST_F(Claim, IsNotAgainstWhomTheCampaignStarted) {
  const auto running = run_campaign_in(out_);
  running->write(std::to_string(getppid()));
  EXPECT_NO_THROW(require_no_campaign(out_ / "hover"));
}

TEST_F(Claim, IsNotWhateverElseIsLocked) {
  make(out_);
  const PathLock foreign(out_ / ".lock", true);
  const PathLock own(out_ / kLockFile, true);
  ASSERT_TRUE(foreign.is_held() && own.is_held());
  for (const std::string text : {"", "0", "-1", "soon"}) {
    own.write(text);
    EXPECT_NO_THROW(require_no_campaign(out_ / "hover")) << text;
    EXPECT_NO_THROW(require_nobody_in(out_.parent_path())) << text;
  }
}

/// Somebody who looks whether the file is locked, again and again.
class Looker {
 public:
  explicit Looker(const std::filesystem::path& file)
      : descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Looker() {
    is_done_ = true;
    thread_.join();
    close(descriptor_);
  }
  Looker(const Looker&) = delete;
  Looker& operator=(const Looker&) = delete;

  int looks() const { return looks_; }

 private:
  void look() {
    while (!is_done_) {
      if (flock(descriptor_, LOCK_SH | LOCK_NB) == 0) ++looks_;
      flock(descriptor_, LOCK_UN);
    }
  }

  int descriptor_;
  std::atomic<int> looks_ = 0;
  std::atomic<bool> is_done_ = false;
  std::thread thread_{[this] { look(); }};
};

TEST_F(Claim, IsNotHinderedByWhoLooks) {
  make(out_);
  const Looker looker(out_);
  for (int i = 0; i < 50; ++i) {
    const int before = looker.looks();
    while (looker.looks() == before) std::this_thread::yield();
    EXPECT_TRUE(PathLock(out_).is_held()) << i;
  }
}

/// In a working directory that is removed, while this lives.
class Nowhere {
 public:
  explicit Nowhere(const std::filesystem::path& gone) {
    std::filesystem::create_directory(gone);
    std::filesystem::current_path(gone);
    std::filesystem::remove(gone);
  }
  ~Nowhere() { std::filesystem::current_path(before_); }
  Nowhere(const Nowhere&) = delete;
  Nowhere& operator=(const Nowhere&) = delete;

 private:
  std::filesystem::path before_ = std::filesystem::current_path();
};

TEST_F(Claim, NeedsToKnowWhereItIs) {
  std::filesystem::create_directory_symlink("round", scratch_.path("round"));
  const auto round = scratch_.path("round") / "out";
  EXPECT_THAT(error_message(ErrorCode::kSetup, [&] { require_no_campaign(round); }),
              HasSubstr(round.string() + ": cannot be found: Too many levels"));

  const Nowhere nowhere(scratch_.path("gone"));
  EXPECT_THAT(error_message(ErrorCode::kSetup, [&] { require_no_campaign("out"); }),
              HasSubstr("out: the working directory is not there any more; change to one"));
  EXPECT_NO_THROW(require_no_campaign(out_));
}

TEST_F(Claim, EndsWithItsHolder) {
  run_campaign_in(out_);
  EXPECT_TRUE(std::filesystem::exists(out_ / kLockFile));
  EXPECT_NO_THROW(require_no_campaign(out_ / "hover"));
}

TEST_F(Claim, OfACampaignOnItsTrialsStays) {
  const scenario::Campaign campaign = make_campaign(scratch_);
  const TrialPlan trial = plan_trials(campaign, out_).front();
  { const CampaignFolder folder(out_, campaign, {}, OpenMode::kFresh); }
  EXPECT_THAT(refusal(trial.folder),
              HasSubstr("is a trial of the campaign in " + out_.string() + ", whose results"));
  EXPECT_NO_THROW(require_no_campaign(out_));
  EXPECT_NO_THROW(require_no_campaign(trial.folder.parent_path()));
  EXPECT_NO_THROW(require_no_campaign(out_ / "another"));
}

TEST_F(Claim, OfACampaignNeedsNobodyBelow) {
  make(out_ / "a/b");
  EXPECT_NO_THROW(require_nobody_in(out_));
  const auto own = run_campaign_in(out_);
  EXPECT_NO_THROW(require_nobody_in(out_));
}

}  // namespace
}  // namespace tether::campaign
