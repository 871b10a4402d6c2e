#include "commands/size_trials.h"

#include "back_ends.h"
#include "commands/trial_service.h"
#include "options/engine_option.h"
#include "options/refuse_option.h"
#include "options/trial_options.h"
#include "reading/file_kind.h"
#include "reading/world_options.h"
#include "terminal/print.h"
#include "terminal/say.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/os/child_process.h>
#include <tether/os/terminal.h>
#include <tether/report/verdict.h>
#include <tether/runner/campaign_trials.h>
#include <tether/runner/trial_folder.h>
#include <tether/scenario/scenario.h>
#include <tether/scenario/shipped_files.h>

namespace tether::app {

namespace {

campaign::OpenMode open_mode(const SizeOptions& options) {
  return options.force    ? campaign::OpenMode::kReplace
         : options.resume ? campaign::OpenMode::kResume
                          : campaign::OpenMode::kFresh;
}

}  // namespace

scenario::Scenario load_sized_scenario(const SizeOptions& options,
                                       const std::vector<scenario::Setting>& settings) {
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  const std::filesystem::path file =
      shipped.find(scenario::ShippedKind::kScenario, options.scenario);
  require_kind(file, FileKind::kScenario);
  scenario::Scenario scenario = scenario::load_scenario(file, settings);
  scenario::require_decidable(scenario);
  scenario.world_options = world_options(options.reading, shipped);
  if (options.simulator.empty()) return scenario;
  find_back_end(options.simulator);  // or it says what there is
  for (auto& condition : scenario.conditions) condition.simulator = options.simulator;
  return scenario;
}

void require_enough_trials(const SizeOptions& options, double miss) {
  const auto least =
      static_cast<std::size_t>(std::ceil(std::log(miss) / std::log(options.success)));
  if (options.max_trials >= least) return;
  refuse_option("--max-trials",
                fmt::format("{} flight{} cannot show a success of {} with a confidence of {}, even "
                            "if all succeed. Use at least {}.",
                            options.max_trials, options.max_trials == 1 ? "" : "s", options.success,
                            options.confidence, least));
}

SizeAxis::SizeAxis(const SizeOptions& options, const scenario::Scenario& scenario)
    : campaign(scenario::campaign_of(scenario, {}, options.max_trials)) {
  campaign.name.insert(0, campaign::kSizePrefix);
  campaign.scenarios.clear();
}

SizeTrials::SizeTrials(const SizeOptions& options, SizeAxis& axis, const std::filesystem::path& out,
                       std::stop_token stop)
    : options_(options),
      axis_(axis),
      campaign_(axis.campaign),
      engine_(engine_of(options.engine)),
      jobs_(jobs_of(options.engine, engine_)),
      stop_(std::move(stop)),
      files_(checked_files(out)),
      settings_(campaign::campaign_settings(
          campaign_, versions_of(campaign_, options.reading, engine_.has_value()), files_)),
      folder_(out, campaign_, settings_, open_mode(options)) {
  for (const std::string& warning : folder_.warnings()) complain("warning: " + warning);
  for (const campaign::TrialPlan& plan : folder_.missing()) missing_[plan.folder] = &plan;
  for (const char* old : {kSizeFile, kSizeDrawing}) {
    std::error_code ignored;
    std::filesystem::remove(out / old, ignored);
  }
}

std::vector<std::filesystem::path> SizeTrials::checked_files(const std::filesystem::path& out) {
  campaign::require_folder(out, campaign_, open_mode(options_));
  require_parallel_allowed(campaign_, engine_, jobs_);
  sim::WorldStore worlds(sim::FileCache::of_user());
  const auto [files, warnings] = runner::files_of_trials(campaign_, find_back_end, worlds);
  if (!warnings.empty())
    complain(summary_of(warnings, std::string(runner::kWarningsFile) + " of each flight"));
  if (!engine_) servers_.start(jobs_, trial_service(worlds));
  return files;
}

std::string SizeTrials::text_of(const campaign::TrialPlan& plan) const {
  return fmt::format("{}, seed {}", axis_.name_of(plan), plan.seed);
}

const campaign::TrialPlan& SizeTrials::plan_of(const sizing::Wanted& wanted) const {
  const auto& [scenario, condition] = axis_.levels[wanted.level];
  const auto folder = folder_.path() / campaign::trial_folder(scenario, condition, wanted.seed);
  const auto found = missing_.find(folder);
  return found != missing_.end()
             ? *found->second
             : *std::ranges::find(folder_.finished(), folder, &campaign::TrialPlan::folder);
}

sizing::SearchEnd SizeTrials::fly() {
  std::vector<sizing::Wanted> earlier;
  for (const campaign::TrialPlan& plan : folder_.finished()) {
    const SizeAxis::Trial trial{plan.scenario->name, plan.condition->name};
    const auto level =
        static_cast<std::size_t>(std::ranges::find(axis_.levels, trial) - axis_.levels.begin());
    if (level < axis_.searched) earlier.push_back({level, plan.seed});
  }
  start_ = std::chrono::steady_clock::now();
  const scenario::Scenario& last = campaign_.scenarios.back().scenario;
  const campaign::TrialPlan any{
      &last, last.find_condition(campaign_.scenarios.back().conditions.front()), 0, {}};
  const auto at_once = static_cast<std::size_t>(campaign::parallel_trials(any, jobs_));
  const auto take = [this](const sizing::Wanted& wanted) { return this->take(wanted); };
  const sizing::SearchEnd end = sizing::search(
      axis_.search(), options_.max_trials, at_once, earlier,
      [this](std::span<const sizing::Wanted> wanted) { return run(wanted); }, take);
  if (end != sizing::SearchEnd::kAnswered) return end;
  const std::vector<sizing::Wanted> also = axis_.also();
  if (!run(also)) return sizing::SearchEnd::kInterrupted;
  std::ranges::for_each(also, take);
  return end;
}

bool SizeTrials::run(std::span<const sizing::Wanted> flights) {
  std::vector<const campaign::TrialPlan*> plans;
  for (const sizing::Wanted& wanted : flights) {
    const campaign::TrialPlan& plan = plan_of(wanted);
    if (missing_.contains(plan.folder)) plans.push_back(&plan);
  }
  const auto show_it = [&](const campaign::CampaignProgress& progress) { show(progress); };
  const bool is_whole = [&] {
    if (engine_)
      return !shards::fly_by_engine(engine_setup(*engine_, jobs_, folder_.path(), files_), plans, 0,
                                    stop_, show_it)
                  .interrupted;
    const auto fly_one = [&](const campaign::TrialPlan& plan) { return servers_.run(plan, stop_); };
    const auto check = [&] { campaign::require_unchanged(campaign_, settings_, files_); };
    return !campaign::run_trials(
                plans, fly_one, {.jobs = jobs_, .stop = stop_, .wall = {}, .check = check}, show_it)
                .interrupted;
  }();
  line_.clear();
  flown_here_ += plans.size();
  return is_whole;
}

sizing::Flown SizeTrials::take(const sizing::Wanted& wanted) {
  const campaign::TrialPlan& plan = plan_of(wanted);
  const campaign::TrialResult trial = campaign::read_result(plan.folder);
  if (trial.outcome == campaign::Outcome::kFailed) {
    not_flown_.push_back(fmt::format("{}: {}", text_of(plan), trial.reason));
    return {.is_failed = true};
  }
  ++flown_;
  const std::string why = report::missed_without_value(trial);
  if (why_without_value_.empty()) why_without_value_ = why;
  return {.is_copy = axis_.add(wanted.level, trial), .lacks_value = !why.empty()};
}

std::string SizeTrials::left(std::size_t of_this_batch) const {
  const std::optional<std::size_t> flights = axis_.search().flights_left();
  const std::size_t here = flown_here_ + of_this_batch;
  if (!flights || here == 0) return "";
  const std::size_t most = options_.max_trials - std::min<std::size_t>(options_.max_trials, flown_);
  const auto left = static_cast<double>(std::min(*flights, most));
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
  const double each_s = taken.count() / static_cast<double>(here);
  return fmt::format("; perhaps {:.0f} more, {:.0f} min", left, std::ceil(left * each_s / 60.0));
}

void SizeTrials::show(const campaign::CampaignProgress& progress) {
  if (os::terminal_columns(STDERR_FILENO) > 0) {
    if (progress.latest == nullptr) return;
    line_.show(fmt::format("{}, at most {}; {}{}; flying {}",
                           counted(flown_ + progress.done, "flight"), options_.max_trials,
                           axis_.search().so_far(), left(progress.done),
                           text_of(*progress.latest)));
  } else if (progress.result != nullptr) {
    say("{}  {}: {}; {}{}\n", flown_ + progress.done, text_of(*progress.latest),
        campaign::name(progress.result->outcome), axis_.search().so_far(), left(progress.done));
  }
}

int SizeTrials::say_why(sizing::SearchEnd end) const {
  for (const std::string& line : not_flown_) complain("tether: " + line);
  const std::string again = how_to_continue();
  if (end == sizing::SearchEnd::kUndecidable)
    say("tether: no flight shows whether the computer is fast enough: all {} reached the goal of "
        "the program, but {}. Correct that, or remove the limit.\n",
        flown_, why_without_value_);
  else if (end == sizing::SearchEnd::kInterrupted)
    say("tether: interrupted after {}; {}\n", counted(flown_, "flight"), again);
  else
    say("tether: {} failed without a result. Fix the cause; {}\n",
        counted(not_flown_.size(), "flight"), again);
  return exit_code(ErrorCode::kSetup);
}

}  // namespace tether::app
