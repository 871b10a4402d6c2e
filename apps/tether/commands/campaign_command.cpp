#include "back_ends.h"
#include "commands/commands.h"
#include "options/file_kind.h"
#include "options/junit_option.h"
#include "options/simulator_option.h"
#include "options/trial_options.h"
#include "options/world_options.h"
#include "terminal/print_report.h"
#include "terminal/progress_bar.h"
#include "terminal/say.h"

#include <filesystem>
#include <functional>
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
#include <tether/runner/trial_server.h>
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

campaign::CampaignOutcome fly(const campaign::CampaignFolder& folder,
                              const scenario::Campaign& campaign, int jobs,
                              const std::function<void()>& check, const std::stop_token& stop) {
  ProgressBar bar;
  runner::TrialServers servers;
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

int run_trials(const CampaignOptions& options, const std::stop_token& stop) {
  const scenario::Campaign campaign = load(options);
  campaign::require_jobs_allowed(campaign, options.jobs);
  require_ports(campaign, options.jobs);
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out/campaigns") / campaign.name : options.out;
  const auto [files, warnings] = runner::files_of_trials(campaign, find_back_end);
  if (!warnings.empty())
    say("{}\n", summary_of(warnings, std::string(runner::kWarningsFile) + " of each trial"));
  const campaign::Settings settings =
      campaign::campaign_settings(campaign, versions_of(campaign, options.reading), files);
  const campaign::CampaignFolder folder(
      out, campaign, settings,
      options.resume ? campaign::OpenMode::kResume : campaign::OpenMode::kFresh);
  for (const std::string& warning : folder.warnings()) say("warning: {}\n", warning);

  const auto outcome = fly(
      folder, campaign, options.jobs,
      [&, &files = files] { campaign::require_unchanged(campaign, settings, files); }, stop);
  if (!options.junit.empty())
    os::write_file_atomically(options.junit,
                              report::to_junit(campaign::read_campaign_results(out), out));
  if (outcome.interrupted) {
    say("tether: interrupted; to continue, type: tether campaign {} --out {} --resume\n",
        options.campaign.string(), out.string());
    return exit_code(ErrorCode::kSetup);
  }
  print_campaign_summary(out);
  return outcome.failed > 0 ? exit_code(ErrorCode::kSetup) : 0;
}

}  // namespace

int run_campaign(const CampaignOptions& options, const std::stop_token& stop) {
  return with_junit(options.junit, options.campaign.string(),
                    [&] { return run_trials(options, stop); });
}

}  // namespace tether::app
