#include "project_folder.h"

#include <set>

#include <tether/campaign/campaign_folder.h>

/// Campaign files, and the plan that is made of them. Input: the file.
namespace tether::fuzz {
namespace {

/// What campaign.h promises.
void require_whole(const scenario::Campaign& campaign) {
  require(!campaign.name.empty() && !campaign.scenarios.empty(), "a campaign of nothing");
  const std::set<std::uint64_t> seeds(campaign.seeds.begin(), campaign.seeds.end());
  require(!seeds.empty() && seeds.size() == campaign.seeds.size(), "seeds twice, or none");
  for (const scenario::CampaignScenario& entry : campaign.scenarios) {
    require(!entry.conditions.empty(), "a scenario without conditions");
    for (const std::string& name : entry.conditions)
      require(entry.scenario.find_condition(name) != nullptr, "a condition that is none");
  }
}

void require_plan(const scenario::Campaign& campaign) {
  std::set<std::filesystem::path> folders;
  const auto plans = campaign::plan_trials(campaign, "/results");
  for (const campaign::TrialPlan& plan : plans) {
    require(folders.insert(plan.folder).second, "two trials in one folder");
    require(plan.scenario != nullptr && plan.condition != nullptr, "a trial of nothing");
  }
  require(plans.size() % campaign.seeds.size() == 0, "trials are missing");
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::ProjectFolder folder;
  const auto file = folder.write("input.toml", {data, size});
  const auto read = fuzz::read_or_refuse([&] { return scenario::load_campaign(file); });
  if (!read) return 0;
  fuzz::require_whole(*read);
  fuzz::require_plan(*read);
  return 0;
}
