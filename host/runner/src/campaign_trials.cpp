#include "local_sut.h"
#include "warning_log.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/os/child_process.h>
#include <tether/os/program.h>
#include <tether/os/text_file.h>
#include <tether/runner/campaign_trials.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::runner {

namespace {

constexpr Duration kPollPeriod = std::chrono::milliseconds(50);

/// Applies what each condition changes of UAVs to a copy of the world, so that errors in it are
/// found before anything is written.
void try_conditions(const scenario::CampaignScenario& entry, const sim::World& world,
                    const FindBackEnd& find_back_end, const WarningSink& warn) {
  for (const std::string& name : entry.conditions) {
    const scenario::Condition& condition = *entry.scenario.find_condition(name);
    find_back_end(condition.simulator).require_readable(world);
    sim::World copy = world;
    scenario::resolve_energy(entry.scenario, condition, copy, warn);
    scenario::resolve_sensors(entry.scenario, condition, copy, warn);
  }
}

/// Adds the programs that start the SUTs of each condition here.
void add_programs(const scenario::CampaignScenario& entry,
                  std::vector<std::filesystem::path>& files) {
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
  }
}

/// The second attempt keeps the log of the first.
std::filesystem::path log_file(const campaign::TrialPlan& plan) {
  const std::filesystem::path first = plan.folder / campaign::kTrialLog;
  return std::filesystem::exists(first) ? plan.folder / campaign::kSecondTrialLog : first;
}

}  // namespace

std::set<std::string> simulators(const scenario::Campaign& campaign) {
  std::set<std::string> names;
  for (const auto& entry : campaign.scenarios)
    for (const std::string& name : entry.conditions)
      names.insert(entry.scenario.find_condition(name)->simulator);
  return names;
}

CampaignFiles files_of_trials(const scenario::Campaign& campaign,
                              const FindBackEnd& find_back_end) {
  WarningLog warnings({});
  std::vector<std::filesystem::path> files = campaign::files_of(campaign);
  files.push_back(os::own_file());
  for (const auto& entry : campaign.scenarios) {
    add_programs(entry, files);
    const sim::World world = sim::load_world(
        scenario::world_request(entry.scenario, campaign.seeds.front()), warnings.sink());
    files.insert(files.end(), world.files.begin(), world.files.end());
    try_conditions(entry, world, find_back_end, warnings.sink());
  }
  for (const std::string& name : simulators(campaign)) {
    const auto own = find_back_end(name).files();
    files.insert(files.end(), own.begin(), own.end());
  }
  return {std::move(files), warnings.all()};
}

campaign::TrialResult run_trial_process(const campaign::TrialPlan& plan,
                                        const std::stop_token& stop) {
  const std::filesystem::path log = log_file(plan);
  const bool is_slowed = !plan.condition->slowed_from.empty();
  const std::string& name_in_scenario =
      is_slowed ? plan.condition->slowed_from : plan.condition->name;
  std::vector<std::string> arguments = {
      os::own_file().string(), "run",         plan.scenario->file.string(), "--condition",
      name_in_scenario,        "--seed",      std::to_string(plan.seed),    "--out",
      plan.folder.string(),    "--simulator", plan.condition->simulator,    "--quiet"};
  if (!plan.profile.empty())
    arguments.insert(arguments.end(), {"--profile", plan.profile.string()});
  if (is_slowed)
    arguments.insert(arguments.end(), {"--slowdown", fmt::format("{}", plan.condition->slowdown)});
  for (const auto& [key, value] : plan.scenario->settings)
    arguments.insert(arguments.end(), {"--set", fmt::format("{}={}", key, value)});
  if (plan.record_images) arguments.emplace_back("--images");
  const sim::WorldOptions& options = plan.scenario->world_options;
  if (options.is_tolerant) arguments.emplace_back("--tolerant");
  if (options.replaces_missing_models)
    arguments.insert(arguments.end(), {"--missing-models", "placeholder"});
  // The grace period lets it end its own processes.
  os::ChildProcess process({.arguments = std::move(arguments),
                            .environment = {},
                            .log = log,
                            .grace = std::chrono::seconds(10)});
  while (!process.wait(kPollPeriod)) {
    if (stop.stop_requested()) process.terminate();
  }
  if (stop.stop_requested()) {
    auto result = campaign::make_setup_failure(*plan.scenario, *plan.condition, plan.seed,
                                               "interrupted by the user");
    result.end = campaign::kEndInterrupted;
    return result;
  }
  if (std::filesystem::exists(plan.folder / campaign::kResultFile))
    return campaign::read_result(plan.folder);
  const std::string why = os::last_line(os::read_whole(log));
  throw Error(ErrorCode::kSetup,
              fmt::format("the trial left no result: it {}{}; see {}", process.poll()->description,
                          why.empty() ? "" : ": " + why, log.string()));
}

}  // namespace tether::runner
