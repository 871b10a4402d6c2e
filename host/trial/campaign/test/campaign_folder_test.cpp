#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign_testing/sample_campaign.h>
#include <tether/os/text_file.h>

namespace tether::campaign {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class Folder : public testing::Test {
 protected:
  CampaignFolder open(OpenMode mode) const {
    return CampaignFolder(out_, campaign_, settings_, mode);
  }
  /// Expects a refusal about the folder, or about a setting, that contains a value.
  void expect_refused(OpenMode mode, const std::string& value, std::string subject = "") const {
    const Error error = thrown_error(ErrorCode::kUsage, [&] { open(mode); });
    EXPECT_EQ(error.where().file, out_);
    EXPECT_EQ(error.subject(), subject.empty() ? out_.string() : subject);
    EXPECT_THAT(error.what(), HasSubstr(value));
  }
  std::filesystem::path keep(std::size_t trial) const {
    const TrialPlan plan = plan_trials(campaign_, out_)[trial];
    std::filesystem::create_directories(plan.folder);
    write_result(plan.folder, make_trial(*plan.scenario, plan.condition->name, plan.seed, 0, 2.5));
    return plan.folder / kResultFile;
  }

  ScratchFolder scratch_;
  std::filesystem::path out_ = scratch_.path("out");
  scenario::Campaign campaign_ = make_campaign(scratch_);
  Settings settings_ = {{"file room.sdf", "abc"}, {"tether", "0.1.0"}};
};

TEST_F(Folder, IsMadeWithItsManifestAndFindsWhatIsMissing) {
  EXPECT_EQ(open(OpenMode::kFresh).missing().size(), 9u);
  EXPECT_EQ(read_manifest(out_), manifest_of(campaign_, settings_));
  keep(0);
  keep(4);
  const auto report = scratch_.write("out/report.html", "of two trials");
  const CampaignFolder folder = open(OpenMode::kResume);
  EXPECT_FALSE(std::filesystem::exists(report));
  EXPECT_EQ(folder.finished().size(), 2u);
  ASSERT_EQ(folder.missing().size(), 7u);
  EXPECT_EQ(folder.missing()[0].condition->name, "target");
  EXPECT_EQ(folder.missing()[0].seed, 1u);
  EXPECT_THAT(folder.warnings(), IsEmpty());
}

TEST_F(Folder, IsRefusedBeforeAnyFileOfATrialIsRead) {
  const auto expect_refused_at_once = [&](const std::filesystem::path& folder, OpenMode mode,
                                          const char* why) {
    const Error error =
        thrown_error(ErrorCode::kUsage, [&] { require_folder(folder, campaign_, mode); });
    EXPECT_EQ(error.subject(), folder.string());
    EXPECT_THAT(error.what(), HasSubstr(why));
  };
  expect_refused_at_once(out_, OpenMode::kResume, "does not exist");
  scratch_.write("junit/a.xml", std::string(kJunitBegin) + "</testsuites>\n");
  require_folder(scratch_.path("junit"), campaign_, OpenMode::kFresh);
  scratch_.write("junit/b.txt", "");
  expect_refused_at_once(scratch_.path("junit"), OpenMode::kFresh, "contains no campaign");
  const auto file = scratch_.write("file", "");
  expect_refused_at_once(file, OpenMode::kReplace, "is a file, not a folder");
  expect_refused_at_once(file / "out", OpenMode::kFresh, "cannot be made, because");
  require_folder(out_ / "a/b", campaign_, OpenMode::kFresh);
  EXPECT_FALSE(std::filesystem::exists(out_));
  open(OpenMode::kFresh);
  require_folder(out_, campaign_, OpenMode::kFresh);
  keep(0);
  expect_refused_at_once(out_, OpenMode::kFresh, "already contains 1 result.");
  require_folder(out_, campaign_, OpenMode::kResume);
  campaign_.name = "other";
  expect_refused_at_once(out_, OpenMode::kReplace, "contains the campaign");
}

TEST_F(Folder, WarnsOfACorruptResultAndOfThatOfAnotherTrial) {
  open(OpenMode::kFresh);
  const auto one = keep(0), truncated = keep(3), other = keep(4);
  std::filesystem::resize_file(truncated, std::filesystem::file_size(truncated) / 2);
  std::filesystem::copy_file(one, other, std::filesystem::copy_options::overwrite_existing);
  const CampaignFolder folder = open(OpenMode::kResume);
  EXPECT_EQ(folder.finished().size(), 1u);
  EXPECT_THAT(folder.warnings(), ElementsAre(StartsWith(truncated.string() + ": "),
                                             StartsWith(other.parent_path().string() + ": ")));
}

TEST_F(Folder, RunsAgainWhatWasNotSetUpOrInterruptedButNotWhatFailed) {
  open(OpenMode::kFresh);
  const auto plans = plan_trials(campaign_, out_);
  TrialResult failed = make_setup_failure(*plans[0].scenario, *plans[0].condition, 1, "no port");
  std::filesystem::create_directories(plans[0].folder);
  for (const auto& [end, missing] : std::vector<std::pair<std::string_view, std::size_t>>{
           {kEndSetupFailed, 9}, {kEndInterrupted, 9}, {"sut_hung", 8}}) {
    failed.end = end;
    write_result(plans[0].folder, failed);
    EXPECT_EQ(open(OpenMode::kResume).missing().size(), missing) << end;
  }
}

TEST_F(Folder, RefusesToStartOverResults) {
  open(OpenMode::kFresh);
  EXPECT_NO_THROW(open(OpenMode::kFresh)) << "nothing was run yet";
  keep(0);
  expect_refused(OpenMode::kFresh, "1 result.");
}

TEST_F(Folder, ReplacesResultsOfTheSameCampaignOnly) {
  open(OpenMode::kFresh);
  const auto result = keep(0);
  settings_["tether"] = "0.2.0";
  EXPECT_EQ(open(OpenMode::kReplace).missing().size(), 9u);
  EXPECT_FALSE(std::filesystem::exists(result));
  keep(0);
  campaign_.name = "another";
  expect_refused(OpenMode::kReplace, "contains the campaign");
  EXPECT_TRUE(std::filesystem::exists(result));
}

TEST_F(Folder, RefusesToMixSettings) {
  open(OpenMode::kFresh);
  keep(0);
  settings_["tether"] = "0.2.0";
  expect_refused(OpenMode::kResume, "was 0.1.0 and is 0.2.0", "tether");
  settings_ = {{"tether", "0.1.0"}};
  expect_refused(OpenMode::kResume, "the file room.sdf is not used now", "file room.sdf");
  settings_ = {{"file room.sdf", "abc"}, {"new", "1"}, {"tether", "0.1.0"}};
  expect_refused(OpenMode::kFresh, "'new'", "new");
  EXPECT_EQ(read_manifest(out_).settings.at("tether"), "0.1.0");
}

TEST_F(Folder, TakesMoreSeedsConditionsAndScenarios) {
  const auto all = campaign_.scenarios[0].conditions;
  campaign_.scenarios[0].conditions = {"host"};
  open(OpenMode::kFresh);
  keep(0);
  campaign_.seeds.push_back(4);
  campaign_.scenarios[0].conditions = all;
  campaign_.scenarios.push_back(campaign_.scenarios[0]);
  campaign_.scenarios[1].scenario.name = "second";
  const CampaignFolder folder = open(OpenMode::kResume);
  EXPECT_EQ(folder.finished().size(), 1u);
  EXPECT_EQ(folder.missing().size(), 23u);
  EXPECT_THAT(read_manifest(out_).seeds, ElementsAre(1u, 2u, 3u, 4u));
}

TEST_F(Folder, RefusesToDropTrials) {
  campaign_.seeds = {1, 2, 3, 4, 5, 6, 7};
  open(OpenMode::kFresh);
  keep(0);
  const scenario::Campaign whole = campaign_;
  campaign_.seeds = {2, 3, 4, 5, 6};
  expect_refused(OpenMode::kResume, "seed 1, seed 7,");
  expect_refused(OpenMode::kFresh, "seed 1, seed 7,");
  campaign_.seeds = {1};
  expect_refused(OpenMode::kResume, "seed 5 and 2 more,");
  campaign_ = whole;
  campaign_.scenarios[0].conditions.erase(campaign_.scenarios[0].conditions.begin());
  expect_refused(OpenMode::kResume, "condition 'host' of 'turn'");
  campaign_ = whole;
  campaign_.scenarios[0].scenario.name = "other";
  expect_refused(OpenMode::kResume, "scenario 'turn'");

  EXPECT_EQ(read_manifest(out_).seeds, whole.seeds);
  campaign_ = whole;
  EXPECT_EQ(open(OpenMode::kResume).finished().size(), 1u);
}

TEST_F(Folder, IgnoresAPartlyWrittenManifest) {
  scratch_.write("out/campaign.json.part", "{");
  EXPECT_EQ(open(OpenMode::kFresh).missing().size(), 9u);
  EXPECT_EQ(read_manifest(out_), manifest_of(campaign_, settings_));
  EXPECT_FALSE(std::filesystem::exists(out_ / "campaign.json.part"));
}

TEST_F(Folder, RefusesAFolderOfSomethingElse) {
  scratch_.write("out/thesis.tex", "years of work");
  expect_refused(OpenMode::kFresh, "");
  expect_refused(OpenMode::kResume, "");
  EXPECT_FALSE(std::filesystem::exists(out_ / kCampaignFile));
}

TEST_F(Folder, RefusesToResumeWhereNothingHasBegun) {
  expect_refused(OpenMode::kResume, "does not exist");
  EXPECT_FALSE(std::filesystem::exists(out_));
  std::filesystem::create_directory(out_);
  expect_refused(OpenMode::kResume, "is empty");
  EXPECT_TRUE(std::filesystem::is_empty(out_));
  open(OpenMode::kReplace);
}

TEST_F(Folder, ResumesACampaignThatWasKilledBeforeItHadPlanned) {
  scratch_.write("out/" + std::string(kLockFile), "4711");
  EXPECT_EQ(open(OpenMode::kResume).missing().size(), 9u);
}

// Whichever comes first begins; what else shards leave is no content.
TEST_F(Folder, IsBegunOrContinuedByAShard) {
  std::filesystem::create_directories(out_ / kShardsFolder);
  EXPECT_EQ(open(OpenMode::kShard).missing().size(), 9u);
  EXPECT_EQ(open(OpenMode::kShard).missing().size(), 9u);
  EXPECT_EQ(open(OpenMode::kResume).missing().size(), 9u);
  campaign_.name = "other";
  expect_refused(OpenMode::kShard, "'study', not 'other'");
}

TEST_F(Folder, RefusesAnotherCampaignAndACorruptManifest) {
  open(OpenMode::kFresh);
  campaign_.name = "other";
  expect_refused(OpenMode::kResume, "'study', not 'other'");
  const auto manifest = scratch_.write("out/campaign.json", "{\"schema\": 1");
  EXPECT_EQ(bad_file_error([&] { open(OpenMode::kResume); }).where().file, manifest);
}

}  // namespace
}  // namespace tether::campaign
