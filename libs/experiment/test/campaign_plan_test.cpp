#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/experiment/campaign_plan.h>
#include <tether/experiment_testing/scratch.h>

namespace tether::experiment {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

class CampaignPlan : public testing::Test {
 protected:
  Scratch scratch_;
  scenario::Campaign campaign_ = make_campaign(scratch_);
};

TEST_F(CampaignPlan, HasSeedsOutermost) {
  std::vector<std::string> folders;
  for (const TrialPlan& plan : plan_trials(campaign_, "out")) folders.push_back(plan.folder);
  ASSERT_EQ(folders.size(), 9u);
  EXPECT_EQ(folders[0], "out/turn/host/seed-0001");
  EXPECT_EQ(folders[1], "out/turn/target/seed-0001");
  EXPECT_EQ(folders[2], "out/turn/target-no-sync/seed-0001");
  EXPECT_EQ(folders[3], "out/turn/host/seed-0002");
}

TEST_F(CampaignPlan, PointsIntoTheCampaign) {
  const auto plans = plan_trials(campaign_, "out");
  EXPECT_EQ(plans[5].scenario, &campaign_.scenarios[0].scenario);
  EXPECT_EQ(plans[5].condition, &campaign_.scenarios[0].scenario.conditions[2]);
  EXPECT_EQ(plans[5].seed, 2u);
}

TEST_F(CampaignPlan, OnlySynchronisedCpuOrScriptedTimeMayRunBesideOthers) {
  const auto& conditions = campaign_.scenarios[0].scenario.conditions;
  EXPECT_TRUE(may_run_beside_others(conditions[0]));
  EXPECT_TRUE(may_run_beside_others(conditions[1]));
  EXPECT_FALSE(may_run_beside_others(conditions[2]));
  scenario::Condition board = conditions[0];
  board.clock = scenario::Clock::kWall;
  EXPECT_FALSE(may_run_beside_others(board));
  scenario::Condition scripted = conditions[0];
  scripted.clock = scenario::Clock::kScripted;
  EXPECT_TRUE(may_run_beside_others(scripted));
}

TEST_F(CampaignPlan, RefusesJobsThatWouldDisturbAWallClock) {
  EXPECT_NO_THROW(require_jobs_allowed(campaign_, 1));
  EXPECT_NO_THROW(require_jobs_allowed(campaign_, 2));
  campaign_.scenarios[0].scenario.conditions[0].clock = scenario::Clock::kScripted;
  EXPECT_NO_THROW(require_jobs_allowed(campaign_, 2));
  EXPECT_THAT(error_message(ErrorCode::kUsage, [&] { require_jobs_allowed(campaign_, 0); }),
              HasSubstr("at least 1"));
  campaign_.scenarios[0].scenario.conditions[1].clock = scenario::Clock::kWall;
  EXPECT_NO_THROW(require_jobs_allowed(campaign_, 1));
  EXPECT_THAT(error_message(ErrorCode::kUsage, [&] { require_jobs_allowed(campaign_, 2); }),
              HasSubstr("condition 'target' of"));
}

TEST_F(CampaignPlan, SettingsAreVersionsAndDigestsOfFiles) {
  const auto more = scratch_.write("in/mesh.obj", "a mesh");
  const Settings before = campaign_settings(campaign_, {{"tether", "0.1.0"}}, {more});
  EXPECT_THAT(before,
              ElementsAre(Pair("file mesh.obj", testing::_), Pair("file room.sdf", testing::_),
                          Pair("file turn.toml", testing::_), Pair("tether", "0.1.0")));
  scratch_.write("in/room.sdf", "another world");
  const Settings after = campaign_settings(campaign_, {{"tether", "0.1.0"}}, {more});
  EXPECT_NE(before.at("file room.sdf"), after.at("file room.sdf"));
  EXPECT_EQ(before.at("file turn.toml"), after.at("file turn.toml"));
}

}  // namespace
}  // namespace tether::experiment
