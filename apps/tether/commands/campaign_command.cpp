#include "back_ends.h"
#include "commands/commands.h"
#include "commands/trial_service.h"
#include "options/common_options.h"
#include "options/engine_option.h"
#include "options/junit_option.h"
#include "options/refuse_option.h"
#include "options/trial_options.h"
#include "reading/file_kind.h"
#include "reading/world_options.h"
#include "terminal/print.h"
#include "terminal/print_report.h"
#include "terminal/progress_bar.h"
#include "terminal/say.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/campaign_results.h>
#include <tether/campaign/run_campaign.h>
#include <tether/os/child_process.h>
#include <tether/os/text_file.h>
#include <tether/report/junit.h>
#include <tether/runner/campaign_trials.h>
#include <tether/runner/trial_folder.h>
#include <tether/runner/trial_server.h>
#include <tether/scenario/campaign.h>
#include <tether/scenario/shipped_files.h>
#include <tether/shards/engine_flights.h>
#include <tether/shards/shard.h>

namespace tether::app {

namespace {

struct CampaignOptions {
  std::filesystem::path campaign;              ///< or a scenario
  std::vector<std::string> conditions;         ///< of a scenario
  std::optional<int> trials;                   ///< of a scenario
  std::vector<std::filesystem::path> collect;  ///< folders of a campaign
  std::filesystem::path listed;                ///< a list of an engine's shards
  std::filesystem::path out;
  std::string shard;  ///< "K/N"
  std::string simulator;
  EngineOptions engine;
  ReadingOptions reading;
  bool resume = false;
  std::filesystem::path junit;
};

constexpr int kTrialsOfScenario = 10;

/// The campaign of the file, or that of a scenario. Of a name that both have, the options that only
/// scenarios have decide.
scenario::Campaign read(const CampaignOptions& options, const scenario::ShippedFiles& shipped) {
  using scenario::ShippedKind;
  const std::string given = options.campaign.string();
  const bool is_of_scenario = !options.conditions.empty() || options.trials.has_value();
  const bool is_scenario_name = (is_of_scenario || !shipped.has(ShippedKind::kCampaign, given)) &&
                                shipped.has(ShippedKind::kScenario, given) &&
                                !std::filesystem::exists(options.campaign);
  const std::filesystem::path file =
      shipped.find(is_scenario_name ? ShippedKind::kScenario : ShippedKind::kCampaign, given);
  if (kind_of(file) == FileKind::kScenario)
    return scenario::campaign_of(
        scenario::load_scenario(file), options.conditions,
        static_cast<std::size_t>(options.trials.value_or(kTrialsOfScenario)));
  require_kind(file, FileKind::kCampaign);
  scenario::Campaign campaign = scenario::load_campaign(file);
  for (const auto& [option, is_given] :
       {std::pair{"--condition", !options.conditions.empty()}, {"--trials", !!options.trials}})
    if (is_given)
      refuse_option(option, fmt::format("is for a scenario, and {} is a campaign, whose file says "
                                        "what is flown.",
                                        file.string()));
  return campaign;
}

/// The same, with the simulator of the options in all conditions if one is given.
scenario::Campaign load(const CampaignOptions& options) {
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  scenario::Campaign campaign = read(options, shipped);
  for (auto& entry : campaign.scenarios)
    entry.scenario.world_options = world_options(options.reading, shipped);
  if (options.simulator.empty()) return campaign;
  find_back_end(options.simulator);  // or it says what there is
  for (auto& entry : campaign.scenarios)
    for (auto& condition : entry.scenario.conditions) condition.simulator = options.simulator;
  return campaign;
}

/// @throws Error(kUsage) unless one of them says what to fly or collect, with options that apply.
void require_one_task(const CampaignOptions& options) {
  const int given = !options.campaign.empty() + !options.collect.empty() + !options.listed.empty();
  if (given != 1)
    throw Error(ErrorCode::kUsage,
                "give a campaign, or --collect FOLDER…, or --listed FILE, and only one of them.")
        .about("campaign");
  if (!options.shard.empty() && !options.engine.engine.empty())
    refuse_option("--shard", "is for flights without --engine, which starts shards itself.");
  if (!options.shard.empty() && options.campaign.empty())
    refuse_option("--shard", "is for a campaign.");
}

/// What is brought together, in the first one.
std::vector<std::filesystem::path> folders_of(const CampaignOptions& options) {
  std::vector<std::filesystem::path> folders = options.collect;
  if (!options.out.empty()) folders.insert(folders.begin(), options.out);
  return folders;
}

campaign::CampaignOutcome with_bar(
    const std::function<campaign::CampaignOutcome(const campaign::ProgressCallback&)>& fly) {
  ProgressBar bar;
  try {
    auto outcome = fly([&](const campaign::CampaignProgress& progress) { bar.show(progress); });
    bar.finish();
    return outcome;
  } catch (...) {
    bar.finish();
    throw;
  }
}

/// A list of trials, as an engine's script has it flown. It is in a folder of its own in that of
/// shards, in the campaign's.
int fly_listed(const CampaignOptions& options, const std::stop_token& stop) {
  const shards::TrialList list =
      shards::parse_trial_list(os::read_file(options.listed), options.listed);
  const std::filesystem::path campaign =
      std::filesystem::absolute(options.listed).parent_path().parent_path().parent_path();
  runner::TrialServers servers;
  const auto outcome = with_bar([&](const campaign::ProgressCallback& progress) {
    return runner::fly_shard(list, campaign, {}, options.engine.jobs.value_or(1), servers, stop,
                             progress);
  });
  return outcome.interrupted || outcome.failed > 0 ? exit_code(ErrorCode::kSetup) : 0;
}

std::vector<const campaign::TrialPlan*> missing_of(const campaign::CampaignFolder& folder) {
  std::vector<const campaign::TrialPlan*> plans;
  for (const campaign::TrialPlan& plan : folder.missing()) plans.push_back(&plan);
  return plans;
}

/// All trials of the campaign.
shards::TrialList list_of(const scenario::Campaign& campaign,
                          const std::vector<std::filesystem::path>& files) {
  shards::TrialList list{.files = shards::digests_of(files)};
  for (const campaign::TrialPlan& plan : campaign::plan_trials(campaign, {}))
    list.trials.push_back({plan.folder, to_json(runner::request_of(plan))});
  return list;
}

struct Flying {
  const CampaignOptions& options;
  const scenario::Campaign& campaign;
  const campaign::CampaignFolder& folder;
  const campaign::Settings& settings;
  const std::vector<std::filesystem::path>& files;
  int jobs = 1;
  const std::stop_token& stop;
};

campaign::CampaignOutcome fly(const Flying& f, const std::optional<shards::Engine>& engine,
                              runner::TrialServers& servers,
                              const campaign::ProgressCallback& progress) {
  if (engine)
    return shards::fly_by_engine(engine_setup(*engine, f.jobs, f.folder.path(), f.files),
                                 missing_of(f.folder), f.folder.finished().size(), f.stop,
                                 progress);
  if (!f.options.shard.empty())
    return runner::fly_shard(list_of(f.campaign, f.files), f.folder.path(),
                             shards::parse_shard(f.options.shard), f.jobs, servers, f.stop,
                             progress);
  return campaign::run_campaign(
      f.folder, f.campaign,
      [&](const campaign::TrialPlan& plan) { return servers.run(plan, f.stop); },
      {.jobs = f.jobs,
       .stop = f.stop,
       .wall = {},
       .check = [&] { campaign::require_unchanged(f.campaign, f.settings, f.files); }},
      progress);
}

/// Whether a trial failed, or says nothing because of a doubt: in this part or in earlier ones.
bool has_failures(const campaign::CampaignResults& results) {
  for (const campaign::ScenarioResults& scenario : results.scenarios)
    for (const campaign::ConditionResults& condition : scenario.conditions)
      for (const campaign::TrialResult& trial : condition.trials)
        if (exit_code(trial) == exit_code(campaign::Outcome::kFailed)) return true;
  return false;
}

int run_trials(const CampaignOptions& options, const std::stop_token& stop) {
  const scenario::Campaign campaign = load(options);
  const auto engine = engine_of(options.engine);
  const int jobs = jobs_of(options.engine, engine);
  if (!options.shard.empty()) (void)shards::parse_shard(options.shard);
  require_parallel_allowed(campaign, engine, jobs);
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out/campaigns") / campaign.name : options.out;
  const auto mode = !options.shard.empty() ? campaign::OpenMode::kShard
                    : options.resume       ? campaign::OpenMode::kResume
                                           : campaign::OpenMode::kFresh;
  campaign::require_folder(out, campaign, mode);
  sim::WorldStore worlds(sim::FileCache::of_user());
  const auto [files, warnings] = runner::files_of_trials(campaign, find_back_end, worlds);
  if (!warnings.empty())
    complain(summary_of(warnings, std::string(runner::kWarningsFile) + " of each trial"));
  runner::TrialServers servers;
  if (!engine) servers.start(jobs, trial_service(worlds));
  const campaign::Settings settings = campaign::campaign_settings(
      campaign, versions_of(campaign, options.reading, engine.has_value()), files);
  const campaign::CampaignFolder folder(out, campaign, settings, mode);
  for (const std::string& warning : folder.warnings()) complain("warning: " + warning);

  const Flying flying{options, campaign, folder, settings, files, jobs, stop};
  const auto outcome = [&] {
    try {
      return with_bar([&](const campaign::ProgressCallback& progress) {
        return fly(flying, engine, servers, progress);
      });
    } catch (const Error&) {
      complain("the trials that have ended are kept; " + how_to_continue());
      throw;
    }
  }();
  const campaign::CampaignResults results = campaign::read_campaign_results(out);
  if (!options.junit.empty())
    os::write_file_atomically(options.junit, report::to_junit(results, out));
  if (outcome.interrupted) {
    say("tether: interrupted; {}\n", how_to_continue());
    return exit_code(ErrorCode::kSetup);
  }
  if (!options.shard.empty())
    say("Part {}: {} flown. To report all parts, type: tether campaign --collect {}\n",
        options.shard, counted(outcome.ran, "trial"), out.string());
  else
    print_campaign_summary(results, out);
  return has_failures(results) ? exit_code(ErrorCode::kSetup) : 0;
}

/// Runs many trials: scenarios x conditions x seeds.
int run_campaign(const CampaignOptions& options, const std::stop_token& stop) {
  require_one_task(options);
  if (!options.listed.empty()) return fly_listed(options, stop);
  if (!options.collect.empty())
    return with_junit(options.junit, options.collect.front().string(),
                      [&] { return collect_campaign(folders_of(options), options.junit); });
  return with_junit(options.junit, options.campaign.string(),
                    [&] { return run_trials(options, stop); });
}

Options campaign_rows(CampaignOptions& o) {
  return concatenated(
      {{{"campaign",
         "Name of a shipped campaign, or a file (TOML); or a scenario, of which all conditions are "
         "flown",
         &o.campaign},
        {"--condition NAME",
         "Of a scenario: fly this condition; can be repeated [all of its conditions]",
         &o.conditions,
         {.check = named().check, .is_one_each = true}},
        {"--trials",
         fmt::format("Of a scenario: flights for each condition, with the seeds 1, 2, … [{}]",
                     kTrialsOfScenario),
         &o.trials, range(1, 100'000)},
        {"--out FOLDER", "Folder for the trials [out/campaigns/CAMPAIGN]", &o.out},
        {"--shard K/N",
         "Fly only part K of N: each N-th seed, from the K-th on. Other parts can be flown at the "
         "same time, in the same or another folder. To continue, give the same option again",
         &o.shard}},
       engine_options(o.engine),
       {{"--collect FOLDER",
         "Bring the results of these folders of a campaign together in the first one, or in that "
         "of --out, and report what is missing (exit code 3), or left out because it is of another "
         "campaign, other files or versions (2)",
         &o.collect},
        {"--listed FILE", "Fly the trials of this list, which an engine's script names", &o.listed},
        simulator_option(o.simulator),
        junit_option(o.junit)},
       reading_options(o.reading),
       {resume_option(o.resume)}});
}

}  // namespace

Command campaign_command() {
  return make_command(
      "campaign", "Run the trials of a campaign: scenarios x conditions x seeds", campaign_rows,
      R"(Exit codes: 0, also if trials miss their goals; 2, wrong use or a bad file; 3, a trial failed or
has no answer, or the campaign was interrupted.

Examples:
  tether campaign face_anchor --out out/campaign
  tether campaign follow_moving --condition host --condition target --trials 20
  tether campaign face_anchor --out out/campaign --resume
  tether campaign face_anchor --out /shared/campaign --engine slurm --engine-option "options=--time=2:00:00"
  tether campaign face_anchor --out part3 --shard 3/8
  tether campaign --collect part1 part2 part3 --out all
  tether campaign face_anchor --simulator gazebo --out out/campaign_gazebo)",
      run_campaign);
}

}  // namespace tether::app
