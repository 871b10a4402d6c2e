#include "fake_back_end.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/os/child_process.h>
#include <tether/runner/campaign_trials.h>
#include <tether/runner/trial_server.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::runner {
namespace {

using testing::Contains;
using testing::ElementsAre;

class CampaignTrials : public testing::Test {
 protected:
  CampaignTrials()
      : campaign_(scenario::load_campaign(std::filesystem::path(TETHER_SOURCE_DIR) /
                                          "data/campaigns/face_anchor.toml")) {
    for (auto& entry : campaign_.scenarios) {
      fly_in_empty_world(entry.scenario, scratch_);
      for (auto& uav : entry.scenario.uavs) uav.sut.command = {"sh"};
      for (auto& condition : entry.scenario.conditions) condition.simulator = "fake";
    }
  }

  ScratchFolder scratch_;
  scenario::Campaign campaign_;
};

TEST_F(CampaignTrials, NameEachSimulatorOnce) {
  EXPECT_THAT(simulators(campaign_), ElementsAre("fake"));
  auto& entry = campaign_.scenarios.front();
  for (auto& condition : entry.scenario.conditions)
    if (condition.name == entry.conditions.front()) condition.simulator = "another";
  EXPECT_THAT(simulators(campaign_), ElementsAre("another", "fake"));
}

TEST_F(CampaignTrials, DependOnProgramsWorldAndSimulator) {
  sim::WorldStore worlds;
  const auto files = files_of_trials(campaign_, fake_back_end(), worlds).files;
  EXPECT_THAT(files, Contains(os::own_file()).Times(1));
  EXPECT_THAT(files, Contains(os::find_program("sh")).Times(1));
  EXPECT_THAT(files, Contains(campaign_.scenarios.front().scenario.file));
  EXPECT_EQ(files.back(), "/fake/simulator");
}

TEST_F(CampaignTrials, RejectAnUnknownSimulator) {
  campaign_.scenarios.front().scenario.conditions.front().simulator = "another";
  sim::WorldStore worlds;
  const Error error =
      thrown_error(ErrorCode::kUsage, [&] { files_of_trials(campaign_, fake_back_end(), worlds); });
  EXPECT_EQ(error.subject(), "another");
}

}  // namespace
}  // namespace tether::runner
