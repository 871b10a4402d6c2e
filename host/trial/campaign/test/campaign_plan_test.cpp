#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/campaign/campaign_plan.h>
#include <tether/campaign_testing/sample_campaign.h>

namespace tether::campaign {
namespace {

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
  EXPECT_EQ(folders.size(), 9u);
  folders.resize(4);
  EXPECT_THAT(folders, ElementsAre("out/turn/host/seed-0001", "out/turn/target/seed-0001",
                                   "out/turn/target-no-sync/seed-0001", "out/turn/host/seed-0002"));
}

// Otherwise, what alternates from flight to flight looks like a condition.
TEST_F(CampaignPlan, FliesTheConditionsOfASeedInAnOrderOfItsOwn) {
  campaign_.seeds = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const auto plans = plan_trials(campaign_, "out");
  std::vector<const TrialPlan*> pointers;
  for (const TrialPlan& plan : plans) pointers.push_back(&plan);
  const auto flown = in_order_of_flight(pointers);
  EXPECT_EQ(flown, in_order_of_flight(pointers));
  EXPECT_THAT(flown, testing::UnorderedElementsAreArray(pointers));
  std::map<const scenario::Condition*, int> firsts;
  for (std::size_t i = 0; i < flown.size(); ++i) {
    EXPECT_EQ(flown[i]->seed, pointers[i]->seed);
    if (i % 3 == 0) ++firsts[flown[i]->condition];
  }
  EXPECT_EQ(firsts.size(), 3u);
}

TEST_F(CampaignPlan, PointsIntoTheCampaign) {
  const auto plan = plan_trials(campaign_, "out")[5];
  EXPECT_EQ(plan.scenario, &campaign_.scenarios[0].scenario);
  EXPECT_EQ(plan.condition, &campaign_.scenarios[0].scenario.conditions[2]);
  EXPECT_EQ(plan.seed, 2u);
  EXPECT_EQ(plan.profile, "");
  for (const bool images : {false, true}) {
    campaign_.images_of_first_seed = images;
    for (const TrialPlan& one : plan_trials(campaign_, "out"))
      EXPECT_EQ(one.record_images, images && one.seed == 1);
  }
}

struct ParallelCase {
  const char* what;
  scenario::Policy policy;
  computer::ClockKind clock;
  double cpu_factor, real_time_factor;
  int uavs, jobs, expected;
  const char* simulator = "mujoco";
  int cores = 0;
};

TEST(ParallelTrials, AreAsManyAsDisturbNothing) {
  using enum scenario::Policy;
  using enum computer::ClockKind;
  const ParallelCase cases[] = {
      {"barrier", kConservativeBarrier, kCpu, 6.0, 0.0, 2, 4, 4},
      {"scripted", kConservativeBarrier, kScripted, 1.0, 0.0, 1, 4, 4},
      {"a wall clock", kConservativeBarrier, kWall, 1.0, 0.0, 1, 4, 1},
      {"the coordinator's clock", kConservativeBarrier, kUnstamped, 1.0, 0.0, 1, 4, 1},
      {"barrier in Gazebo", kConservativeBarrier, kCpu, 6.0, 0.0, 1, 4, 4, "gazebo"},
      {"a target of one core", kConservativeBarrier, kCpu, 1.0, 0.0, 1, 4, 1, "mujoco", 1},
      {"free, a wall clock", kFreeRunning, kWall, 1.0, 0.3, 1, 4, 1},
      {"free, one core", kFreeRunning, kCpu, 20.0, 0.1, 1, 1, 1},
      // Each takes a sixth of a core and 0.15 of one; one core of the two may be in use.
      {"free, two cores", kFreeRunning, kCpu, 6.0, 0.3, 1, 2, 3},
      {"free, two UAVs on two cores", kFreeRunning, kCpu, 6.0, 0.3, 2, 2, 1},
      {"free, two UAVs on four cores", kFreeRunning, kCpu, 6.0, 0.3, 2, 4, 3},
      {"free, a SUT that is always busy", kFreeRunning, kCpu, 1.0, 1.0, 1, 2, 1},
      {"free in Gazebo, whose load is unknown", kFreeRunning, kCpu, 6.0, 0.3, 1, 4, 1, "gazebo"},
  };
  for (const auto& c : cases) {
    scenario::Condition condition;
    condition.policy = c.policy;
    condition.computers[0].clock.kind = c.clock;
    condition.computers[0].clock.factor = c.cpu_factor;
    condition.real_time_factor = c.real_time_factor;
    condition.simulator = c.simulator;
    condition.computers[0].target.emplace().cores = c.cores;
    scenario::Scenario scenario;
    scenario.uavs.resize(static_cast<std::size_t>(c.uavs));
    const TrialPlan plan{&scenario, &condition, 1, "out", false};
    EXPECT_EQ(parallel_trials(plan, c.jobs), c.expected) << c.what;
  }
}

TEST(ParallelTrials, AreNoneWithAFlightControllerOfFixedPorts) {
  scenario::Condition condition;
  condition.policy = scenario::Policy::kConservativeBarrier;
  condition.computers[0].clock.kind = computer::ClockKind::kScripted;
  for (const auto& [has_fixed_ports, expected] : {std::pair{false, 4}, {true, 1}}) {
    scenario::Scenario scenario;
    scenario.uavs.resize(1);
    scenario.uavs[0].flight_controller.emplace().has_fixed_ports = has_fixed_ports;
    EXPECT_EQ(parallel_trials({&scenario, &condition, 1, "out", false}, 4), expected);
  }
}

TEST_F(CampaignPlan, BatchesPutFreeRunningTrialsLast) {
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

TEST_F(CampaignPlan, RefusesJobsThatItsConditionsDoNotAllow) {
  auto& conditions = campaign_.scenarios[0].scenario.conditions;
  const auto expect_refused = [&](int jobs, const std::string& value) {
    const Error error =
        thrown_error(ErrorCode::kUsage, [&] { require_jobs_allowed(campaign_, jobs); });
    EXPECT_EQ(error.subject(), "--jobs");
    EXPECT_THAT(error.what(), HasSubstr(value));
  };
  conditions[0].computers[0].clock.kind = computer::ClockKind::kScripted;
  conditions[0].simulator = "gazebo";
  EXPECT_NO_THROW(require_jobs_allowed(campaign_, 2));
  expect_refused(0, "--jobs 0");
  conditions[1].computers[0].clock.kind = computer::ClockKind::kWall;
  EXPECT_NO_THROW(require_jobs_allowed(campaign_, 1));
  expect_refused(2, "'target'");
  conditions[1].simulator = "tcp://lab:4500";
  EXPECT_NO_THROW(require_jobs_allowed(campaign_, 1));
  expect_refused(2, "tcp://lab:4500");
}

TEST_F(CampaignPlan, SettingsAreVersionsDigestsOfFilesAndProfiles) {
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
  campaign_.scenarios[0].profile = scratch_.path("rigs/slow.toml");
  EXPECT_EQ(plan_trials(campaign_, "out")[0].profile, campaign_.scenarios[0].profile);
  EXPECT_THAT(campaign_settings(campaign_, {}, {}),
              ElementsAre(Pair("profile of turn", "../rigs/slow.toml")));
}

TEST_F(CampaignPlan, FilesIncludeThoseAmongTheFixedArgumentsOfASut) {
  const auto script = scratch_.write("in/sut.py", "import tether");
  const auto folder = script.parent_path();
  scenario::Scenario& s = campaign_.scenarios[0].scenario;
  s.uavs[0].sut.command = {"python3", "-u", script, folder, folder / "not-there"};
  EXPECT_THAT(files_of(campaign_), ElementsAre(s.world, s.file, script));
}

TEST_F(CampaignPlan, RefusesFilesThatWereChangedOrRemoved) {
  const auto world = campaign_.scenarios[0].scenario.world;
  const auto files = files_of(campaign_);
  const Settings settings = campaign_settings(campaign_, {{"tether", "0.1.0"}}, files);
  const auto check = [&] { require_unchanged(campaign_, settings, files); };
  EXPECT_NO_THROW(check());
  scratch_.write("in/room.sdf", "another world");
  EXPECT_EQ(bad_file_error(check).subject(), world);
  std::filesystem::remove(world);
  EXPECT_EQ(bad_file_error(check).subject(), world);
  scratch_.write("in/room.sdf", "the world");
  EXPECT_NO_THROW(check());
}

}  // namespace
}  // namespace tether::campaign
