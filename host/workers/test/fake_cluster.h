#pragma once

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <tether/base_testing/scratch_folder.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/result.h>
#include <tether/campaign_testing/sample_campaign.h>
#include <tether/os/text_file.h>
#include <tether/workers/collect.h>
#include <tether/workers/worker.h>

namespace tether::workers {

/// A campaign of nine trials, and what collectors and workers need to fly it.
struct FakeCampaign {
  ScratchFolder scratch;
  scenario::Campaign campaign = campaign::make_campaign(scratch);
  SharedFolder folder{scratch.path("out")};
  std::vector<campaign::TrialPlan> plans = campaign::plan_trials(campaign, folder.root());
  std::vector<std::string> flown;  ///< folders of items

  FakeCampaign() { folder.make(""); }

  std::vector<const campaign::TrialPlan*> wanted() const {
    std::vector<const campaign::TrialPlan*> all;
    for (const auto& plan : plans) all.push_back(&plan);
    return all;
  }
  std::vector<Item> items() const {
    std::vector<Item> all;
    for (const auto& plan : plans) all.push_back({key(plan), request(plan)});
    return all;
  }
  std::string key(const campaign::TrialPlan& plan) const {
    return plan.folder.lexically_relative(folder.root()).string();
  }
  static std::string request(const campaign::TrialPlan& plan) {
    return "seed " + std::to_string(plan.seed);
  }
  Flight fly(const Item& item, const std::filesystem::path& local) {
    flown.push_back(item.folder);
    for (const auto& plan : plans) {
      if (key(plan) != item.folder) continue;
      campaign::write_result(
          local, campaign::make_trial(*plan.scenario, plan.condition->name, plan.seed, 0.0, 2.5));
    }
    return {};
  }
  WorkerSetup worker(const std::string& id, const std::string& node = "n1") {
    return {
        .self = {id, node, "7_" + id},
        .scratch = scratch.path("local-" + id),
        .fly = [this](const Item& item, const auto& local, double) { return fly(item, local); }};
  }
  std::size_t results() const {
    std::size_t count = 0;
    for (const auto& plan : plans) count += exists(plan.folder / campaign::kResultFile);
    return count;
  }
};

}  // namespace tether::workers
