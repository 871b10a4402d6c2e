#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/experiment/campaign_folder.h>
#include <tether/experiment/folder_claim.h>
#include <tether/experiment/text_file.h>
#include <tether/experiment_testing/sample_campaign.h>

/// With whole processes: tests/system/faults_campaign_test.cpp.
namespace tether::experiment {
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
}  // namespace tether::experiment
