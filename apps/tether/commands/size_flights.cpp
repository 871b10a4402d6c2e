#include "commands/size_flights.h"

#include "back_ends.h"
#include "options/simulator_option.h"
#include "options/trial_options.h"
#include "reading/file_kind.h"
#include "reading/world_options.h"
#include "terminal/say.h"

#include <algorithm>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/os/program.h>
#include <tether/os/terminal.h>
#include <tether/runner/campaign_trials.h>
#include <tether/runner/trial_folder.h>
#include <tether/scenario/scenario.h>
#include <tether/scenario/shipped_files.h>

namespace tether::app {

namespace {

bool has_margins(const scenario::Scenario& scenario) {
  return std::ranges::any_of(scenario.metrics, [](const scenario::Metric& metric) {
    campaign::MetricValue value{metric.name, metric.kind, metric.label, metric.unit, 0.0, "", {}};
    value.max = metric.max;
    value.min = metric.min;
    return report::margin_of(value).has_value();
  });
}

std::string name_of_campaign(const scenario::Scenario& scenario) {
  return std::string(kSizePrefix) + scenario.name;
}

}  // namespace

scenario::Scenario load_sized_scenario(const SizeOptions& options,
                                       const std::vector<scenario::Setting>& settings) {
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  const std::filesystem::path file =
      shipped.find(scenario::ShippedKind::kScenario, options.scenario);
  require_kind(file, FileKind::kScenario);
  scenario::Scenario scenario = scenario::load_scenario(file, settings);
  scenario.world_options = world_options(options.reading, shipped);
  if (options.simulator.empty()) return scenario;
  parse_simulator_option(options.simulator);
  for (auto& condition : scenario.conditions) condition.simulator = options.simulator;
  return scenario;
}

campaign::OpenMode open_mode(const SizeOptions& options) {
  return options.force    ? campaign::OpenMode::kReplace
         : options.resume ? campaign::OpenMode::kResume
                          : campaign::OpenMode::kFresh;
}

void remove_earlier_answer(const std::filesystem::path& out) {
  for (const char* old : {kSizeFile, kSizeDrawing}) {
    std::error_code ignored;
    std::filesystem::remove(out / old, ignored);
  }
}

SizeFlights::SizeFlights(const Setup& setup, const sizing::CurveGrid& grid,
                         const ReadingOptions& reading, const std::filesystem::path& out,
                         campaign::OpenMode mode, std::stop_token stop)
    : setup_(setup),
      grid_(grid),
      stop_(std::move(stop)),
      campaign_(make_campaign()),
      files_([&] {
        require_workers_allowed(campaign_, setup.cluster);
        campaign::require_jobs_allowed(campaign_, setup.jobs);
        require_ports(campaign_, setup.jobs);
        const auto [files, warnings] = runner::files_of_trials(campaign_, find_back_end);
        if (!warnings.empty())
          say("{}\n", summary_of(warnings, std::string(runner::kWarningsFile) + " of each flight"));
        return files;
      }()),
      settings_([&] {
        campaign::Settings versions = versions_of(campaign_, reading);
        if (uses_workers(setup.cluster)) versions["machine"] = kManyMachines;
        return campaign::campaign_settings(campaign_, versions, files_);
      }()),
      folder_(out, campaign_, settings_, mode),
      has_margins_(has_margins(setup.scenario)),
      sizing_(grid, has_margins_) {
  if (uses_workers(setup.cluster))
    cluster_.emplace(setup.cluster, setup.jobs, out, std::map<std::string, std::string>{});
  for (const std::string& warning : folder_.warnings()) say("warning: {}\n", warning);
  for (const campaign::TrialPlan& plan : folder_.missing())
    missing_[{plan.condition->name, plan.seed}] = &plan;
}

scenario::Campaign SizeFlights::make_campaign() const {
  scenario::Campaign campaign;
  campaign.file = setup_.scenario.file;
  campaign.name = name_of_campaign(setup_.scenario);
  campaign.description = setup_.scenario.description;
  for (std::uint64_t seed = 1; seed <= setup_.most; ++seed) campaign.seeds.push_back(seed);
  scenario::CampaignScenario entry{setup_.scenario, {}, ""};
  entry.scenario.conditions.clear();
  for (const scenario::Condition& condition : setup_.conditions) {
    for (const double slowdown : grid_.slowdowns()) {
      entry.scenario.conditions.push_back(condition);
      scenario::slow_down(entry.scenario.conditions.back(), slowdown);
      entry.conditions.push_back(entry.scenario.conditions.back().name);
    }
  }
  campaign.scenarios.push_back(std::move(entry));
  return campaign;
}

std::string SizeFlights::slowed_name(std::size_t condition, double slowdown) const {
  const std::vector<double>& all = grid_.slowdowns();
  const auto place = std::ranges::find(all, slowdown) - all.begin();
  const std::size_t index = condition * all.size() + static_cast<std::size_t>(place);
  return campaign_.scenarios.front().conditions.at(index);
}

// False: interrupted.
bool SizeFlights::run(const std::vector<Key>& keys) {
  std::vector<const campaign::TrialPlan*> plans;
  for (const Key& key : keys) plans.push_back(missing_.at(key));
  if (cluster_) {
    const auto show_it = [&](const campaign::CampaignProgress& progress) { show(progress); };
    return cluster_->fly(plans, files_, 0, stop_, show_it).end == workers::CollectEnd::kComplete;
  }
  const auto outcome = campaign::run_trials(
      plans, [&](const campaign::TrialPlan& plan) { return servers_.run(plan, stop_); },
      {.jobs = setup_.jobs,
       .stop = stop_,
       .wall = {},
       .check = [&] { campaign::require_unchanged(campaign_, settings_, files_); }},
      [&](const campaign::CampaignProgress& progress) { show(progress); });
  return !outcome.interrupted;
}

void SizeFlights::take(const campaign::TrialResult& trial, double slowdown,
                       report::SizedCondition& into, sizing::Sizing& sizing) {
  if (trial.outcome == campaign::Outcome::kFailed) {
    report_->not_flown.push_back(
        fmt::format("“{}”, seed {}: {}", trial.condition, trial.seed, trial.reason));
    return;
  }
  into.flights.push_back(report::flight_of(trial, slowdown));
  into.trials.push_back(trial);
  sizing.add(into.flights.back());
}

// In the order of their seeds, in which they were planned.
void SizeFlights::take_earlier() {
  for (const campaign::TrialPlan& plan : campaign::plan_trials(campaign_, folder_.path())) {
    if (plan.condition->slowed_from != setup_.conditions.front().name) continue;
    if (missing_.contains({plan.condition->name, plan.seed})) continue;
    take(campaign::read_result(plan.folder), plan.condition->slowdown, report_->synchronised,
         sizing_);
    next_seed_ = plan.seed + 1;
  }
}

SizeFlights::End SizeFlights::fly_synchronised() {
  const campaign::TrialPlan any{
      &campaign_.scenarios.front().scenario, &setup_.conditions.front(), 0, {}};
  const auto at_once = static_cast<std::size_t>(campaign::parallel_trials(any, setup_.jobs));
  for (;;) {
    const std::size_t left = setup_.most - std::min<std::size_t>(setup_.most, next_seed_ - 1);
    report_->synchronised.answer = sizing_.answer(left == 0);
    if (report_->synchronised.answer.is_narrow || left == 0) return End::kAnswered;
    const std::vector<double> slowdowns = sizing_.next(std::min(at_once, left));
    std::vector<Key> keys;
    for (const double slowdown : slowdowns)
      keys.emplace_back(slowed_name(0, slowdown), next_seed_++);
    if (!run(keys)) return End::kInterrupted;
    const std::size_t before = report_->not_flown.size();
    for (std::size_t i = 0; i < keys.size(); ++i)
      take(campaign::read_result(missing_.at(keys[i])->folder), slowdowns[i], report_->synchronised,
           sizing_);
    failures_ += report_->not_flown.size() - before;
    if (failures_ >= kMostFailedFlights) return End::kFailing;
  }
}

// The same slowdowns and seeds, so that both differ in the synchronisation only.
bool SizeFlights::fly_unsynchronised() {
  std::vector<Key> keys, to_fly;
  std::vector<double> slowdowns;
  const report::SizedCondition& own = report_->synchronised;
  for (std::size_t i = 0; i < own.flights.size(); ++i) {
    slowdowns.push_back(own.flights[i].slowdown);
    keys.emplace_back(slowed_name(1, slowdowns.back()), own.trials[i].seed);
    if (missing_.contains(keys.back())) to_fly.push_back(keys.back());
  }
  if (!run(to_fly)) return false;
  sizing::Sizing sizing(grid_, has_margins_);
  report::SizedCondition& other = report_->unsynchronised.emplace();
  other.condition = setup_.conditions.back().name;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto folder = folder_.path() /
                        campaign::trial_folder(setup_.scenario.name, keys[i].first, keys[i].second);
    take(campaign::read_result(folder), slowdowns[i], other, sizing);
  }
  other.answer = sizing.answer(true);
  other.curve = report::curve_points(sizing.curve(), grid_.question().least, grid_.question().most);
  return true;
}

SizeFlights::End SizeFlights::fly(report::SizeReport& report) {
  report_ = &report;
  report.settings = settings_;
  report.synchronised.condition = setup_.conditions.front().name;
  take_earlier();
  const End end = fly_synchronised();
  report.synchronised.curve =
      report::curve_points(sizing_.curve(), grid_.question().least, grid_.question().most);
  const bool is_compared = end == End::kAnswered && setup_.conditions.size() > 1;
  const bool is_whole = !is_compared || fly_unsynchronised();
  line_.clear();
  return is_whole ? end : End::kInterrupted;
}

void SizeFlights::show(const campaign::CampaignProgress& progress) {
  const std::size_t flown = report_->synchronised.flights.size();
  if (os::terminal_columns(STDERR_FILENO) > 0) {
    if (progress.latest == nullptr) return;
    const sizing::Threshold& so_far = report_->synchronised.answer.threshold;
    line_.show(
        fmt::format("{} flights, at most {}; so far {:.2g} × [{:.2g}, {:.2g}]; flying {}, "
                    "seed {}",
                    flown, setup_.most, so_far.estimate, so_far.low, so_far.high,
                    progress.latest->condition->name, progress.latest->seed));
  } else if (progress.result != nullptr) {
    say("{}  {}, seed {}: {}\n", flown + progress.done, progress.latest->condition->name,
        progress.latest->seed, campaign::name(progress.result->outcome));
  }
}

}  // namespace tether::app
