#include "commands/size_trials.h"

#include "back_ends.h"
#include "commands/trial_service.h"
#include "options/engine_option.h"
#include "options/refuse_option.h"
#include "options/simulator_option.h"
#include "options/trial_options.h"
#include "reading/file_kind.h"
#include "reading/world_options.h"
#include "terminal/print.h"
#include "terminal/say.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/counted.h>
#include <tether/base/error.h>
#include <tether/os/program.h>
#include <tether/os/shell_word.h>
#include <tether/os/terminal.h>
#include <tether/os/text_file.h>
#include <tether/report/gnuplot.h>
#include <tether/runner/campaign_trials.h>
#include <tether/runner/trial_folder.h>
#include <tether/scenario/decidable.h>
#include <tether/scenario/shipped_files.h>

namespace tether::app {

namespace {

/// Gives up after so many failed flights.
constexpr std::size_t kMostFailedFlights = 3;

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
  parse_simulator_option(options.simulator);
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

SizeTrials::SizeTrials(const SizeOptions& options, scenario::Campaign campaign,
                       const std::filesystem::path& out, std::stop_token stop,
                       std::function<std::string(const campaign::TrialPlan&)> name)
    : options_(options),
      campaign_(std::move(campaign)),
      engine_(engine_of(options.engine)),
      jobs_(jobs_of(options.engine, engine_)),
      stop_(std::move(stop)),
      name_(std::move(name)),
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
  sim::WorldStore worlds;
  const auto [files, warnings] = runner::files_of_trials(campaign_, find_back_end, worlds);
  if (!warnings.empty())
    complain(summary_of(warnings, std::string(runner::kWarningsFile) + " of each flight"));
  if (!engine_) servers_.start(jobs_, trial_service(worlds));
  return files;
}

std::string SizeTrials::text_of(const campaign::TrialPlan& plan) const {
  return fmt::format("{}, seed {}", name_(plan), plan.seed);
}

SizeTrials::End SizeTrials::fly(const Questions& questions,
                                const std::function<bool(const campaign::TrialPlan&)>& is_asked) {
  for (const campaign::TrialPlan& plan : folder_.finished()) {
    if (!is_asked(plan)) continue;
    take(plan, questions);
    next_seed_ = std::max(next_seed_, plan.seed + 1);
  }
  const scenario::Scenario& last = campaign_.scenarios.back().scenario;
  const campaign::TrialPlan any{
      &last, last.find_condition(campaign_.scenarios.back().conditions.front()), 0, {}};
  const auto at_once = static_cast<std::size_t>(campaign::parallel_trials(any, jobs_));
  const std::size_t failed_before = not_flown_.size();
  for (;;) {
    const std::size_t left = options_.max_trials - (next_seed_ - 1);
    const std::vector<Wanted> next = questions.next(std::min(at_once, left));
    if (next.empty()) break;
    Plans plans;
    for (const auto& [scenario, condition] : next)
      plans.push_back(
          missing_.at(folder_.path() / campaign::trial_folder(scenario, condition, next_seed_++)));
    if (!run(plans, questions)) return End::kInterrupted;
    for (const campaign::TrialPlan* plan : plans) take(*plan, questions);
    if (not_flown_.size() - failed_before >= kMostFailedFlights) return End::kFailing;
  }
  return flown_ > 0 && without_value_ == flown_ ? End::kUndecidable : End::kAnswered;
}

bool SizeTrials::fly_also(const std::vector<std::pair<Wanted, std::uint64_t>>& trials,
                          const Questions& questions) {
  Plans all, missing;
  for (const auto& [wanted, seed] : trials) {
    const auto folder =
        folder_.path() / campaign::trial_folder(wanted.scenario, wanted.condition, seed);
    if (const auto found = missing_.find(folder); found != missing_.end())
      missing.push_back(found->second), all.push_back(found->second);
    else
      all.push_back(&*std::ranges::find(folder_.finished(), folder, &campaign::TrialPlan::folder));
  }
  if (!run(missing, questions)) return false;
  for (const campaign::TrialPlan* plan : all) take(*plan, questions);
  return true;
}

bool SizeTrials::run(const Plans& plans, const Questions& questions) {
  const auto show_it = [&](const campaign::CampaignProgress& progress) {
    show(progress, questions);
  };
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
  return is_whole;
}

void SizeTrials::take(const campaign::TrialPlan& plan, const Questions& questions) {
  const campaign::TrialResult trial = campaign::read_result(plan.folder);
  if (trial.outcome == campaign::Outcome::kFailed) {
    not_flown_.push_back(fmt::format("{}: {}", text_of(plan), trial.reason));
    return;
  }
  ++flown_;
  if (const std::string why = report::missed_without_value(trial); !why.empty()) {
    if (without_value_++ == 0) why_without_value_ = why;
  }
  questions.take(plan, trial);
}

void SizeTrials::show(const campaign::CampaignProgress& progress, const Questions& questions) {
  if (os::terminal_columns(STDERR_FILENO) > 0) {
    if (progress.latest == nullptr) return;
    line_.show(fmt::format("{}, at most {}; {}; flying {}",
                           counted(flown_ + progress.done, "flight"), options_.max_trials,
                           questions.so_far(), text_of(*progress.latest)));
  } else if (progress.result != nullptr) {
    say("{}  {}: {}; {}\n", flown_ + progress.done, text_of(*progress.latest),
        campaign::name(progress.result->outcome), questions.so_far());
  }
}

int SizeTrials::say_why(End end) const {
  for (const std::string& line : not_flown_) complain("tether: " + line);
  const std::string again = fmt::format(
      "tether size {}{} --out {} --resume, with the options of this call",
      os::shell_word(options_.scenario.string()), options_.axis == "uavs" ? " --axis uavs" : "",
      os::shell_word(folder_.path().string()));
  if (end == End::kUndecidable)
    say("tether: no flight shows whether the computer is fast enough: all {} reached the goal of "
        "the program, but {}. Correct that, or remove the limit.\n",
        flown_, why_without_value_);
  else if (end == End::kInterrupted)
    say("tether: interrupted after {}; to continue, type: {}\n", counted(flown_, "flight"), again);
  else
    say("tether: {} failed without a result. Fix the cause; to continue, type: {}\n",
        counted(not_flown_.size(), "flight"), again);
  return exit_code(ErrorCode::kSetup);
}

void write_answer(const SizeAnswer& answer, const std::filesystem::path& out,
                  const std::filesystem::path& junit) {
  os::write_file_atomically(out / kSizeFile, answer.json);
  print(report::answer_text(answer.answers, answer.advice, markup_of_stdout()));
  os::write_file_atomically(out / kSizeDrawing, report::draw_svg(answer.plot));
  os::write_file_atomically(out / campaign::kReportFile, answer.page);
  fmt::print("Page: {}\nDrawing: {}\nNumbers: {}\n", (out / campaign::kReportFile).string(),
             (out / kSizeDrawing).string(), (out / kSizeFile).string());
  if (!junit.empty()) os::write_file_atomically(junit, answer.junit);
}

}  // namespace tether::app
