#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/campaign/campaign_plan.h>
#include <tether/campaign_testing/sample_campaign.h>

namespace tether::campaign {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

class CampaignPlan : public testing::Test {
 protected:
  ScratchFolder scratch_;
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

struct SideBySideCase {
  const char* what;
  scenario::Policy policy;
  scenario::Clock clock;
  double cpu_factor, real_time_factor;
  int uavs, jobs, expected;
};

TEST(TrialsSideBySide, AreAsManyAsDisturbNothing) {
  using enum scenario::Policy;
  using enum scenario::Clock;
  const SideBySideCase cases[] = {
      {"barrier", kConservativeBarrier, kCpu, 6.0, 0.0, 2, 4, 4},
      {"scripted", kConservativeBarrier, kScripted, 1.0, 0.0, 1, 4, 4},
      {"a wall clock", kConservativeBarrier, kWall, 1.0, 0.0, 1, 4, 1},
      {"free, a wall clock", kFreeRunning, kWall, 1.0, 0.3, 1, 4, 1},
      {"free, one core", kFreeRunning, kCpu, 20.0, 0.1, 1, 1, 1},
      // Each takes a sixth of a core and 0.15 of one; one core of the two may be in use.
      {"free, two cores", kFreeRunning, kCpu, 6.0, 0.3, 1, 2, 3},
      {"free, two UAVs on two cores", kFreeRunning, kCpu, 6.0, 0.3, 2, 2, 1},
      {"free, two UAVs on four cores", kFreeRunning, kCpu, 6.0, 0.3, 2, 4, 3},
      {"free, a SUT that is always busy", kFreeRunning, kCpu, 1.0, 1.0, 1, 2, 1},
  };
  for (const auto& c : cases) {
    scenario::Condition condition;
    condition.policy = c.policy;
    condition.clock = c.clock;
    condition.cpu_factor = c.cpu_factor;
    condition.real_time_factor = c.real_time_factor;
    scenario::Scenario scenario;
    scenario.uavs.resize(static_cast<std::size_t>(c.uavs));
    const TrialPlan plan{&scenario, &condition, 1, "out", false};
    EXPECT_EQ(parallel_trials(plan, c.jobs), c.expected) << c.what;
  }
}

TEST(TrialsSideBySide, AreOneOnATargetThatBindsItsSutsToCores) {
  scenario::Scenario scenario;
  scenario.uavs.resize(1);
  scenario::Condition condition;
  condition.target.emplace();
  const TrialPlan plan{&scenario, &condition, 1, "out", false};
  EXPECT_EQ(parallel_trials(plan, 4), 4);
  condition.target->cores = 1;
  EXPECT_EQ(parallel_trials(plan, 4), 1);
}

TEST(TrialsSideBySide, RunFreeAloneWhereTheSimulatorsLoadIsUnknown) {
  scenario::Scenario scenario;
  scenario.uavs.resize(1);
  scenario::Condition condition;
  condition.policy = scenario::Policy::kFreeRunning;
  condition.cpu_factor = 6.0;
  condition.real_time_factor = 0.3;
  const TrialPlan plan{&scenario, &condition, 1, "out", false};
  EXPECT_GT(parallel_trials(plan, 4), 1);
  condition.simulator = "gazebo";
  EXPECT_EQ(parallel_trials(plan, 4), 1);
  condition.policy = scenario::Policy::kConservativeBarrier;
  EXPECT_EQ(parallel_trials(plan, 4), 4);
}

TEST_F(CampaignPlan, RecordsTheImagesOfTheFirstSeedWhereAsked) {
  for (const TrialPlan& plan : plan_trials(campaign_, "out")) EXPECT_FALSE(plan.record_images);
  campaign_.images_of_first_seed = true;
  for (const TrialPlan& plan : plan_trials(campaign_, "out"))
    EXPECT_EQ(plan.record_images, plan.seed == campaign_.seeds.front());
}

TEST_F(CampaignPlan, BatchesPutWhatRunsFreeLast) {
  const auto plans = plan_trials(campaign_, "out");
  std::vector<const TrialPlan*> pointers;
  for (const TrialPlan& plan : plans) pointers.push_back(&plan);
  const std::vector<Batch> batches = make_batches(pointers, 2);
  ASSERT_EQ(batches.size(), 2u);
  EXPECT_EQ(batches[0].jobs, 2);
  EXPECT_EQ(batches[0].plans.size(), 6u);
  ASSERT_EQ(batches[1].plans.size(), 3u);
  for (const TrialPlan* plan : batches[1].plans)
    EXPECT_EQ(plan->condition->policy, scenario::Policy::kFreeRunning);
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

TEST_F(CampaignPlan, RefusesJobsWhereOneSimulatorHasAllRuns) {
  for (auto& condition : campaign_.scenarios[0].scenario.conditions) condition.simulator = "gazebo";
  EXPECT_NO_THROW(require_jobs_allowed(campaign_, 2));
  campaign_.scenarios[0].scenario.conditions[1].simulator = "tcp://lab:4500";
  EXPECT_NO_THROW(require_jobs_allowed(campaign_, 1));
  EXPECT_THAT(error_message(ErrorCode::kUsage, [&] { require_jobs_allowed(campaign_, 2); }),
              HasSubstr("flies in the simulator at tcp://lab:4500"));
}

TEST_F(CampaignPlan, SettingsAreVersionsAndDigestsOfFiles) {
  auto files = files_of(campaign_);
  files.push_back(scratch_.write("in/mesh.obj", "a mesh"));
  const Settings before = campaign_settings(campaign_, {{"tether", "0.1.0"}}, files);
  EXPECT_THAT(before,
              ElementsAre(Pair("file mesh.obj", testing::_), Pair("file room.sdf", testing::_),
                          Pair("file turn.toml", testing::_), Pair("tether", "0.1.0")));
  scratch_.write("in/room.sdf", "another world");
  const Settings after = campaign_settings(campaign_, {{"tether", "0.1.0"}}, files);
  EXPECT_NE(before.at("file room.sdf"), after.at("file room.sdf"));
  EXPECT_EQ(before.at("file turn.toml"), after.at("file turn.toml"));
}

TEST_F(CampaignPlan, TrialsAndSettingsNameTheProfileThatTheCampaignLaysOnTop) {
  EXPECT_EQ(plan_trials(campaign_, "out")[0].profile, "");
  const Settings before = campaign_settings(campaign_, {}, {});
  campaign_.scenarios[0].profile = scratch_.path("in/../rigs/slow.toml").lexically_normal();
  EXPECT_EQ(plan_trials(campaign_, "out")[0].profile, campaign_.scenarios[0].profile);
  EXPECT_THAT(before, testing::IsEmpty());
  EXPECT_THAT(campaign_settings(campaign_, {}, {}),
              ElementsAre(Pair("profile of turn", "../rigs/slow.toml")));
}

TEST_F(CampaignPlan, FilesAreAlsoThoseAmongTheFixedArgumentsOfASut) {
  const auto script = scratch_.write("in/sut.py", "import tether");
  const auto folder = script.parent_path();
  campaign_.scenarios[0].scenario.uavs[0].sut.command = {"python3", "-u", script, folder,
                                                         folder / "not-there"};
  const scenario::Scenario& s = campaign_.scenarios[0].scenario;
  EXPECT_THAT(files_of(campaign_), ElementsAre(s.world, s.file, script));
}

TEST_F(CampaignPlan, NamesTheFileThatIsNoLongerTheSame) {
  const auto world = campaign_.scenarios[0].scenario.world;
  const auto files = files_of(campaign_);
  const Settings settings = campaign_settings(campaign_, {{"tether", "0.1.0"}}, files);
  const auto complaint = [&] {
    return error_message(ErrorCode::kBadFile,
                         [&] { require_unchanged(campaign_, settings, files); });
  };
  EXPECT_NO_THROW(require_unchanged(campaign_, settings, files));
  scratch_.write("in/room.sdf", "another world");
  EXPECT_THAT(complaint(), AllOf(HasSubstr(world.string() + ": was changed"),
                                 HasSubstr("put it back and go on with --resume")));
  std::filesystem::remove(world);
  EXPECT_THAT(complaint(), HasSubstr(world.string() + ": was removed"));
  scratch_.write("in/room.sdf", "the world");
  EXPECT_NO_THROW(require_unchanged(campaign_, settings, files));
}

}  // namespace
}  // namespace tether::campaign
