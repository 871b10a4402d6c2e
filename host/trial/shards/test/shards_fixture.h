#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign_testing/sample_campaign.h>
#include <tether/shards/shard.h>

namespace tether::shards {

/// A campaign of nine trials, and folders for its results.
class ShardsTest : public testing::Test {
 protected:
  /// A trial that was flown in a folder of its own.
  std::filesystem::path flown(const campaign::TrialPlan& plan, double time_s = 4.0,
                              std::string_view end = campaign::kEndFinished) {
    const auto folder = scratch_.path("flown-" + std::to_string(++count_));
    std::filesystem::create_directories(folder);
    campaign::TrialResult result =
        campaign::make_trial(*plan.scenario, plan.condition->name, plan.seed, 1.0, time_s);
    result.end = std::string(end);
    campaign::write_result(folder, result);
    return folder;
  }
  std::filesystem::path out(const std::string& name = "out") const { return scratch_.path(name); }
  std::vector<campaign::TrialPlan> plans(const std::filesystem::path& folder = {}) const {
    return campaign::plan_trials(campaign_, folder);
  }
  /// A folder with the results of some of the plans, as a shard leaves it.
  std::filesystem::path make_folder(const std::string& name, const std::vector<std::size_t>& trials,
                                    double time_s = 4.0, const campaign::Settings& settings = {}) {
    {
      const campaign::CampaignFolder made(out(name), campaign_, settings,
                                          campaign::OpenMode::kShard);
    }
    const auto all = plans();
    for (const std::size_t i : trials)
      EXPECT_TRUE(hand_in(flown(all[i], time_s), out(name), all[i].folder));
    return out(name);
  }

  ScratchFolder scratch_;
  scenario::Campaign campaign_ = campaign::make_campaign(scratch_);
  int count_ = 0;
};

}  // namespace tether::shards
