#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign_testing/sample_campaign.h>
#include <tether/os/file_descriptor.h>

/// With whole programs: tests/system/faults/faults_campaign_test.cpp.
namespace tether::campaign {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using By = FolderClaim::By;

/// Another process that holds a claim until the object is destroyed, which kills it.
class OtherProcess {
 public:
  OtherProcess(const fs::path& folder, By by) {
    os::Pipe ready = os::make_pipe();
    pid_ = fork();
    if (pid_ == 0) hold(folder, by, ready.write_end);
    ready.write_end = {};
    char byte = 0;
    EXPECT_EQ(read(ready.read_end.get(), &byte, 1), 1);
  }
  ~OtherProcess() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  OtherProcess(const OtherProcess&) = delete;
  OtherProcess& operator=(const OtherProcess&) = delete;

  std::string pid() const { return std::to_string(pid_); }

 private:
  [[noreturn]] static void hold(const fs::path& folder, By by,
                                const os::FileDescriptor& ready) try {
    const FolderClaim claim(folder, by);
    os::write_all(ready, "!");
    for (;;) pause();
  } catch (...) {
    _exit(1);
  }

  pid_t pid_ = -1;
};

class Claim : public testing::Test {
 protected:
  static void claim(const fs::path& folder, By by) { const FolderClaim held(folder, by); }
  static Error refusal(const fs::path& folder, By by) {
    const Error error = thrown_error(ErrorCode::kUsage, [&] { claim(folder, by); });
    EXPECT_EQ(error.where().file, folder);
    EXPECT_EQ(error.subject(), folder);
    return error;
  }

  ScratchFolder scratch_;
  const fs::path out_ = scratch_.path("out");
};

TEST_F(Claim, OfARunExcludesOthersUntilItEnds) {
  {
    const FolderClaim first(out_, By::kRun);
    refusal(out_, By::kRun);
    refusal(out_, By::kCampaign);
    EXPECT_NO_THROW(claim(out_ / "below", By::kRun));
  }
  EXPECT_NO_THROW(claim(out_, By::kRun));
}

TEST_F(Claim, OfACampaignExcludesOthersFromItsFolderAndAllBelowUntilItIsKilled) {
  {
    const OtherProcess campaign(out_, By::kCampaign);
    fs::create_directory_symlink(out_, scratch_.path("link"));
    const auto expect_refused = [&](const fs::path& folder, By by) {
      EXPECT_THAT(refusal(folder, by).what(), HasSubstr("(process " + campaign.pid() + ")"));
    };
    expect_refused(out_, By::kCampaign);
    for (const fs::path& folder :
         {out_, out_ / "not/there/yet", out_ / "a/../b/", scratch_.path("link") / "hover"})
      expect_refused(folder, By::kRun);
    EXPECT_FALSE(fs::exists(out_ / "not"));
    EXPECT_NO_THROW(claim(out_.parent_path(), By::kRun));
    EXPECT_NO_THROW(claim(out_.string() + "side", By::kRun));
  }
  for (const fs::path& folder : {out_, out_ / "hover"}) EXPECT_NO_THROW(claim(folder, By::kRun));
  EXPECT_NO_THROW(claim(out_, By::kCampaign));
}

TEST_F(Claim, OfAShardAdmitsOtherShardsAndNoCampaign) {
  {
    const OtherProcess first(out_, By::kShard);
    claim(out_, By::kShard);
    refusal(out_, By::kCampaign);
  }
  const OtherProcess campaign(out_, By::kCampaign);
  EXPECT_THAT(refusal(out_, By::kShard).what(), HasSubstr("a campaign is running in"));
}

TEST_F(Claim, OfACampaignAdmitsTheProcessesThatItStarts) {
  const FolderClaim campaign(out_, By::kCampaign);
  const OtherProcess trial(out_ / "hover", By::kRun);
}

TEST_F(Claim, OfARunInACampaignsFolderExcludesTheCampaign) {
  claim(out_, By::kCampaign);
  {
    const FolderClaim run(out_ / "aside", By::kRun);
    refusal(out_, By::kCampaign);
    EXPECT_NO_THROW(claim(out_ / "another", By::kRun));
  }
  EXPECT_NO_THROW(claim(out_, By::kCampaign));
}

TEST_F(Claim, OfACampaignOnItsTrialsOutlivesIt) {
  const scenario::Campaign campaign = make_campaign(scratch_);
  const fs::path trial = plan_trials(campaign, out_).front().folder;
  { const CampaignFolder folder(out_, campaign, {}, OpenMode::kFresh); }
  EXPECT_THAT(refusal(trial, By::kRun).what(), HasSubstr(out_.string() + ", "));
  EXPECT_FALSE(fs::exists(trial));
  for (const fs::path& folder : {out_, trial.parent_path(), out_ / "another"})
    EXPECT_NO_THROW(claim(folder, By::kRun));
  scratch_.write("out/campaign.json", "{");
  EXPECT_NO_THROW(claim(trial, By::kRun)) << "no campaign that could be reported on";
}

TEST_F(Claim, NeedsAFolderThatCanBeFoundAndMade) {
  fs::create_directory_symlink("round", scratch_.path("round"));
  const fs::path file = scratch_.write("file", "text");
  const fs::path round = scratch_.path("round") / "out";
  EXPECT_EQ(thrown_error(ErrorCode::kSetup, [&] { claim(round, By::kRun); }).subject(), round);
  for (const fs::path& folder : {file, file / "out"})
    EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { claim(folder, By::kRun); }).subject(), folder);

  const fs::path before = fs::current_path(), gone = scratch_.path("gone");
  fs::create_directory(gone);
  fs::current_path(gone);
  fs::remove(gone);
  EXPECT_EQ(thrown_error(ErrorCode::kSetup, [&] { claim("out", By::kRun); }).subject(), "out");
  EXPECT_NO_THROW(claim(out_, By::kRun));
  fs::current_path(before);
}

}  // namespace
}  // namespace tether::campaign
