#include "commands.h"
#include "local_sut.h"
#include "print_report.h"
#include "progress_bar.h"
#include "running_simulator.h"
#include "say.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/run_campaign.h>
#include <tether/os/child_process.h>
#include <tether/os/machine.h>
#include <tether/os/program.h>
#include <tether/scenario/campaign.h>
#include <tether/sim_gazebo/gazebo_install.h>

namespace tether::app {

namespace {

constexpr Duration kLook = std::chrono::milliseconds(50);

struct CampaignOptions {
  std::filesystem::path campaign;
  std::filesystem::path out;
  std::string simulator;
  int jobs = 1;
  bool resume = false;
};

/// Lays every condition's profiles over a world of its own, so that what is wrong with them shows
/// before anything is written. What means nothing to any UAV is said once.
void try_profiles(const scenario::CampaignScenario& entry, const sim::World& world,
                  std::set<std::string>& warnings) {
  for (const std::string& name : entry.conditions) {
    sim::World copy = world;
    scenario::resolve_sensors(entry.scenario, *entry.scenario.find_condition(name), copy,
                              [&](const std::string& text) { warnings.insert(text); });
  }
}

/// The campaign as it is flown: in the simulator that is asked for, whatever its conditions say.
scenario::Campaign load(const CampaignOptions& options) {
  scenario::Campaign campaign = scenario::load_campaign(options.campaign);
  if (options.simulator.empty()) return campaign;
  parse_simulator_option(options.simulator);
  for (auto& entry : campaign.scenarios)
    for (auto& condition : entry.scenario.conditions) condition.simulator = options.simulator;
  return campaign;
}

/// Of the conditions that are flown.
std::set<std::string> simulators(const scenario::Campaign& campaign) {
  std::set<std::string> names;
  for (const auto& entry : campaign.scenarios)
    for (const std::string& name : entry.conditions)
      names.insert(entry.scenario.find_condition(name)->simulator);
  return names;
}

/// Trials side by side have a Gazebo each, and so a port each.
void require_ports(const scenario::Campaign& campaign, int jobs) {
  const char* master = std::getenv("GAZEBO_MASTER_URI");
  if (jobs == 1 || !master || !*master || !simulators(campaign).contains("gazebo")) return;
  throw Error(
      ErrorCode::kUsage,
      fmt::format("--jobs {}: GAZEBO_MASTER_URI names one port, {}, and trials side by side "
                  "need one each; unset it, or use --jobs 1",
                  jobs, master));
}

/// What starts the SUTs here, under each condition.
void add_programs(const scenario::CampaignScenario& entry,
                  std::vector<std::filesystem::path>& files) {
  for (const std::string& name : entry.conditions) {
    const scenario::Condition& condition = *entry.scenario.find_condition(name);
    scenario::require_clock(entry.scenario, condition);
    if (condition.target && condition.target->ssh) continue;
    for (const auto& program : sut_programs(entry.scenario, condition))
      if (std::find(files.begin(), files.end(), program) == files.end()) files.push_back(program);
  }
}

/// Everything that a trial's result rests on, as far as files go. Each is looked into.
std::vector<std::filesystem::path> all_files(const scenario::Campaign& campaign) {
  std::set<std::string> warnings;
  std::vector<std::filesystem::path> files = campaign::files_of(campaign);
  files.push_back(os::own_file());
  const auto every_trial_says_it = [](const std::string&) {};
  for (const auto& entry : campaign.scenarios) {
    add_programs(entry, files);
    const sim::World world = sim::load_world(
        scenario::world_request(entry.scenario, campaign.seeds.front()), every_trial_says_it);
    files.insert(files.end(), world.files.begin(), world.files.end());
    for (const std::string& name : entry.conditions)
      require_readable(world,
                       parse_simulator_option(entry.scenario.find_condition(name)->simulator));
    try_profiles(entry, world, warnings);
  }
  if (simulators(campaign).contains("gazebo")) {
    const auto gazebo = sim::find_gazebo().files();
    files.insert(files.end(), gazebo.begin(), gazebo.end());
  }
  for (const std::string& warning : warnings) say("warning: {}\n", warning);
  return files;
}

/// The second attempt leaves the first one's log alone.
std::filesystem::path log_file(const campaign::TrialPlan& plan) {
  const std::filesystem::path first = plan.folder / campaign::kTrialLog;
  return std::filesystem::exists(first) ? plan.folder / "run-2.log" : first;
}

/// A trial is a `tether run` of its own, so that whatever happens in one leaves the others alone.
campaign::TrialResult execute(const campaign::TrialPlan& plan, const std::stop_token& stop) {
  const std::filesystem::path log = log_file(plan);
  std::vector<std::string> arguments = {
      os::own_file().string(), "run",         plan.scenario->file.string(), "--condition",
      plan.condition->name,    "--seed",      std::to_string(plan.seed),    "--out",
      plan.folder.string(),    "--simulator", plan.condition->simulator,    "--quiet"};
  if (!plan.profile.empty())
    arguments.insert(arguments.end(), {"--profile", plan.profile.string()});
  if (plan.record_images) arguments.push_back("--images");
  // It has processes of its own to end.
  os::ChildProcess process({.arguments = std::move(arguments),
                            .environment = {},
                            .log = log,
                            .grace = std::chrono::seconds(10)});
  while (!process.wait(kLook)) {
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
  throw Error(ErrorCode::kSetup, fmt::format("the trial left no result: it {}; see {}",
                                             process.poll()->description, log.string()));
}

campaign::CampaignOutcome fly(const campaign::CampaignFolder& folder,
                              const scenario::Campaign& campaign, int jobs,
                              const std::function<void()>& check, const std::stop_token& stop) {
  ProgressBar bar;
  try {
    const auto outcome = campaign::run_campaign(
        folder, campaign, [&](const campaign::TrialPlan& plan) { return execute(plan, stop); },
        {.jobs = jobs, .stop = stop, .wall = {}, .check = check},
        [&](const campaign::CampaignProgress& progress) { bar.show(progress); });
    bar.finish();
    return outcome;
  } catch (...) {
    bar.finish();
    throw;
  }
}

int run(const CampaignOptions& options, const std::stop_token& stop) {
  const scenario::Campaign campaign = load(options);
  campaign::require_jobs_allowed(campaign, options.jobs);
  require_ports(campaign, options.jobs);
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out") / campaign.name : options.out;
  const std::vector<std::filesystem::path> files = all_files(campaign);
  const campaign::Settings settings = campaign::campaign_settings(
      campaign,
      {{"tether", std::string(version())},
       {"machine", os::describe_machine()},
       {"simulator", fmt::format("{}", fmt::join(simulators(campaign), ", "))}},
      files);
  const campaign::CampaignFolder folder(
      out, campaign, settings,
      options.resume ? campaign::OpenMode::kResume : campaign::OpenMode::kFresh);
  for (const std::string& warning : folder.warnings()) say("warning: {}\n", warning);

  const auto outcome = fly(
      folder, campaign, options.jobs,
      [&] { campaign::require_unchanged(campaign, settings, files); }, stop);
  if (outcome.interrupted) {
    say("tether: interrupted; go on with: tether campaign {} --out {} --resume\n",
        options.campaign.string(), out.string());
    return exit_code(ErrorCode::kSetup);
  }
  print_campaign_summary(out);
  return outcome.failed > 0 ? exit_code(ErrorCode::kSetup) : 0;
}

}  // namespace

void add_campaign_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<CampaignOptions>();
  CLI::App* command =
      program.add_subcommand("campaign", "Run many trials: scenarios x conditions x seeds");
  command->add_option("campaign", options->campaign, "Campaign file (TOML)")->required();
  command->add_option("--out", options->out, "Folder for the trials [out/CAMPAIGN]");
  command
      ->add_option(
          "--jobs", options->jobs,
          "Cores for trials side by side; refused where that would disturb the measured time")
      ->capture_default_str();
  add_simulator_option(*command, options->simulator);
  command->add_flag("--resume", options->resume, "Go on with a folder: run only what is missing");
  command->footer(R"(Examples:
  tether campaign data/campaigns/face_anchor.toml --out out/face_anchor
  tether campaign data/campaigns/face_anchor.toml --out out/face_anchor --resume
  tether campaign data/campaigns/face_anchor.toml --simulator gazebo --out out/face_anchor_gazebo)");
  command->callback([options, &action] {
    action = [options](const std::stop_token& stop) { return run(*options, stop); };
  });
}

}  // namespace tether::app
