#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/campaign/campaign_folder.h>
#include <tether/campaign_testing/sample_campaign.h>
#include <tether/os/text_file.h>

namespace tether::campaign {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Folder : public testing::Test {
 protected:
  CampaignFolder open(OpenMode mode) const {
    return CampaignFolder(out_, campaign_, settings_, mode);
  }
  std::string refusal(OpenMode mode) const {
    return error_message(ErrorCode::kUsage, [&] { open(mode); });
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

TEST_F(Folder, IsMadeWithItsManifest) {
  const CampaignFolder folder = open(OpenMode::kFresh);
  EXPECT_EQ(folder.missing().size(), 9u);
  EXPECT_EQ(folder.finished(), 0u);
  EXPECT_EQ(read_manifest(out_), manifest_of(campaign_, settings_));
}

TEST_F(Folder, FindsWhatIsMissing) {
  open(OpenMode::kFresh);
  keep(0);
  keep(4);
  const CampaignFolder folder = open(OpenMode::kResume);
  EXPECT_EQ(folder.finished(), 2u);
  ASSERT_EQ(folder.missing().size(), 7u);
  EXPECT_EQ(folder.missing()[0].condition->name, "target");
  EXPECT_EQ(folder.missing()[0].seed, 1u);
  EXPECT_THAT(folder.warnings(), IsEmpty());
}

TEST_F(Folder, DetectsATornResult) {
  open(OpenMode::kFresh);
  const auto file = keep(3);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  const CampaignFolder folder = open(OpenMode::kResume);
  EXPECT_EQ(folder.missing().size(), 9u);
  EXPECT_THAT(folder.warnings(), ElementsAre(HasSubstr("is torn or damaged")));
}

TEST_F(Folder, DetectsTheResultOfAnotherTrial) {
  open(OpenMode::kFresh);
  const auto one = keep(0);
  const auto other = keep(3);
  std::filesystem::copy_file(one, other, std::filesystem::copy_options::overwrite_existing);
  const CampaignFolder folder = open(OpenMode::kResume);
  EXPECT_EQ(folder.finished(), 1u);
  EXPECT_THAT(folder.warnings(), ElementsAre(HasSubstr("is of another trial")));
}

TEST_F(Folder, RunsAgainWhatNeverRanToItsEndButNotWhatFailed) {
  open(OpenMode::kFresh);
  const auto plans = plan_trials(campaign_, out_);
  TrialResult failed = make_setup_failure(*plans[0].scenario, *plans[0].condition, 1, "no port");
  std::filesystem::create_directories(plans[0].folder);
  write_result(plans[0].folder, failed);
  EXPECT_EQ(open(OpenMode::kResume).missing().size(), 9u);
  failed.end = kEndInterrupted;
  write_result(plans[0].folder, failed);
  EXPECT_EQ(open(OpenMode::kResume).missing().size(), 9u);
  failed.end = "sut_hung";
  write_result(plans[0].folder, failed);
  EXPECT_EQ(open(OpenMode::kResume).missing().size(), 8u);
}

TEST_F(Folder, RefusesToStartOverResults) {
  open(OpenMode::kFresh);
  EXPECT_NO_THROW(open(OpenMode::kFresh));  // nothing was run yet
  keep(0);
  EXPECT_THAT(refusal(OpenMode::kFresh), HasSubstr("already holds 1 of 9 trials; go on with"));
}

TEST_F(Folder, RefusesToMixSettings) {
  open(OpenMode::kFresh);
  keep(0);
  settings_["tether"] = "0.2.0";
  EXPECT_THAT(refusal(OpenMode::kResume), HasSubstr("'tether' was 0.1.0 and is 0.2.0"));
  settings_ = {{"tether", "0.1.0"}};
  EXPECT_THAT(refusal(OpenMode::kResume), HasSubstr("'file room.sdf' is no longer there"));
  settings_ = {{"file room.sdf", "abc"}, {"new", "1"}, {"tether", "0.1.0"}};
  EXPECT_THAT(refusal(OpenMode::kFresh), HasSubstr("'new' is new"));
  EXPECT_EQ(read_manifest(out_).settings.at("tether"), "0.1.0");
}

TEST_F(Folder, TakesMoreTrialsOfTheSame) {
  open(OpenMode::kFresh);
  keep(0);
  campaign_.seeds.push_back(4);
  const CampaignFolder folder = open(OpenMode::kResume);
  EXPECT_EQ(folder.finished(), 1u);
  EXPECT_EQ(folder.missing().size(), 11u);
  EXPECT_THAT(read_manifest(out_).seeds, ElementsAre(1u, 2u, 3u, 4u));
}

TEST_F(Folder, RefusesToDropTrials) {
  open(OpenMode::kFresh);
  keep(0);
  const scenario::Campaign whole = campaign_;
  const std::string advice = "choose another folder, or put it back";

  campaign_.seeds = {2};
  EXPECT_THAT(refusal(OpenMode::kResume),
              AllOf(HasSubstr("with seed 1, seed 3, which"), HasSubstr(advice)));
  EXPECT_THAT(refusal(OpenMode::kFresh), HasSubstr(advice));
  campaign_ = whole;
  campaign_.scenarios[0].conditions.erase(campaign_.scenarios[0].conditions.begin());
  EXPECT_THAT(refusal(OpenMode::kResume), HasSubstr("with condition 'host' of 'turn', which"));
  campaign_ = whole;
  campaign_.scenarios[0].scenario.name = "other";
  EXPECT_THAT(refusal(OpenMode::kResume), HasSubstr("with scenario 'turn', which"));

  EXPECT_THAT(read_manifest(out_).seeds, ElementsAre(1u, 2u, 3u));
  campaign_ = whole;
  EXPECT_EQ(open(OpenMode::kResume).finished(), 1u);
}

TEST_F(Folder, NamesAFewOfManyTrialsThatItWouldDrop) {
  campaign_.seeds = {1, 2, 3, 4, 5, 6, 7};
  open(OpenMode::kFresh);
  campaign_.seeds = {1};
  EXPECT_THAT(refusal(OpenMode::kResume), HasSubstr("seed 5, 2 more, which"));
}

TEST_F(Folder, TakesMoreConditionsAndScenarios) {
  const auto all = campaign_.scenarios[0].conditions;
  campaign_.scenarios[0].conditions = {"host"};
  open(OpenMode::kFresh);
  keep(0);
  campaign_.scenarios[0].conditions = all;
  campaign_.scenarios.push_back(campaign_.scenarios[0]);
  campaign_.scenarios[1].scenario.name = "second";
  EXPECT_EQ(open(OpenMode::kResume).missing().size(), 17u);
}

TEST_F(Folder, MakesNothingOfAManifestThatWasBeingWritten) {
  scratch_.write("out/campaign.json.part", "{");
  EXPECT_EQ(open(OpenMode::kFresh).missing().size(), 9u);
  EXPECT_EQ(read_manifest(out_), manifest_of(campaign_, settings_));
  EXPECT_FALSE(std::filesystem::exists(out_ / "campaign.json.part"));
}

TEST_F(Folder, RefusesAFolderOfSomethingElse) {
  scratch_.write("out/thesis.tex", "years of work");
  EXPECT_THAT(refusal(OpenMode::kFresh), HasSubstr("holds no campaign"));
  EXPECT_THAT(refusal(OpenMode::kResume), HasSubstr("holds no campaign"));
  EXPECT_FALSE(std::filesystem::exists(out_ / kCampaignFile));
}

TEST_F(Folder, RefusesAnotherCampaign) {
  open(OpenMode::kFresh);
  campaign_.name = "other";
  EXPECT_THAT(refusal(OpenMode::kResume), HasSubstr("holds the campaign 'study', not 'other'"));
}

TEST_F(Folder, IsHeldByOneAlone) {
  const CampaignFolder first = open(OpenMode::kFresh);
  EXPECT_THAT(refusal(OpenMode::kResume), HasSubstr("a campaign is running in this folder"));
}

TEST_F(Folder, RefusesADamagedManifest) {
  open(OpenMode::kFresh);
  scratch_.write("out/campaign.json", "{\"schema\": 1");
  error_message(ErrorCode::kBadFile, [&] { open(OpenMode::kResume); });
}

}  // namespace
}  // namespace tether::campaign
