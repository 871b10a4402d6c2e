#include "back_ends.h"
#include "cluster/fly_by_workers.h"
#include "commands/commands.h"
#include "commands/trial_service.h"
#include "options/junit_option.h"
#include "options/simulator_option.h"
#include "options/trial_options.h"
#include "reading/file_kind.h"
#include "reading/world_options.h"
#include "terminal/print.h"
#include "terminal/print_report.h"
#include "terminal/progress_bar.h"
#include "terminal/say.h"

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/campaign_results.h>
#include <tether/campaign/run_campaign.h>
#include <tether/os/program.h>
#include <tether/os/text_file.h>
#include <tether/report/junit.h>
#include <tether/runner/campaign_trials.h>
#include <tether/runner/trial_folder.h>
#include <tether/scenario/campaign.h>
#include <tether/scenario/shipped_files.h>

namespace tether::app {

namespace {

/// The campaign, with the simulator of the options in all conditions if one is given.
scenario::Campaign load(const CampaignOptions& options) {
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  const std::filesystem::path file =
      shipped.find(scenario::ShippedKind::kCampaign, options.campaign);
  require_kind(file, FileKind::kCampaign);
  scenario::Campaign campaign = scenario::load_campaign(file);
  for (auto& entry : campaign.scenarios)
    entry.scenario.world_options = world_options(options.reading, shipped);
  if (options.simulator.empty()) return campaign;
  parse_simulator_option(options.simulator);
  for (auto& entry : campaign.scenarios)
    for (auto& condition : entry.scenario.conditions) condition.simulator = options.simulator;
  return campaign;
}

campaign::CampaignOutcome fly(runner::TrialServers& servers, const campaign::CampaignFolder& folder,
                              const scenario::Campaign& campaign, int jobs,
                              const std::function<void()>& check, const std::stop_token& stop) {
  ProgressBar bar;
  try {
    const auto outcome = campaign::run_campaign(
        folder, campaign, [&](const campaign::TrialPlan& plan) { return servers.run(plan, stop); },
        {.jobs = jobs, .stop = stop, .wall = {}, .check = check},
        [&](const campaign::CampaignProgress& progress) { bar.show(progress); });
    bar.finish();
    return outcome;
  } catch (...) {
    bar.finish();
    throw;
  }
}

/// @throws Error(kUsage) unless exactly one of them says which campaign.
void require_one_campaign(const CampaignOptions& options) {
  const int given = !options.campaign.empty() + !options.collect.empty() + !options.cancel.empty();
  if (given == 1) return;
  throw Error(ErrorCode::kUsage,
              "give a campaign, or --collect FOLDER, or --cancel FOLDER, and only one of them.")
      .about("campaign");
}

/// What --collect needs to go on.
std::map<std::string, std::string> command_of(const CampaignOptions& options,
                                              const scenario::Campaign& campaign) {
  return {{"campaign", campaign.file.string()},
          {"simulator", options.simulator},
          {"missing_models", options.reading.missing_models},
          {"tolerant", options.reading.tolerant ? "yes" : ""}};
}

/// The options with which the workers of the folder of --collect were started.
CampaignOptions collecting(const CampaignOptions& options) {
  if (options.collect.empty()) return options;
  const workers::Start start = campaign_in(options.collect);
  const auto text = [&](const char* key) {
    const auto found = start.command.find(key);
    return found == start.command.end() ? std::string() : found->second;
  };
  CampaignOptions all = options;
  all.campaign = text("campaign");
  all.out = options.collect;
  all.simulator = text("simulator");
  all.reading = {.tolerant = !text("tolerant").empty(), .missing_models = text("missing_models")};
  all.jobs = start.jobs;
  all.cluster = start.options;
  all.cluster.collects = true;
  all.resume = true;
  return all;
}

/// None: workers have not flown everything, which the user knows.
std::optional<campaign::CampaignOutcome> fly_missing(
    workers::Cluster& cluster, const campaign::CampaignFolder& folder,
    const std::vector<std::filesystem::path>& files, const std::stop_token& stop) {
  std::vector<const campaign::TrialPlan*> plans;
  for (const campaign::TrialPlan& plan : folder.missing()) plans.push_back(&plan);
  ProgressBar bar;
  const auto collected =
      fly_by_workers(cluster, plans, files, folder.finished().size(), stop,
                     [&](const campaign::CampaignProgress& progress) { bar.show(progress); });
  bar.finish();
  if (!collected.losses.empty())
    say("{} trials were lost by machines and flown again, or are reported as not flown.\n",
        collected.losses.size());
  if (collected.end != workers::CollectEnd::kComplete) return std::nullopt;
  return collected.outcome;
}

int run_trials(const CampaignOptions& given, const std::stop_token& stop) {
  const CampaignOptions options = collecting(given);
  const scenario::Campaign campaign = load(options);
  workers::require_allowed(campaign, options.cluster);
  const int jobs = workers::jobs_of(options.jobs, options.cluster);
  campaign::require_jobs_allowed(campaign, jobs);
  require_ports(campaign, jobs);
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out/campaigns") / campaign.name : options.out;
  std::optional<workers::Cluster> cluster;
  if (options.cluster.uses_workers())
    cluster.emplace(
        workers::Start{options.cluster, jobs, std::filesystem::current_path(),
                       command_of(options, campaign)},
        out, [](const campaign::TrialPlan& one) { return to_json(runner::request_of(one)); });
  sim::WorldStore worlds;
  const auto [files, warnings] = runner::files_of_trials(campaign, find_back_end, worlds);
  if (!warnings.empty())
    complain(summary_of(warnings, std::string(runner::kWarningsFile) + " of each trial"));
  runner::TrialServers servers;
  if (!cluster) servers.start(jobs, trial_service(worlds));
  campaign::Settings versions = versions_of(campaign, options.reading);
  if (cluster) versions["machine"] = workers::kManyMachines;
  const campaign::Settings settings = campaign::campaign_settings(campaign, versions, files);
  const campaign::CampaignFolder folder(
      out, campaign, settings,
      options.resume ? campaign::OpenMode::kResume : campaign::OpenMode::kFresh);
  for (const std::string& warning : folder.warnings()) complain("warning: " + warning);

  campaign::CampaignOutcome outcome;
  if (cluster) {
    const auto flown = fly_missing(*cluster, folder, files, stop);
    if (!flown) return options.cluster.detach ? 0 : exit_code(ErrorCode::kSetup);
    outcome = *flown;
  } else {
    outcome = fly(
        servers, folder, campaign, jobs,
        [&, &files = files] { campaign::require_unchanged(campaign, settings, files); }, stop);
  }
  const campaign::CampaignResults results = campaign::read_campaign_results(out);
  if (!options.junit.empty())
    os::write_file_atomically(options.junit, report::to_junit(results, out));
  if (outcome.interrupted) {
    say("tether: interrupted; to continue, type: tether campaign {} --out {} --resume\n",
        options.campaign.string(), out.string());
    return exit_code(ErrorCode::kSetup);
  }
  print_campaign_summary(results, out);
  return outcome.failed > 0 ? exit_code(ErrorCode::kSetup) : 0;
}

}  // namespace

int run_campaign(const CampaignOptions& options, const std::stop_token& stop) {
  require_one_campaign(options);
  if (!options.cancel.empty()) return cancel_jobs(options.cancel);
  return with_junit(options.junit,
                    (options.campaign.empty() ? options.collect : options.campaign).string(),
                    [&] { return run_trials(options, stop); });
}

}  // namespace tether::app
