#include "suts/local_sut.h"
#include "warning_log.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/os/child_process.h>
#include <tether/runner/campaign_trials.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::runner {

namespace {

/// Prepares the simulator of each condition for a copy of the world to which what the condition
/// changes of UAVs is applied, so that errors are found before anything is written. Conditions that
/// were slowed down differ in their clocks only.
void try_conditions(const scenario::CampaignScenario& entry, const sim::World& world,
                    std::uint64_t seed, const FindBackEnd& find_back_end, const WarningSink& warn) {
  std::set<std::string> prepared;
  for (const std::string& name : entry.conditions) {
    const scenario::Condition& condition = *entry.scenario.find_condition(name);
    const bool is_slowed = !condition.slowed_from.empty();
    if (!prepared.insert(is_slowed ? condition.slowed_from : name).second) continue;
    sim::World copy = world;
    const BackEnd back_end = find_back_end(condition.simulator);
    resolve_world(entry.scenario, condition, seed, back_end.reads_world, copy, warn);
    back_end.prepare(std::move(copy), warn);
  }
}

/// Adds the programs that start the SUTs of each condition here.
void add_programs(const scenario::CampaignScenario& entry,
                  std::vector<std::filesystem::path>& files) {
  std::set<std::string> tried;
  for (const std::string& name : entry.conditions) {
    const scenario::Condition& condition = *entry.scenario.find_condition(name);
    scenario::require_clock(entry.scenario, condition);
    for (const scenario::Computer& computer : condition.computers)
      if (computer.by_hand)
        throw Error(ErrorCode::kBadFile, computer.at,
                    fmt::format("the SUTs of target \"{}\" are started by hand, which a campaign "
                                "cannot wait for. Use tether run, or remove 'by_hand'",
                                computer.name))
            .about(computer.name);
    for (const auto& program : sut_programs(entry.scenario, condition))
      if (std::find(files.begin(), files.end(), program) == files.end()) files.push_back(program);
    if (condition.slowed_from.empty() || tried.insert(condition.slowed_from).second)
      try_suts(entry.scenario, condition);
  }
}

}  // namespace

std::set<std::string> simulators(const scenario::Campaign& campaign) {
  std::set<std::string> names;
  for (const auto& entry : campaign.scenarios)
    for (const std::string& name : entry.conditions)
      names.insert(entry.scenario.find_condition(name)->simulator);
  return names;
}

CampaignFiles files_of_trials(const scenario::Campaign& campaign, const FindBackEnd& find_back_end,
                              sim::WorldStore& worlds) {
  WarningLog warnings({});
  std::vector<std::filesystem::path> files = campaign::files_of(campaign);
  files.push_back(os::own_file());
  for (const auto& entry : campaign.scenarios) {
    add_programs(entry, files);
    const sim::World world = worlds.load(
        scenario::world_request(entry.scenario, campaign.seeds.front()), warnings.sink());
    files.insert(files.end(), world.files.begin(), world.files.end());
    try_conditions(entry, world, campaign.seeds.front(), find_back_end, warnings.sink());
  }
  for (const std::string& name : simulators(campaign)) {
    const auto own = find_back_end(name).files();
    files.insert(files.end(), own.begin(), own.end());
  }
  return {std::move(files), warnings.all()};
}

}  // namespace tether::runner
